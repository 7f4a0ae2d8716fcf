// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"

namespace oort {

/// How something moved while a scan was taken: where it was at the scan's first and last beam, seen from where it was
/// at the scan's stamp. In between it is taken to have moved along an arc, evenly, as the beams came. The default is no
/// motion: all beams at once.
struct Sweep {
  Pose2 T_stamp_first;
  Pose2 T_stamp_last;
};

/// Whether the beams may be taken as measured at once: nothing moved, or the motion is not believable within one scan
/// (more than 1 m or 1 rad), as where odometry jumps.
bool is_snapshot(const Sweep& sweep);

/// The sensor's sweep from that of the base it sits on.
Sweep sweep_of_sensor(const Sweep& sweep_of_base, const Pose2& T_base_sensor);

/// Brings each beam of a cloud from where the sensor was when it was measured to where it was at the stamp (the cloud's
/// `time`). The beams came evenly in their order. Points move, and bearings of beams without a reading turn; what is a
/// return and what is not stays. Throws InputError if the sweep is not finite.
PointCloud deskew(PointCloud cloud, const Sweep& sweep_of_sensor);

}  // namespace oort
