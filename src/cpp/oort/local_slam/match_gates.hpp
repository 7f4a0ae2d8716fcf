// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "oort/local_slam/scan_tracker.hpp"

namespace oort {

/// Why the match of a scan that becomes a node is rejected, given the motion by odometry alone from its
/// anchor to it, by the gates of the matcher that `parameters` chooses (match_filtering, or sm_*); kNone when it is.
Rejection match_rejection(const IncrementalGraphBuilderParameters& parameters, const TrackedScan& node,
                          const Pose2& T_local_anchor, const Pose2& T_anchor_node_odometry);

/// Whether a match is rejected for nothing but being too far from odometry along x, along y, or in its heading.
bool is_too_far(Rejection rejection);

/// Whether a match is rejected because nothing was seen that could speak for or against odometry.
bool nothing_was_seen(Rejection rejection);

}  // namespace oort
