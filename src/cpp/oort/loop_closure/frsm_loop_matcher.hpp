// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <frsm/matcher.hpp>

#include "oort/loop_closure/loop_matcher.hpp"
#include "oort/loop_closure/submaps.hpp"

namespace oort {

/// By FRSM: roughly over the whole window by branch and bound, then finely around the best.
class FrsmLoopMatcher : public LoopMatcher {
 public:
  FrsmLoopMatcher(const Parameters& parameters, const LoopScale& scale);

  Found find(const Map& map, const TrajectorySegments& segments, std::uint64_t query, std::uint64_t candidate,
             const SearchWindow& window, WorkMeter* meter = nullptr) override;
  bool draw(const Map& map, const TrajectorySegments& segments, std::uint64_t candidate,
            WorkMeter* meter = nullptr) override;

 private:
  bool is_small(const TrajectorySegments& segments, std::uint64_t candidate) const;

  FrsmLoopMatcherParameters parameters_;
  LoopScale scale_;
  frsm::TableParams table_;
  SubmapCache<frsm::Table> submaps_;
  frsm::Matcher matcher_;
  Eigen::Matrix3d error_;  // of a match, beyond its own covariance
};

}  // namespace oort
