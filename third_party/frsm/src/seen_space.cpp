// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "frsm/seen_space.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace frsm {
namespace {

// A view this wide turns without bias; of a narrower one this much of its edge is left out beside what is new, unless
// too little would be left.
constexpr double kWideView = 2.6;    // [rad]
constexpr double kEdge = 0.03;       // [rad]
constexpr double kLeastTurn = 0.02;  // [rad]
constexpr double kLeastShare = 0.6;

double bearing(const Point& p) {
  return std::atan2(p.y, p.x);
}

}  // namespace

void SeenSpace::add(const Points& body, const Pose& origin, std::size_t most) {
  views_.emplace_back(body, origin);
  while (views_.size() > most) views_.pop_front();
  latest_ = sector_of(body);
}

void SeenSpace::clear() {
  views_.clear();
  latest_ = Sector{};
}

bool SeenSpace::covers(const Point& world) const {
  const auto sees = [&](const View& view) { return view.covers(world); };
  return std::any_of(views_.rbegin(), views_.rend(), sees);  // most points lie within the latest
}

Points SeenSpace::covered(const Points& body, const Pose& pose) const {
  Points points;
  std::copy_if(body.begin(), body.end(), std::back_inserter(points), [&](const Point& p) { return covers(pose * p); });
  return points;
}

Points SeenSpace::without_new_edge(const Points& body, double turn, std::size_t least) const {
  if (latest_.left - latest_.right > kWideView || std::abs(turn) < kLeastTurn) return body;
  const auto is_new = [&](const Point& p) {
    const double angle = wrap(bearing(p) - latest_.middle);
    return turn > 0.0 ? angle > latest_.left - turn - kEdge : angle < latest_.right - turn + kEdge;
  };
  Points old = body;
  old.erase(std::remove_if(old.begin(), old.end(), is_new), old.end());
  const double share = kLeastShare * static_cast<double>(body.size());
  return old.size() >= least && static_cast<double>(old.size()) >= share ? old : body;
}

// A sensor may look anywhere, backwards too: bearings are told from the middle of what it sees.
SeenSpace::Sector SeenSpace::sector_of(const Points& body) {
  Point sum{0.0, 0.0};
  for (const Point& p : body) {
    const double range = std::hypot(p.x, p.y);
    if (range > 0.0) sum = {sum.x + p.x / range, sum.y + p.y / range};
  }
  Sector sector;
  sector.middle = bearing(sum);
  for (const Point& p : body) {
    const double angle = wrap(bearing(p) - sector.middle);
    sector.right = std::min(sector.right, angle);
    sector.left = std::max(sector.left, angle);
  }
  return sector;
}

}  // namespace frsm
