// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/view.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace frsm {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kBearings = 720;
constexpr std::size_t kWidestGap = 5;  // bearings between points that are next to each other: 2.5 degrees
constexpr double kMargin = 0.2;        // [m] behind what was seen: surfaces have some depth, poses some error

std::size_t index_of(double bearing) {
  const auto turns = static_cast<long>(std::floor((bearing + kPi) / (2.0 * kPi) * kBearings));
  constexpr auto kAll = static_cast<long>(kBearings);
  return static_cast<std::size_t>((turns % kAll + kAll) % kAll);
}

}  // namespace

View::View(const Points& body, const Pose& origin) : origin_(origin), ranges_(kBearings, 0.0F) {
  std::size_t last = 0;
  float last_range = 0.0F;
  for (const Point& p : body) {
    const auto range = static_cast<float>(std::hypot(p.x, p.y));
    const std::size_t now = index_of(std::atan2(p.y, p.x));
    const std::size_t gap = (now + kBearings - last) % kBearings;
    if (last_range > 0.0F && gap <= kWidestGap) {
      for (std::size_t k = 1; k < gap; ++k) ranges_[(last + k) % kBearings] = std::min(last_range, range);
    }
    ranges_[now] = ranges_[now] > 0.0F ? std::min(ranges_[now], range) : range;
    last = now;
    last_range = range;
  }
}

bool View::covers(const Point& world) const {
  const double c = std::cos(origin_.theta), s = std::sin(origin_.theta);
  const double dx = world.x - origin_.x, dy = world.y - origin_.y;
  const Point seen{c * dx + s * dy, -s * dx + c * dy};
  const float range = ranges_[index_of(std::atan2(seen.y, seen.x))];
  return range > 0.0F && std::hypot(seen.x, seen.y) <= range + kMargin;
}

}  // namespace frsm
