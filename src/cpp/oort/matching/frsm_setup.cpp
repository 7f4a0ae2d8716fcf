// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/matching/frsm_setup.hpp"

namespace oort {

frsm::TableParams table_params(const FrsmMatcherParameters& p) {
  frsm::TableParams params;
  params.cell = p.meters_per_pixel;
  params.radius = p.max_point_range;
  return params;
}

frsm::MatcherParams matcher_params(const FrsmMatcherParameters& p) {
  frsm::MatcherParams params;
  params.theta_step = p.theta_resolution;
  params.information_scale = p.information_scale;
  return params;
}

Eigen::Matrix3d match_error(const FrsmMatcherParameters& p) {
  return Eigen::Vector3d(p.match_error_xy, p.match_error_xy, p.match_error_theta).cwiseAbs2().asDiagonal();
}

}  // namespace oort
