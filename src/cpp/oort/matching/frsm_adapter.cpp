// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/matching/frsm_adapter.hpp"

#include <cmath>

namespace oort {

Rejection rejection_of(frsm::Status status) {
  switch (status) {
    case frsm::Status::kOk:
      return Rejection::kNone;
    case frsm::Status::kEmptyScan:
      return Rejection::kEmptyScan;
    case frsm::Status::kTooFewPoints:
      return Rejection::kTooFewPoints;
    case frsm::Status::kNoOverlap:
      return Rejection::kNoOverlap;
    case frsm::Status::kSaturated:
      return Rejection::kSaturated;
    case frsm::Status::kDegenerate:
      return Rejection::kDegenerate;
    case frsm::Status::kLowHits:
      return Rejection::kLowHits;
  }
  return Rejection::kNotMatched;
}

frsm::Points returns_of(const PointCloud& cloud) {
  frsm::Points points;
  points.reserve(cloud.points.size());
  for (const Point2& point : cloud.points) {
    if (point.is_return()) points.push_back({point.x, point.y});
  }
  return points;
}

Points to_points(const frsm::Points& points) {
  Points same;
  same.reserve(points.size());
  for (const frsm::Point& p : points) same.emplace_back(p.x, p.y);
  return same;
}

void append_transformed(const frsm::Points& points_b, const Pose2& T_a_b, frsm::Points& points_a) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  points_a.reserve(points_a.size() + points_b.size());
  for (const frsm::Point& p : points_b) {
    points_a.push_back({T_a_b.x + c * p.x - s * p.y, T_a_b.y + s * p.x + c * p.y});
  }
}

}  // namespace oort
