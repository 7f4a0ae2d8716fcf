// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "oort/geometry/pose2.hpp"
#include "oort/map/map.hpp"

namespace oort {

/// The first thing that makes a map unusable, in words that follow "because": ids that are not consecutive from 0,
/// edges, results or locations of nodes that do not exist, a cloud missing or at the wrong node, numbers that are not
/// finite where they must be, covariances that cannot be used, poses and returns that are out of reach, a switch
/// outside [0, 1], more than a map file can hold. Nothing for a sound map.
std::optional<std::string> find_defect(const Map& map);

/// Throws InputError, "`what` is ...; `advice`", if a pose is not finite or more than 16,000 turns or 100 km off.
/// Farther off, float coordinates and the matcher's lattice lose their meaning; no robot gets there.
void check_reach(const Pose2& pose, const std::string& what, const std::string& advice = "check where it comes from");

}  // namespace oort
