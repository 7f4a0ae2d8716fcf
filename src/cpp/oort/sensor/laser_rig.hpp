// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "oort/sensor/laser.hpp"

namespace oort {

/// The lasers on a robot. One is the main laser: its scans are placed, in its frame. What another one saw last joins
/// the next scan of the main laser, moved by odometry.
class LaserRig {
 public:
  LaserRig(const Parameters& parameters, const Pose2& T_base_main);

  const Laser& main() const { return lasers_.front().laser; }
  const Pose2& T_base_main() const { return main().T_base_sensor(); }

  /// Takes a scan of another laser than the main one, known by its place. Throws as take().
  void remember(const Pose2& T_base_sensor, const LaserScan& scan, const Pose2& T_odom_base,
                const Sweep& sweep_of_base);

  /// A scan of the main laser at its stamp, and what the others saw shortly before. Throws InputError if the scan's
  /// limits or the sweep are not finite; nothing changes then.
  PointCloud take(const LaserScan& scan, const Pose2& T_odom_base, const Sweep& sweep_of_base);

  /// Whether more lasers have a part in the last cloud than in any before, so that what it shows is new for the most.
  bool view_grew() const { return view_grew_; }

  /// Forgets what was learned and seen.
  void forget();

  /// Of each laser, the main one first.
  std::vector<LaserFindings> findings() const;

 private:
  struct Mounted {
    Laser laser;
    PointCloud seen = {};  // by another than the main laser, in its frame
    Pose2 T_odom_sensor = {};
  };

  Parameters parameters_;
  std::vector<Mounted> lasers_;
  std::size_t most_joined_ = 0;
  bool view_grew_ = false;
};

}  // namespace oort
