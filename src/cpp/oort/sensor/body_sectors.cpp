// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/sensor/body_sectors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "oort/sensor/tuning.hpp"

namespace oort {
namespace {

constexpr double kBinWidth = 2.0 * M_PI / SensorTuning::kBodyBins;

std::size_t bin_of(double bearing) {
  const auto bin = static_cast<long>(std::lround(bearing / kBinWidth)) % SensorTuning::kBodyBins;
  return static_cast<std::size_t>(bin < 0 ? bin + SensorTuning::kBodyBins : bin);
}

double noise_at(double range) {
  return SensorTuning::kBodyNoise + SensorTuning::kBodyNoiseShare * range;
}

}  // namespace

BodyDetector::BodyDetector() : bins_(SensorTuning::kBodyBins) {}

bool BodyDetector::add(const LaserScan& scan, const Pose2& T_odom_base) {
  const Pose2 moved = begun_ ? between(T_odom_base_, T_odom_base) : Pose2{};
  T_odom_base_ = T_odom_base;
  travel_ += moved.translation().norm();
  turn_ += std::abs(moved.theta);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const float range = scan.ranges[i];
    Bin& bin = bins_[bin_of(scan.angle_min + static_cast<double>(i) * scan.angle_increment)];
    if (bin.is_body) continue;
    const bool near =
        range > 0.0F && range >= scan.range_min && range < scan.range_max && range < SensorTuning::kMaxBodyRange;
    if (bin.range > 0.0F && near && std::abs(range - bin.range) <= noise_at(bin.range)) {
      const auto weight = static_cast<float>(std::min<std::size_t>(++bin.hits, SensorTuning::kBodyScans));
      bin.range += (range - bin.range) / weight;
    } else if (bin.range > 0.0F &&
               ++bin.misses <= 1 + static_cast<std::uint32_t>(SensorTuning::kBodyMisses * bin.hits)) {
      continue;
    } else {
      const bool has_changed = bin.has_changed || bin.hits > 0 || travel_ > 0.0 || turn_ > 0.0;
      bin = {near ? range : 0.0F, near ? 1U : 0U, 0, travel_, turn_, false, has_changed};
    }
  }
  begun_ = true;
  return convict();
}

bool BodyDetector::is_ripe(const Bin& bin, double factor) const {
  return bin.hits >= SensorTuning::kBodyScans && travel_ - bin.travel >= factor * SensorTuning::kBodyTravel &&
         turn_ - bin.turn >= factor * SensorTuning::kBodyTurn;
}

bool BodyDetector::is_suspect(const Bin& bin) const {
  return !bin.has_changed && bin.range > 0.0F && bin.range < SensorTuning::kSuspectRange &&
         (travel_ - bin.travel >= SensorTuning::kSuspectTravel || turn_ - bin.turn >= SensorTuning::kSuspectTurn);
}

/// Whether more bearings are those of the body from now on.
bool BodyDetector::convict() {
  const auto width = static_cast<std::size_t>(std::lround(SensorTuning::kBodyWidth / kBinWidth));
  const auto agrees = [&](std::size_t bin) { return bins_[bin].is_body || is_ripe(bins_[bin], 1.0); };
  std::vector<std::size_t> guilty;
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    if (bins_[k].is_body || !is_ripe(bins_[k], 1.0)) continue;
    std::size_t before = 0;  // the farthest bin that agrees, on both sides
    std::size_t after = 0;
    for (std::size_t step = 1; step <= width; ++step) {
      if (agrees((k + bins_.size() - step) % bins_.size())) before = step;
      if (agrees((k + step) % bins_.size())) after = step;
    }
    if (before + after >= width || is_ripe(bins_[k], SensorTuning::kLoneBodyFactor)) guilty.push_back(k);
  }
  for (const std::size_t k : guilty) bins_[k].is_body = true;
  found_ = found_ || !guilty.empty();
  return !guilty.empty();
}

/// Whether a return at a bearing, or beside one, at which the body is seen is no farther than the body.
bool BodyDetector::is_of_body(const Point2& point) const {
  const double range = std::hypot(point.x, point.y);
  if (range > 1.5 * SensorTuning::kMaxBodyRange) return false;
  const std::size_t middle = bin_of(std::atan2(point.y, point.x));
  for (std::size_t k = 0; k < 5; ++k) {
    const Bin& bin = bins_[(middle + bins_.size() + k - 2) % bins_.size()];
    const bool counts = bin.is_body || is_suspect(bin);
    if (counts && range <= bin.range + noise_at(bin.range) + SensorTuning::kBodyMargin) return true;
  }
  return false;
}

void BodyDetector::remove_from(PointCloud& cloud) const {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (Point2& point : cloud.points) {
    if (point.is_return() && is_of_body(point)) point = {kNan, std::atan2(point.y, point.x), kNan};
  }
}

std::vector<BodySector> BodyDetector::sectors() const {
  std::vector<BodySector> sectors;
  for (int k = 0; k < SensorTuning::kBodyBins; ++k) {  // from -pi on
    const int signed_bin = k - SensorTuning::kBodyBins / 2;
    const Bin& bin = bins_[bin_of(signed_bin * kBinWidth)];
    if (!bin.is_body) continue;
    const double bearing = signed_bin * kBinWidth;
    if (!sectors.empty() && bearing - sectors.back().to < 5.5 * kBinWidth) {
      sectors.back().to = bearing;
      sectors.back().range = std::max(sectors.back().range, static_cast<double>(bin.range));
    } else {
      sectors.push_back({bearing, bearing, bin.range});
    }
  }
  return sectors;
}

}  // namespace oort
