// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "slice.hpp"

namespace frsm {

Objective::Objective(double weight, std::size_t points, const Prior* prior)
    : weight_(weight), per_sum_(weight / (255.0 * static_cast<double>(points))) {
  if (prior == nullptr) return;
  prior_ = *prior;
  information_ = prior->covariance.inverse();
}

double Objective::prior(const Pose& pose) const {
  if (!prior_) return 0.0;
  const Eigen::Vector3d d(pose.x - prior_->mean.x, pose.y - prior_->mean.y, wrap(pose.theta - prior_->mean.theta));
  return -0.5 * d.dot(information_ * d);
}

double Objective::prior_bound(double dx, double dy, double dtheta) const {
  if (!prior_) return 0.0;
  // The squared Mahalanobis distance is never below that of any single coordinate.
  const Eigen::Vector3d variance = prior_->covariance.diagonal();
  const double d2 = std::max({dx * dx / variance[0], dy * dy / variance[1], dtheta * dtheta / variance[2]});
  return -0.5 * d2 * (1.0 - 1e-9);  // stays above through rounding
}

bool Exclusion::contains(int it, int ix, int iy) const {
  return std::abs(it - centre.it) <= nt && std::abs(ix - centre.ix) <= nx && std::abs(iy - centre.iy) <= ny;
}

double spread(const Lattice& lattice, int it, int ix, int iy) {
  const auto part = [](int i, int n) {
    return n > 0 ? static_cast<double>(i) * i / (static_cast<double>(n) * n) : 0.0;
  };
  return part(it, lattice.nt) + part(ix, lattice.nx) + part(iy, lattice.ny);
}

bool Search::better(const Candidate& a, const Candidate& b) const {
  if (a.value != b.value) return a.value > b.value;
  const double spread_a = spread(lattice, a.it, a.ix, a.iy);
  const double spread_b = spread(lattice, b.it, b.ix, b.iy);
  return std::tie(spread_a, a.it, a.iy, a.ix) < std::tie(spread_b, b.it, b.iy, b.ix);
}

std::optional<Candidate> search_all(const Search& search) {
  const Lattice& lattice = search.lattice;
  const TableView table = search.table.view();
  Slice slice(lattice.nx, lattice.ny);
  std::vector<Cell> cells;
  std::optional<Candidate> best;
  for (int it = -lattice.nt; it <= lattice.nt; ++it) {
    to_cells(search.table, search.body, lattice.at(it, 0, 0), &cells);
    slice.score(table, cells);
    if (search.on_lookups) {
      const auto shifts = static_cast<std::uint64_t>((2 * lattice.nx + 1) * (2 * lattice.ny + 1));
      search.on_lookups(cells.size() * shifts / kSideBySide);
    }
    for (int iy = -lattice.ny; iy <= lattice.ny; ++iy) {
      for (int ix = -lattice.nx; ix <= lattice.nx; ++ix) {
        if (search.exclusion && search.exclusion->contains(it, ix, iy)) continue;
        Candidate candidate{it, ix, iy, slice.sum(ix, iy), 0.0};
        if (candidate.sum < search.least_sum) continue;
        candidate.value = search.objective.evidence(candidate.sum);
        if (best && candidate.value < best->value) continue;  // the prior can only lower it
        candidate.value += search.objective.prior(lattice.at(it, ix, iy));
        if (!best || search.better(candidate, *best)) best = candidate;
      }
    }
  }
  return best;
}

}  // namespace frsm
