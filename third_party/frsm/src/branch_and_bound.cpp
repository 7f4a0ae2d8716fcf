// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "pyramid.hpp"
#include "search.hpp"
#include "slice.hpp"

namespace frsm {
namespace {

// A square of shifts at one heading: 2^level from (ix, iy) upwards, cut at the window.
struct Node {
  int level = 0, it = 0, ix = 0, iy = 0;
  std::uint32_t sum = 0;  // bounds the sums of its shifts; the sum itself at level 0
  double bound = 0.0;     // of the objective
};

constexpr std::uint64_t kTellAfter = 1 << 16;

// The distance from a value to an interval.
double gap(double value, double low, double high) {
  return std::max({0.0, low - value, value - high});
}

// The index of an interval that is nearest to zero.
int innermost(int low, int high) {
  return std::clamp(0, low, high);
}

class BranchAndBound {
 public:
  explicit BranchAndBound(const Search& search)
      : search_(search), lattice_(search.lattice), pyramid_(search.table.bounds(search.on_lookups)) {
    levels_.push_back(search.table.view());
    const int side = 2 * std::max(lattice_.nx, lattice_.ny) + 1;
    for (int h = 1; h <= pyramid_->top() && (1 << (h - 1)) < side; ++h) levels_.push_back(pyramid_->level(h));
    for (int it = -lattice_.nt; it <= lattice_.nt; ++it) {
      to_cells(search.table, search.body, lattice_.at(it, 0, 0), &cells_.emplace_back());
    }
  }

  std::optional<Candidate> run() {
    visit(make_node(0, 0, 0, 0));  // a good start prunes much
    const int top = static_cast<int>(levels_.size()) - 1;
    std::vector<Node> roots;
    for (int it = -lattice_.nt; it <= lattice_.nt; ++it) {
      for (int iy = -lattice_.ny; iy <= lattice_.ny; iy += 1 << top) {
        for (int ix = -lattice_.nx; ix <= lattice_.nx; ix += 1 << top) roots.push_back(make_node(top, it, ix, iy));
      }
    }
    std::stable_sort(roots.begin(), roots.end(), [](const Node& a, const Node& b) { return a.bound > b.bound; });
    for (const Node& root : roots) visit(root);
    tell();
    return best_;
  }

 private:
  void tell() {
    if (search_.on_lookups) search_.on_lookups(lookups_);
    lookups_ = 0;
  }

  Node make_node(int level, int it, int ix, int iy) {
    lookups_ += cells_[it + lattice_.nt].size();
    if (lookups_ >= kTellAfter) tell();
    Node node{level, it, ix, iy, sum_values(levels_[level], cells_[it + lattice_.nt], ix, iy), 0.0};
    const double prior = level == 0 ? search_.objective.prior(lattice_.at(it, ix, iy))
                                    : prior_bound(it, ix, last_x(node), iy, last_y(node));
    node.bound = search_.objective.evidence(node.sum) + prior;
    return node;
  }

  int last_x(const Node& node) const { return std::min(node.ix + (1 << node.level) - 1, lattice_.nx); }
  int last_y(const Node& node) const { return std::min(node.iy + (1 << node.level) - 1, lattice_.ny); }

  double prior_bound(int it, int x0, int x1, int y0, int y1) const {
    const auto& gaussian = search_.objective.gaussian();
    if (!gaussian) return 0.0;
    const Pose low = lattice_.at(it, x0, y0);
    const Pose high = lattice_.at(it, x1, y1);
    return search_.objective.prior_bound(gap(gaussian->mean.x, low.x, high.x), gap(gaussian->mean.y, low.y, high.y),
                                         std::abs(wrap(low.theta - gaussian->mean.theta)));
  }

  bool hopeless(const Node& node) const {
    if (node.sum < search_.least_sum) return true;
    if (!best_) return false;
    if (node.bound != best_->value) return node.bound < best_->value;
    return spread(lattice_, node.it, innermost(node.ix, last_x(node)), innermost(node.iy, last_y(node))) >
           spread(lattice_, best_->it, best_->ix, best_->iy);
  }

  bool excluded(const Node& node) const {
    return search_.exclusion && search_.exclusion->contains(node.it, node.ix, node.iy) &&
           search_.exclusion->contains(node.it, last_x(node), last_y(node));
  }

  void visit(const Node& node) {
    if (hopeless(node) || excluded(node)) return;
    if (node.level == 0) {
      const Candidate candidate{node.it, node.ix, node.iy, node.sum, node.bound};
      if (!best_ || search_.better(candidate, *best_)) best_ = candidate;
      return;
    }
    std::array<Node, 4> children;
    std::size_t count = 0;
    const int half = 1 << (node.level - 1);
    for (const int iy : {node.iy, node.iy + half}) {
      for (const int ix : {node.ix, node.ix + half}) {
        if (ix <= lattice_.nx && iy <= lattice_.ny) children[count++] = make_node(node.level - 1, node.it, ix, iy);
      }
    }
    std::stable_sort(children.begin(), children.begin() + count,
                     [](const Node& a, const Node& b) { return a.bound > b.bound; });
    for (std::size_t i = 0; i < count; ++i) visit(children[i]);
  }

  const Search& search_;
  const Lattice& lattice_;
  std::shared_ptr<const BoundPyramid> pyramid_;
  std::vector<TableView> levels_;
  std::vector<std::vector<Cell>> cells_;  // per heading
  std::optional<Candidate> best_;
  std::uint64_t lookups_ = 0;  // not told of yet
};

}  // namespace

std::optional<Candidate> search_bounded(const Search& search) {
  return BranchAndBound(search).run();
}

}  // namespace frsm
