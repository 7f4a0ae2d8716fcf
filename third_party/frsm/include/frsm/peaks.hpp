// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>

#include "frsm/matcher.hpp"
#include "frsm/table.hpp"
#include "frsm/types.hpp"

namespace frsm {

struct PeakParams {
  double theta_step = 0.02;                      ///< of the search grid [rad]
  double floor = 0.3;                            ///< peaks of a lower score do not count, 0..1
  double ratio = 0.7;                            ///< nor do those of less than this share of the best score
  double apart_xy = 0.3;                         ///< two poses this near along both axes [m] ...
  double apart_theta = 0.3;                      ///< ... and in heading [rad] are one peak
  std::size_t max_peaks = 32;                    ///< the search ends with so many
  std::size_t max_expansions = 150000;           ///< or when so many squares of shifts were cut in four,
  std::size_t max_expansions_to_first = 150000;  ///< or so many, and no peak was found

  /// Throws std::invalid_argument that names the field when a value makes no sense.
  void validate() const;
};

/// A pose that scores higher than all poses near it.
struct Peak {
  Pose pose;           ///< T_table_body, on the search grid
  double score = 0.0;  ///< mean table value under the points, 0..1
};

struct Peaks {
  std::vector<Peak> peaks;  ///< by falling score
  bool complete = true;     ///< false when the search ended before all peaks above the floor and the ratio were found
};

/// The best poses of a wide window that are apart from each other, with no guess among them: best-first branch and
/// bound (Hess et al. 2016, section V-B) that goes on after the best one. The window is a box about `middle`; its half
/// width in heading is cut at half a turn. Deterministic; cost bounded by `max_expansions`.
/// `on_lookups` is told now and then how many more table values were read.
/// Throws std::invalid_argument on a middle or window that is not finite.
Peaks find_peaks(const Table& table, const Points& body, const Pose& middle, const Window& window,
                 const PeakParams& params, const OnLookups& on_lookups = {});

}  // namespace frsm
