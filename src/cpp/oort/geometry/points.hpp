// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

namespace oort {

/// The returns of a scan, or of several, in one frame [m]; all finite.
using Points = std::vector<Eigen::Vector2d>;

}  // namespace oort
