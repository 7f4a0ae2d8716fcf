// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "oort/geometry/point_cloud.hpp"
#include "oort/geometry/pose2.hpp"
#include "oort/geometry/sweep.hpp"
#include "oort/sensor/scan_pair.hpp"

namespace oort {

/// In which order the beams of a scan that takes time were measured.
enum class BeamOrder {
  kStamped,   ///< as the scan says
  kReversed,  ///< the last one first, as where a driver turns a clockwise laser's beams round and keeps their times
  kAtOnce,    ///< all at once, whatever the scan says
};

/// The sweep of a scan whose beams came in another order than it says.
Sweep in_order(const Sweep& stamped, BeamOrder order);

/// Tells from the scans in which order a laser's beams come. A scan that was taken while the base turned is laid on one
/// taken shortly before while it did not, deskewed in each order: the wrong ones are bent. Deterministic, and bounded:
/// once an order is clearly the best, or none is for long, nothing more is looked at.
class BeamOrderTest {
 public:
  struct Evidence {
    std::size_t tests = 0;
    std::array<double, 3> costs = {};  ///< mean of PairMatch::cost [m^2], by BeamOrder
  };

  /// Takes a scan as it was measured, not deskewed; the pose by odometry and the sweep are the sensor's.
  void add(const PointCloud& scan, const Pose2& T_odom_sensor, const Sweep& sweep_of_sensor);

  /// The order to deskew with now: as stamped, until another is clearly better.
  BeamOrder order() const { return order_; }
  bool is_decided() const { return decided_; }
  Evidence evidence() const;

 private:
  struct Reference {
    std::array<ReferenceScan, 3> scans;  // by order
    Pose2 T_odom_sensor;
    double turn = 0.0;  // while it was taken [rad]
    int age = 0;        // scans
  };

  void compare(const PointCloud& scan, const Pose2& T_odom_sensor, const Sweep& sweep);
  void decide();

  std::optional<Reference> reference_;
  BeamOrder order_ = BeamOrder::kStamped;
  bool decided_ = false;
  std::size_t tests_ = 0;
  std::array<double, 3> costs_ = {};                     // sums
  std::array<std::array<std::size_t, 3>, 3> wins_ = {};  // [a][b]: tests in which a was better than b
};

}  // namespace oort
