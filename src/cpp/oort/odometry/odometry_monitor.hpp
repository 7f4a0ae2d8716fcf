// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "oort/geometry/pose2.hpp"
#include "oort/odometry/scan_pace.hpp"

namespace oort {

/// A moment at which odometry said what no robot does.
struct OdometryFault {
  enum class Kind {
    kJump,      ///< it moved by more than a robot can
    kFreeze,    ///< it stood still at once while the robot went on
    kReversed,  ///< it went ahead while the robot drove backwards
  };
  Kind kind = Kind::kJump;
  double time = 0.0;      ///< [s]
  double distance = 0.0;  ///< between what it said and what was accepted [m]
  double angle = 0.0;     ///< the same [rad]
};

/// What the base may have done between two scans.
struct MotionHypotheses {
  /// Of the base, the likeliest first; the scan decides. One alone: odometry's, which is plausible.
  std::vector<Pose2> T_before_after;
  Pose2 T_before_after_odometry;
  /// What the base did where its encoders count the turns of wheels without their sense: the same way backwards. Tried
  /// where the scan does not fit where odometry leads.
  std::optional<Pose2> T_before_after_reversed;
  bool is_standing = false;  ///< whether odometry says that the base stands

  bool is_doubted() const { return T_before_after.size() > 1; }

  /// Whether a matched motion and odometry's are the same within what each may err.
  bool holds(const Pose2& T_before_after_matched) const;
};

/// Physics before odometry: between two scans a robot moves by no more than a robot can. Where odometry says more, or
/// stops dead while the robot was moving, it is one hypothesis among others: that the robot went on as before, and, as
/// odometry that froze makes up for it at once, that it has caught up. Judges by stamps and poses alone; deterministic.
class OdometryMonitor {
 public:
  /// Takes the next odometry pose. `T_before_after`: its motion with what is known of its errors taken out.
  MotionHypotheses judge(double time, const Pose2& T_before_after);

  /// Says how the base moved since the pose before the last judged one, and whether a match says so against odometry.
  void moved(const Pose2& T_before_after, bool is_matched);

  /// Forgets what led here: the next motion is judged by absolute limits only.
  void forget();

  std::uint64_t fault_count() const { return fault_count_; }
  /// The first ones, as many as are kept.
  const std::vector<OdometryFault>& faults() const { return faults_; }

 private:
  struct Motion {
    double interval = 0.0;  // [s]
    Pose2 T_before_after;
  };

  bool is_possible(double interval, const Pose2& motion) const;
  bool catches_up(double interval, const Pose2& motion) const;
  std::optional<Pose2> going_on(double interval) const;

  std::optional<double> last_time_;
  ScanPace pace_;
  Motion judged_;                 // by odometry, not yet accepted
  bool knows_backwards_ = false;  // odometry has said that the base went backwards
  bool judged_doubted_ = false;
  std::optional<Motion> believed_;  // the last motion
  Pose2 missed_;                    // what the base did while odometry stood still
  bool is_frozen_ = false;
  double stood_ = 0.0;  // [s] for which odometry has said exactly nothing
  std::uint64_t fault_count_ = 0;
  std::vector<OdometryFault> faults_;
};

}  // namespace oort
