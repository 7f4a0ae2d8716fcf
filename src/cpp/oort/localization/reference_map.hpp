// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <frsm/matcher.hpp>
#include <frsm/table.hpp>
#include <vector>

#include "oort/localization/known_space.hpp"
#include "oort/map/map.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// How well scans fit the map at a pose. Counts are of returns, except `surfaces`.
struct Support {
  int points = 0;
  int inliers = 0;   ///< lie on a surface of the map
  int blocked = 0;   ///< were seen through a known wall
  int in_free = 0;   ///< lie on floor that the map knows to be free
  int surfaces = 0;  ///< inliers whose normal is known, here and on the map
  int turned = 0;    ///< of these, those with the opposite normal: the wall was seen from behind

  /// Share of the returns that lie on surfaces of the map as they should, less the share that cannot be. At most 1.
  double value() const;
};

/// A map, or a part of one, made ready to find a robot on it: every cloud drawn at its node's solved pose. It never
/// changes. Of a large area all is drawn more coarsely, so that memory and work are bounded.
class ReferenceMap {
 public:
  /// Throws InputError if the map has no node, contradicts itself or is too large, ParameterError as Mapper does.
  ReferenceMap(const Map& map, const Parameters& parameters);

  /// What some nodes of a map saw. Both are taken to be usable.
  ReferenceMap(const Map& map, const std::vector<std::uint64_t>& nodes, const Parameters& parameters);

  const frsm::Table& fine() const { return fine_; }      ///< for the matcher
  const frsm::Table& coarse() const { return coarse_; }  ///< for searching all of it
  const KnownSpace& space() const { return space_; }

  /// How well a scan fits that was taken at a pose, added to `support`. Returns that are farther away than the map
  /// draws any tell nothing.
  void weigh(const PointCloud& cloud, const Pose2& T_map_sensor, Support& support) const;

 private:
  void reserve(const Map& map, const std::vector<std::uint64_t>& nodes);

  KnownSpace space_;
  frsm::Table fine_;
  frsm::Table coarse_;
  int hit_value_;
};

}  // namespace oort
