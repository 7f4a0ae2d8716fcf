// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/sensor/beam_order.hpp"

#include <algorithm>
#include <cmath>

#include "oort/sensor/tuning.hpp"

namespace oort {
namespace {

constexpr std::array<BeamOrder, 3> kOrders = {BeamOrder::kStamped, BeamOrder::kReversed, BeamOrder::kAtOnce};

}  // namespace

Sweep in_order(const Sweep& stamped, BeamOrder order) {
  if (order == BeamOrder::kAtOnce) return {};
  if (order == BeamOrder::kReversed) return {stamped.T_stamp_last, stamped.T_stamp_first};
  return stamped;
}

void BeamOrderTest::add(const PointCloud& scan, const Pose2& T_odom_sensor, const Sweep& sweep) {
  if (decided_) return;
  const double turn = std::abs(between(sweep.T_stamp_first, sweep.T_stamp_last).theta);
  if (reference_) {
    const Pose2 moved = between(reference_->T_odom_sensor, T_odom_sensor);
    const bool near = ++reference_->age <= SensorTuning::kReferenceAge &&
                      moved.translation().norm() <= SensorTuning::kReferenceDistance &&
                      std::abs(moved.theta) <= SensorTuning::kReferenceAngle;
    if (!near) reference_.reset();
  }
  if (reference_ && turn >= reference_->turn + SensorTuning::kTellingTurn && !is_snapshot(sweep)) {
    compare(scan, T_odom_sensor, sweep);
    decide();
  } else if (!reference_ || turn <= reference_->turn) {
    const auto in = [&](BeamOrder order) { return ReferenceScan(deskew(scan, in_order(sweep, order))); };
    Reference next{{in(kOrders[0]), in(kOrders[1]), in(kOrders[2])}, T_odom_sensor, turn, 0};
    if (next.scans[0].is_usable()) reference_ = std::move(next);
  }
}

void BeamOrderTest::compare(const PointCloud& scan, const Pose2& T_odom_sensor, const Sweep& sweep) {
  const Pose2 guess = between(reference_->T_odom_sensor, T_odom_sensor);
  std::array<PairMatch, 3> matches;
  for (std::size_t k = 0; k < kOrders.size(); ++k) {
    matches[k] = reference_->scans[k].align(deskew(scan, in_order(sweep, kOrders[k])), guess);
  }
  const auto& best = *std::min_element(matches.begin(), matches.end(),
                                       [](const PairMatch& a, const PairMatch& b) { return a.cost < b.cost; });
  if (best.inlier_ratio < SensorTuning::kMinOverlap) return;
  ++tests_;
  for (std::size_t a = 0; a < kOrders.size(); ++a) {
    costs_[a] += matches[a].cost;
    for (std::size_t b = 0; b < kOrders.size(); ++b) wins_[a][b] += matches[a].cost < matches[b].cost ? 1 : 0;
  }
}

void BeamOrderTest::decide() {
  if (tests_ < SensorTuning::kMinOrderTests) return;
  const auto best = static_cast<std::size_t>(std::min_element(costs_.begin(), costs_.end()) - costs_.begin());
  bool clear = kOrders[best] != BeamOrder::kAtOnce || tests_ >= SensorTuning::kMinAtOnceTests;
  for (std::size_t other = 0; other < kOrders.size(); ++other) {
    if (other == best) continue;
    clear = clear && costs_[best] < SensorTuning::kClearCost * costs_[other] &&
            static_cast<double>(wins_[best][other]) >= SensorTuning::kClearWins * static_cast<double>(tests_);
  }
  if (clear) order_ = kOrders[best];
  decided_ = clear || tests_ >= SensorTuning::kMaxOrderTests;
  if (decided_) reference_.reset();
}

BeamOrderTest::Evidence BeamOrderTest::evidence() const {
  Evidence evidence{tests_, costs_};
  for (double& cost : evidence.costs) cost /= std::max<double>(1.0, static_cast<double>(tests_));
  return evidence;
}

}  // namespace oort
