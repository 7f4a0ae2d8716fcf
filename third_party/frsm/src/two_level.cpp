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

  BoundedResult run(std::size_t most_tiles) {
    score_tiles();
    const auto is_worse = [](const Tile& a, const Tile& b) {
      return std::tie(a.bound, b.it, b.y, b.x) < std::tie(b.bound, a.it, a.y, a.x);
    };
    std::make_heap(tiles_.begin(), tiles_.end(), is_worse);
    const auto may_have_better = [this] { return !tiles_.empty() && !(best_ && tiles_.front().bound < best_->value); };
    for (std::size_t visited = 0; visited < most_tiles && may_have_better(); ++visited) {
      visit(tiles_.front());
      std::pop_heap(tiles_.begin(), tiles_.end(), is_worse);
      tiles_.pop_back();
    }
    return {best_, may_have_better()};
  }

 private:
  void tell(std::uint64_t side_by_side) const {
    if (search_.on_lookups) search_.on_lookups(side_by_side / kSideBySide);
  }

  void score_tiles() {
    const std::shared_ptr<const BlockMaxima> blocks = search_.table.blocks(search_.on_lookups);
    const TableView view = blocks->view();
    const int nx = lattice_.nx / kSide + 1;
    const int ny = lattice_.ny / kSide + 1;
    Slice slice(nx, ny);
    std::vector<Cell> cells;
    for (int it = -lattice_.nt; it <= lattice_.nt; ++it) {
      to_cells(search_.table, search_.body, lattice_.at(it, 0, 0), &cells);
      for (Cell& cell : cells) cell = {BlockMaxima::of(cell.x), BlockMaxima::of(cell.y)};
      slice.score(view, cells);
      tell(cells.size() * static_cast<std::uint64_t>((2 * nx + 1) * (2 * ny + 1)));
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
    tell(cells_.size() * kSide * kSide);
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

  const Search& search_;
  const Lattice& lattice_;
  std::vector<Tile> tiles_;
  std::vector<Cell> cells_;
  Slice slice_{kSide / 2, kSide / 2};
  std::optional<Candidate> best_;
};

}  // namespace

BoundedResult search_two_level(const Search& search, std::size_t most_tiles) {
  return TwoLevelSearch(search).run(most_tiles);
}

}  // namespace frsm
