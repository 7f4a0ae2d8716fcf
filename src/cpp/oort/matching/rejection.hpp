// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace oort {

/// Why a match is rejected. Every verdict on one, of a scan, a closure, an edge between scans or a pose on a map, is
/// one of these. Texts are for people: code compares the values.
enum class Rejection : std::uint8_t {
  kNone,        ///< accepted
  kNotMatched,  ///< no match was tried

  // Verdicts of frsm on a scan (frsm::Status).
  kEmptyScan,
  kTooFewPoints,
  kNoOverlap,
  kSaturated,
  kDegenerate,
  kLowHits,
  kFewHitsAfterGap,  ///< usable by itself, but too few points hit to say where the sensor is after scans without a
                     ///< match

  // Verdicts of the matchers on probability grids.
  kGridEmptyScan,
  kLowScore,
  kNoHits,  ///< no point lies on the map that was matched with, or there is none yet; of submaps of frsm as well

  // Gates of local SLAM on the difference between a match and odometry.
  kScore,
  kX,
  kY,
  kTheta,
  kDistance,  ///< also of closures: farther from where the graph expects the node
  kSecondStageScore,
  kSecondStageDistance,
  kSecondStageTheta,
  kRestarted,            ///< the scan begins a local map, on which the anchor is not
  kContradictsOdometry,  ///< the match is farther from odometry than odometry errs

  // Loop and dock closures.
  kSmallSubmap,
  kRoughHits,
  kWindowBorder,
  kAmbiguous,  ///< also of a search of the whole map
  kFineHits,
  kHits,
  kCloseDistance,
  kCloseHits,
  kAngle,
  kOtherSide,
  kUnconfirmed,
  kSameNode,
  kNoReference,

  // Edges between scans in a refinement.
  kFewSurfaces,
  kFar,

  // Localisation: of a scan near the pose that odometry expects,
  kLowSupport,
  kUnexpected,
  kContradictsEarlierViews,
  // and of a search of the whole map.
  kSearchTooFewPoints,
  kNoMatch,
  kSearchLowSupport,
  kImprecise,  ///< the last one: kRejectionValues counts on it
};

constexpr std::size_t kRejectionValues = static_cast<std::size_t>(Rejection::kImprecise) + 1;

/// The text that reports and documents have for it; no two have the same.
std::string_view to_string(Rejection rejection);

/// How often each verdict was given.
class RejectionCounts {
 public:
  std::uint64_t& operator[](Rejection rejection) { return counts_[static_cast<std::size_t>(rejection)]; }
  std::uint64_t operator[](Rejection rejection) const { return counts_[static_cast<std::size_t>(rejection)]; }

  std::uint64_t total() const;

  /// Those that were given at all, in the order of their texts.
  std::vector<std::pair<Rejection, std::uint64_t>> by_text() const;

 private:
  std::array<std::uint64_t, kRejectionValues> counts_{};
};

}  // namespace oort
