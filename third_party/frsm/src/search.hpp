// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "frsm/matcher.hpp"

namespace frsm {

/// Cells that are read side by side, in vectors, cost so many times less than those read one by one.
constexpr std::uint64_t kSideBySide = 16;

/// The searched poses: the guess moved by whole cells and heading steps. Its lattice is that of the guess.
struct Lattice {
  Pose guess;
  double cell = 0.0;        // [m]
  double theta_step = 0.0;  // [rad]
  int nx = 0, ny = 0, nt = 0;

  Pose at(int it, int ix, int iy) const {
    return {guess.x + ix * cell, guess.y + iy * cell, wrap(guess.theta + it * theta_step)};
  }
};

/// Log-likelihood of a pose up to a constant: weight * score - 0.5 * |T - prior|^2.
class Objective {
 public:
  /// weight: of a normalised score, 0..1.
  Objective(double weight, std::size_t points, const Prior* prior);

  double weight() const { return weight_; }
  /// Of a sum of table values.
  double evidence(double sum) const { return per_sum_ * sum; }
  /// -0.5 times the squared Mahalanobis distance from the prior; 0 without one.
  double prior(const Pose& pose) const;
  /// Not below prior(pose) for any pose whose offsets from the prior's mean are at least these in size, axis by axis.
  double prior_bound(double dx, double dy, double dtheta) const;
  const std::optional<Prior>& gaussian() const { return prior_; }
  const Eigen::Matrix3d& information() const { return information_; }  // of the prior; 0 without one

 private:
  double weight_;
  double per_sum_;
  std::optional<Prior> prior_;
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
};

/// A pose of the lattice with its score.
struct Candidate {
  int it = 0, ix = 0, iy = 0;
  std::uint32_t sum = 0;  // of table values
  double value = 0.0;     // of the objective
};

/// A box of the lattice to leave out of a search.
struct Exclusion {
  Candidate centre;
  int nx, ny, nt;

  bool contains(int it, int ix, int iy) const;
};

/// Squared distance of a place of the lattice from the guess, in units of the window.
double spread(const Lattice& lattice, int it, int ix, int iy);

/// What is searched.
struct Search {
  const Table& table;
  const Points& body;
  Lattice lattice;
  Objective objective;
  std::optional<Exclusion> exclusion;
  std::uint32_t least_sum = 0;  // candidates of a smaller sum do not count
  OnLookups on_lookups = {};

  /// Strict order of candidates: by value, then nearest to the guess, then by index; never equal for different poses.
  bool better(const Candidate& a, const Candidate& b) const;
};

/// The best candidate, by trying all. Nothing if none counts.
std::optional<Candidate> search_all(const Search& search);

/// The same candidate, by branch and bound: for wide windows.
std::optional<Candidate> search_bounded(const Search& search);

struct BoundedResult {
  std::optional<Candidate> best;
  bool is_cut_short = false;  ///< a better one may be left: there was more to visit than allowed
};

/// The same candidate in bounded work: all tiles of 8 x 8 shifts are bounded, and no more than so many of them, the
/// most promising first, are searched. For windows that are not so wide it costs less than branch and bound, whose
/// bounds take long to build.
BoundedResult search_two_level(const Search& search, std::size_t most_tiles);

}  // namespace frsm
