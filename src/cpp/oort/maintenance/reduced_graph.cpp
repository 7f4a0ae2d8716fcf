// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/reduced_graph.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "oort/geometry/chi_square.hpp"
#include "oort/graph/graph_check.hpp"
#include "oort/graph/tuning.hpp"
#include "oort/maintenance/lifelong_tuning.hpp"

namespace oort {
namespace {

double size_of(const Eigen::Matrix3d& covariance) {
  return covariance(0, 0) + covariance(1, 1) +
         GraphTuning::kHeadingLever * GraphTuning::kHeadingLever * covariance(2, 2);
}

/// Where a node is as seen from another one, with covariance along the axes of that one.
struct Relative {
  Pose2 T;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Covariance, along its own axes, of the node at an end as seen from its neighbour on the way to the other end; none
  /// where scan matching did not place them relative to each other.
  std::optional<Eigen::Matrix3d> begin, end;
};

/// What two edges by scan matching that meet in a node have in common, as a covariance of that node along its axes.
Eigen::Matrix3d shared_covariance(const Eigen::Matrix3d& from_before, const Eigen::Matrix3d& from_after) {
  // Twice their parallel sum: of equal ones it is the same, and never more than their correlation allows.
  const Eigen::Matrix3d mean = 2.0 * from_before * (from_before + from_after).ldlt().solve(from_after);
  const double most = LifelongTuning::kMatchSigma * LifelongTuning::kMatchSigma;
  return LifelongTuning::kMatchShare * std::min(1.0, most / size_of(mean)) * mean;
}

Relative operator*(const Relative& a_b, const Relative& b_c) {
  Relative a_c{a_b.T * b_c.T, compound_covariance(a_b.T, a_b.covariance, b_c.T, b_c.covariance), a_b.begin, b_c.end};
  if (a_b.end && b_c.begin) {  // b's error is in both with opposite signs: counted twice, it is not there at all
    const Eigen::Matrix3d shared = rotate_covariance(shared_covariance(*a_b.end, *b_c.begin), a_b.T.theta);
    a_c.covariance -= 2.0 * compound_covariance(a_b.T, shared, b_c.T, Eigen::Matrix3d::Zero());
  }
  return a_c;
}

Relative inverse(const Relative& a_b) {
  return {inverse(a_b.T), inverse_covariance(a_b.T, a_b.covariance), a_b.end, a_b.begin};
}

/// The covariance itself, or one near it that a map may have: variances of very different size that are put together
/// may leave, by rounding, what is not symmetric or not positive, and large ones more than a map takes.
Eigen::Matrix3d sound(const Eigen::Matrix3d& covariance) {
  if (!find_covariance_defect(covariance)) return covariance;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(0.5 * (covariance + covariance.transpose()));
  const double most = std::min(axes.eigenvalues().maxCoeff(), 0.5 * GraphTuning::kMaxVariance);
  const Eigen::Vector3d variances =
      axes.eigenvalues().cwiseMin(most).cwiseMax(LifelongTuning::kLeastOfVariances * most);
  const Eigen::Matrix3d wider = axes.eigenvectors() * variances.asDiagonal() * axes.eigenvectors().transpose();
  return 0.5 * (wider + wider.transpose());
}

/// What links a node to an earlier one of its trajectory.
struct Step {
  const Edge* edge = nullptr;  ///< none for the first
  std::uint64_t from = 0;
  Relative from_node;
};

Relative relative_of(const Constraint& constraint) {
  Relative i_j{constraint.T_i_j, constraint.covariance, {}, {}};
  if (constraint.type == ConstraintType::kLaser) {
    const Relative j_i = inverse(i_j);
    i_j.begin = rotate_covariance(j_i.covariance, i_j.T.theta);
    i_j.end = rotate_covariance(i_j.covariance, j_i.T.theta);
  }
  return i_j;
}

Step step_of(const Edge& edge) {
  const Relative i_j = relative_of(edge.constraint);
  return edge.i < edge.j ? Step{&edge, edge.i, i_j} : Step{&edge, edge.j, inverse(i_j)};
}

bool is_better(const Edge& edge, const Edge& than) {
  const bool laser = edge.constraint.type == ConstraintType::kLaser;
  if (laser != (than.constraint.type == ConstraintType::kLaser)) return laser;
  return size_of(edge.constraint.covariance) < size_of(than.constraint.covariance);
}

std::vector<Step> steps_of(const Graph& graph) {
  std::vector<Step> steps(graph.nodes.size());
  for (const Edge& edge : graph.edges) {
    Step& step = steps[std::max(edge.i, edge.j)];
    if (step.edge == nullptr || is_better(edge, *step.edge)) step = step_of(edge);
  }
  return steps;
}

/// What was measured along a path, or, where the solution agrees with it, what the solution makes of it: that knows of
/// the edges that go, too.
Pose2 settled(const Graph& graph, std::uint64_t i, std::uint64_t j, const Relative& measured) {
  const Pose2 present = between(graph.nodes[i].pose, graph.nodes[j].pose);
  const Eigen::Vector3d e(present.x - measured.T.x, present.y - measured.T.y,
                          wrap_angle(present.theta - measured.T.theta));
  return e.dot(measured.covariance.ldlt().solve(e)) <= ChiSquare3::k95 ? present : measured.T;
}

/// The kept node by which a node is known best along its trajectory.
struct Carrier {
  std::uint64_t node = 0;
  Relative node_carried;
};

class Reduction {
 public:
  Reduction(const Map& map, const TrajectorySegments& segments, const std::vector<bool>& kept)
      : map_(map), segments_(segments), kept_(kept), steps_(steps_of(map.graph)), carriers_(kept.size()) {
    const std::size_t size = kept.size();
    result_.new_id.resize(size);
    result_.parent.resize(size);
    result_.T_parent_node.resize(size);
    for (std::uint64_t node = 0; node < size; ++node) {
      result_.parent[node] = node;
      if (!kept[node]) continue;
      result_.new_id[node] = result_.graph.nodes.size();
      result_.graph.nodes.push_back({result_.new_id[node], map.graph.nodes[node].pose});
      carriers_[node] = Carrier{node, {}};
    }
  }

  ReducedGraph make() {
    fold_trajectories();
    carry_forward();
    for (const std::optional<Carrier>& carrier : carriers_) result_.carrier.push_back(result_.new_id[carrier->node]);
    choose_closures();
    return std::move(result_);
  }

 private:
  void add_edge(Edge edge) {
    edge.id = next_edge_id_++;
    edge.i = result_.new_id[edge.i];
    edge.j = result_.new_id[edge.j];
    result_.graph.edges.push_back(edge);
  }

  /// Offers a removed node another kept one to be known by.
  void offer(std::uint64_t node, const Carrier& carrier) {
    std::optional<Carrier>& present = carriers_[node];
    if (!present || size_of(carrier.node_carried.covariance) < size_of(present->node_carried.covariance)) {
      present = carrier;
    }
  }

  /// Between kept nodes that follow on one another, what lies between them is marginalised: a chain of edges becomes
  /// one whose covariance is theirs compounded. Removed nodes learn which kept node comes after them.
  void fold_trajectories() {
    for (std::uint64_t node = 0; node < kept_.size(); ++node) {
      if (!kept_[node] || steps_[node].edge == nullptr) continue;
      Relative from_node;  // from `at`
      bool matched = true;
      std::uint64_t at = node;
      do {
        const Step& step = steps_[at];
        from_node = step.from_node * from_node;
        matched = matched && step.edge->constraint.type == ConstraintType::kLaser;
        at = step.from;
        if (!kept_[at]) offer(at, {node, inverse(from_node)});
      } while (!kept_[at]);
      result_.parent[node] = at;
      if (at == steps_[node].from) {
        result_.T_parent_node[node] = from_node.T;
        continue;  // the edge is there already
      }
      result_.T_parent_node[node] = settled(map_.graph, at, node, from_node);
      folded_.emplace(
          node, Edge{0,
                     at,
                     node,
                     {map_.clouds[node].time, result_.new_id[node], result_.T_parent_node[node],
                      sound(from_node.covariance), matched ? ConstraintType::kLaser : ConstraintType::kOdometry}});
    }
    for (Edge edge : map_.graph.edges) {
      if (!kept_[edge.i] || !kept_[edge.j]) continue;
      edge.constraint.id = result_.new_id[std::max(edge.i, edge.j)];
      folded_.emplace(std::max(edge.i, edge.j), edge);
    }
    for (const auto& entry : folded_) add_edge(entry.second);
  }

  /// Removed nodes learn which kept node comes before them.
  void carry_forward() {
    std::vector<Carrier> before(kept_.size());
    for (std::uint64_t node = 0; node < kept_.size(); ++node) {
      if (kept_[node]) {
        before[node] = {node, {}};
        continue;
      }
      const Step& step = steps_[node];
      before[node] = {before[step.from].node, before[step.from].node_carried * step.from_node};
      offer(node, before[node]);
    }
  }

  struct Candidate {
    SwitchableEdge edge;  // between nodes of the old map
    double inlier_ratio = 0.0;
    bool is_dock = false;
  };

  std::vector<Candidate> carried_closures() const {
    std::multimap<std::pair<std::uint64_t, std::uint64_t>, double> inliers;
    for (const LoopResult& r : map_.loop_results) inliers.emplace(std::make_pair(r.id, r.target), r.inlier_ratio);
    std::vector<Candidate> closures;
    for (const SwitchableEdge& edge : map_.graph.switchable_edges) {
      const auto result = inliers.find({edge.i, edge.j});
      Candidate candidate{edge, result == inliers.end() ? 0.0 : result->second, edge.i < edge.j};
      if (carry(candidate)) closures.push_back(candidate);
    }
    return closures;
  }

  /// Carries a closure to the kept nodes by which its ends are known. False if it is lost.
  bool carry(Candidate& candidate) const {
    SwitchableEdge& edge = candidate.edge;
    if (kept_[edge.i] && kept_[edge.j]) return true;
    if (!edge.is_on()) return false;
    const Carrier& i = *carriers_[edge.i];
    const Carrier& j = *carriers_[edge.j];
    constexpr double kMaxVariance = LifelongTuning::kMaxCarriedSigma * LifelongTuning::kMaxCarriedSigma;
    if (size_of(i.node_carried.covariance) + size_of(j.node_carried.covariance) > kMaxVariance) return false;
    if (is_near(i.node, j.node)) return false;
    Relative carried =
        i.node_carried * Relative{edge.constraint.T_i_j, edge.constraint.covariance, {}, {}} * inverse(j.node_carried);
    std::uint64_t from = i.node, to = j.node;
    if ((from < to) != candidate.is_dock) {  // the direction tells a dock closure from others
      std::swap(from, to);
      carried = inverse(carried);
    }
    edge.i = from;
    edge.j = to;
    edge.constraint.T_i_j = settled(map_.graph, from, to, carried);
    edge.constraint.covariance = sound(carried.covariance);
    return true;
  }

  /// Whether the trajectory itself links two kept nodes closely.
  bool is_near(std::uint64_t a, std::uint64_t b) const {
    const std::uint64_t x = result_.new_id[a], y = result_.new_id[b];
    return segments_.same_segment(a, b) && (x > y ? x - y : y - x) <= LifelongTuning::kClosureSpan;
  }

  /// The most certain closure of each neighbourhood, docks first.
  void choose_closures() {
    std::vector<Candidate> closures = carried_closures();
    std::stable_sort(closures.begin(), closures.end(), [](const Candidate& a, const Candidate& b) {
      if (a.is_dock != b.is_dock) return a.is_dock;
      if (a.edge.is_on() != b.edge.is_on()) return a.edge.is_on();
      return size_of(a.edge.constraint.covariance) < size_of(b.edge.constraint.covariance);
    });
    std::vector<Candidate> chosen;
    for (const Candidate& closure : closures) {
      const auto says_the_same = [&](const Candidate& other) {
        return other.is_dock == closure.is_dock && is_near(other.edge.i, closure.edge.i) &&
               is_near(other.edge.j, closure.edge.j);
      };
      if (std::none_of(chosen.begin(), chosen.end(), says_the_same)) chosen.push_back(closure);
    }
    std::stable_sort(chosen.begin(), chosen.end(), [](const Candidate& a, const Candidate& b) {
      return a.edge.id < b.edge.id;  // in the order in which they were found
    });
    for (Candidate& closure : chosen) add_closure(closure);
  }

  void add_closure(Candidate& closure) {
    SwitchableEdge& edge = closure.edge;
    edge.id = next_edge_id_++;
    edge.i = result_.new_id[edge.i];
    edge.j = result_.new_id[edge.j];
    edge.constraint.id = edge.i;
    result_.graph.switchable_edges.push_back(edge);
    result_.loop_results.push_back(
        {edge.i, edge.j, edge.constraint.T_i_j, edge.constraint.covariance, closure.inlier_ratio});
  }

  const Map& map_;
  const TrajectorySegments& segments_;
  const std::vector<bool>& kept_;
  std::vector<Step> steps_;
  std::vector<std::optional<Carrier>> carriers_;
  std::multimap<std::uint64_t, Edge> folded_;  // by the later node
  std::uint64_t next_edge_id_ = 0;
  ReducedGraph result_;
};

}  // namespace

ReducedGraph reduce(const Map& map, const TrajectorySegments& segments, const std::vector<bool>& kept) {
  return Reduction(map, segments, kept).make();
}

}  // namespace oort
