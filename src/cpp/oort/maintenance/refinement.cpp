// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/maintenance/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "oort/graph/graph_check.hpp"
#include "oort/graph/graph_solver.hpp"
#include "oort/graph/internal/residuals.hpp"
#include "oort/maintenance/scan_alignment.hpp"
#include "oort/maintenance/tuning.hpp"
#include "oort/maintenance/view_pairs.hpp"

namespace oort {
namespace {

std::vector<int> variables_of(const Graph& graph, const std::vector<bool>& held) {
  std::vector<int> variables;
  int count = 0;
  for (const bool is_anchor : find_anchors(graph)) {
    const bool is_held = variables.size() < held.size() && held[variables.size()];
    variables.push_back(is_anchor || is_held ? -1 : count++);
  }
  return variables;
}

template <typename AnyEdge>
SolverEdge prepare(const AnyEdge& edge, double weight) {
  SolverEdge prepared;
  prepared.i = edge.i;
  prepared.j = edge.j;
  prepared.T_i_j = edge.constraint.T_i_j;
  prepared.W = std::sqrt(weight) * whitening_matrix(edge.constraint.covariance, Whitening::kCorrect);
  return prepared;
}

/// The trajectory's edges, and the closures that are on.
std::vector<SolverEdge> known_edges(const Graph& graph) {
  std::vector<SolverEdge> edges;
  for (const Edge& edge : graph.edges) edges.push_back(prepare(edge, 1.0));
  for (const SwitchableEdge& edge : graph.switchable_edges) {
    if (edge.switch_value < RefinementTuning::kMinSwitch) continue;
    edges.push_back(prepare(edge, RefinementTuning::kClosureShare * edge.switch_value * edge.switch_value));
  }
  return edges;
}

Rejection rejection_of(const ScanAlignment& alignment, double max_distance) {
  if (alignment.pairs < RefinementTuning::kMinPieces || alignment.share < RefinementTuning::kMinShare) {
    return Rejection::kFewSurfaces;
  }
  const bool far = alignment.correction.head<2>().norm() > max_distance ||
                   std::abs(alignment.correction.z()) > RefinementTuning::kMaxTurn;
  return far ? Rejection::kFar : Rejection::kNone;
}

/// The edges between scans at some poses, and how well the scans agree there.
struct ScanEdges {
  std::vector<SolverEdge> edges;
  ClosureCounts counts;
  double weight = 0.0;            // of the pieces paired
  double squared_distance = 0.0;  // [m^2], times weight

  double misfit() const { return weight > 0.0 ? std::sqrt(squared_distance / weight) : 0.0; }
};

ScanEdges edges_between(const std::vector<std::vector<SurfacePiece>>& pieces, const std::vector<ViewPair>& pairs,
                        const std::vector<Pose2>& poses, double max_distance, bool judge) {
  ScanEdges result;
  for (const auto& [i, j] : pairs) {
    ++result.counts.tried;
    const Pose2 T_i_j = between(poses[i], poses[j]);
    const ScanAlignment alignment = align(pieces[i], pieces[j], T_i_j, max_distance);
    if (const Rejection rejection = rejection_of(alignment, max_distance); rejection != Rejection::kNone) {
      ++result.counts.rejected[rejection];
      continue;
    }
    ++result.counts.accepted;
    result.weight += alignment.weight;
    result.squared_distance += alignment.squared_distance;
    SolverEdge edge;
    edge.i = i;
    edge.j = j;
    const Eigen::Vector3d& c = alignment.correction;
    edge.T_i_j = {T_i_j.x + c.x(), T_i_j.y + c.y(), wrap_angle(T_i_j.theta + c.z())};
    const double chi2 = (alignment.W * c).squaredNorm();
    edge.W = judge ? Eigen::Matrix3d(RefinementTuning::kRobustSquaredError /
                                     (RefinementTuning::kRobustSquaredError + chi2) * alignment.W)
                   : alignment.W;
    result.edges.push_back(edge);
  }
  return result;
}

std::vector<Pose2> solved(const std::vector<Pose2>& poses, const std::vector<int>& variables,
                          std::vector<SolverEdge> edges) {
  const std::size_t count = edges.size();
  GraphSolver solver(poses, variables, std::move(edges), RefinementTuning::kRobustSquaredError);
  solver.use(std::vector<bool>(count, true));
  for (int k = 0;
       k < RefinementTuning::kSolverSteps && solver.step(RefinementTuning::kTolerance) == GraphSolver::Progress::kMoved;
       ++k) {
  }
  return solver.poses();
}

}  // namespace

RefinementCounts refine(Map& map, const std::vector<bool>& held) {
  RefinementCounts counts;
  std::vector<std::vector<SurfacePiece>> pieces;
  for (const PointCloud& cloud : map.clouds) pieces.push_back(surface_pieces(cloud));
  std::vector<Pose2> poses;
  for (const Node& node : map.graph.nodes) poses.push_back(node.pose);
  const std::vector<ViewPair> pairs = view_pairs(poses, pieces);
  const std::vector<int> variables = variables_of(map.graph, held);
  const std::vector<SolverEdge> known = known_edges(map.graph);

  ScanEdges scans = edges_between(pieces, pairs, poses, RefinementTuning::kInitialDistance, false);
  const ScanEdges before = edges_between(pieces, pairs, poses, RefinementTuning::kDistance, false);
  for (; counts.rounds < RefinementTuning::kRounds && !scans.edges.empty(); ++counts.rounds) {
    std::vector<SolverEdge> edges = known;
    edges.insert(edges.end(), scans.edges.begin(), scans.edges.end());
    poses = solved(poses, variables, std::move(edges));
    scans = edges_between(pieces, pairs, poses, RefinementTuning::kDistance, true);
  }
  counts.links = scans.counts;
  counts.misfit_before = before.misfit();
  counts.misfit = scans.misfit();
  counts.kept = counts.misfit < counts.misfit_before;
  if (!counts.kept) return counts;
  double moved = 0.0;
  for (Node& node : map.graph.nodes) {
    const Pose2& pose = poses[node.id];
    moved += (pose.translation() - node.pose.translation()).squaredNorm();
    if (variables[node.id] >= 0) node.pose = {pose.x, pose.y, wrap_angle(pose.theta)};
  }
  counts.moved = std::sqrt(moved / static_cast<double>(poses.size()));
  return counts;
}

}  // namespace oort
