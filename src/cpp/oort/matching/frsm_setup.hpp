// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <frsm/contours.hpp>
#include <frsm/matcher.hpp>
#include <frsm/table.hpp>

#include "oort/parameters/parameters.hpp"

/// How the parameters of incremental_graph_builder.frsm_matcher, which local SLAM, the loops and the dock share, read
/// in the matcher's own terms.
namespace oort {

frsm::TableParams table_params(const FrsmMatcherParameters& p);
frsm::MatcherParams matcher_params(const FrsmMatcherParameters& p);
/// Covariance of a match beyond what the shape of its score shows.
Eigen::Matrix3d match_error(const FrsmMatcherParameters& p);

}  // namespace oort
