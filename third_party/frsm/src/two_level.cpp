// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "blocks.hpp"
#include "search.hpp"
#include "slice.hpp"

namespace frsm {
namespace {

constexpr int kSide = BlockMaxima::kSide;

// The shifts from (x, y) * kSide on, kSide in each direction, at one heading.
struct Tile {
  int it = 0, x = 0, y = 0;
  double bound = 0.0;  // of the objective
};

double gap(double value, double low, double high) {
  return std::max({0.0, low - value, value - high});
}

class TwoLevelSearch {
 public:
  explicit TwoLevelSearch(const Search& search) : search_(search), lattice_(search.lattice) {}

  BoundedResult run(int most_tiles) {
    score_tiles();
    const auto better = [](const Tile& a, const Tile& b) {
      return std::tie(b.bound, a.it, a.y, a.x) < std::tie(a.bound, b.it, b.y, b.x);
    };
    const std::size_t count = std::min(tiles_.size(), static_cast<std::size_t>(most_tiles));
    std::partial_sort(tiles_.begin(), tiles_.begin() + static_cast<std::ptrdiff_t>(count), tiles_.end(), better);
    BoundedResult result;
    std::size_t visited = 0;
    while (visited < count && !(best_ && tiles_[visited].bound < best_->value)) visit(tiles_[visited++]);
    result.best = best_;
    result.is_cut_short = visited == count && count < tiles_.size() && !(best_ && best_left(count) < best_->value);
    return result;
  }

 private:
  void score_tiles() {
    const std::shared_ptr<const BlockMaxima> blocks = search_.table.blocks();
    const TableView view = blocks->view();
    const int nx = lattice_.nx / kSide + 1;
    const int ny = lattice_.ny / kSide + 1;
    Slice slice(nx, ny);
    std::vector<Cell> cells;
    for (int it = -lattice_.nt; it <= lattice_.nt; ++it) {
      to_cells(search_.table, search_.body, lattice_.at(it, 0, 0), &cells);
      for (Cell& cell : cells) cell = {BlockMaxima::of(cell.x), BlockMaxima::of(cell.y)};
      slice.score(view, cells);
      for (int y = -ny; y * kSide <= lattice_.ny; ++y) {
        for (int x = -nx; x * kSide <= lattice_.nx; ++x) {
          const std::uint32_t sum = slice.sum(x, y);
          if (sum < search_.least_sum) continue;
          tiles_.push_back({it, x, y, search_.objective.evidence(sum) + prior_bound(it, x, y)});
        }
      }
    }
  }

  double prior_bound(int it, int x, int y) const {
    const auto& gaussian = search_.objective.gaussian();
    if (!gaussian) return 0.0;
    const Pose low = lattice_.at(it, x * kSide, y * kSide);
    const Pose high = lattice_.at(it, x * kSide + kSide - 1, y * kSide + kSide - 1);
    return search_.objective.prior_bound(gap(gaussian->mean.x, low.x, high.x), gap(gaussian->mean.y, low.y, high.y),
                                         std::abs(wrap(low.theta - gaussian->mean.theta)));
  }

  void visit(const Tile& tile) {
    constexpr int kHalf = kSide / 2;
    const int middle_x = tile.x * kSide + kHalf;
    const int middle_y = tile.y * kSide + kHalf;
    to_cells(search_.table, search_.body, lattice_.at(tile.it, 0, 0), &cells_);
    for (Cell& cell : cells_) cell = {cell.x + middle_x, cell.y + middle_y};
    slice_.score(search_.table.view(), cells_);
    for (int iy = std::max(-kHalf, -lattice_.ny - middle_y); iy < std::min(kHalf, lattice_.ny - middle_y + 1); ++iy) {
      for (int ix = std::max(-kHalf, -lattice_.nx - middle_x); ix < std::min(kHalf, lattice_.nx - middle_x + 1); ++ix) {
        consider({tile.it, middle_x + ix, middle_y + iy, slice_.sum(ix, iy), 0.0});
      }
    }
  }

  void consider(Candidate candidate) {
    if (search_.exclusion && search_.exclusion->contains(candidate.it, candidate.ix, candidate.iy)) return;
    if (candidate.sum < search_.least_sum) return;
    candidate.value = search_.objective.evidence(candidate.sum) +
                      search_.objective.prior(lattice_.at(candidate.it, candidate.ix, candidate.iy));
    if (!best_ || search_.better(candidate, *best_)) best_ = candidate;
  }

  // The best bound of the tiles that were not visited.
  double best_left(std::size_t first) const {
    double bound = tiles_[first].bound;
    for (std::size_t i = first; i < tiles_.size(); ++i) bound = std::max(bound, tiles_[i].bound);
    return bound;
  }

  const Search& search_;
  const Lattice& lattice_;
  std::vector<Tile> tiles_;
  std::vector<Cell> cells_;
  Slice slice_{kSide / 2, kSide / 2};
  std::optional<Candidate> best_;
};

}  // namespace

BoundedResult search_two_level(const Search& search, int most_tiles) {
  return TwoLevelSearch(search).run(most_tiles);
}

}  // namespace frsm
