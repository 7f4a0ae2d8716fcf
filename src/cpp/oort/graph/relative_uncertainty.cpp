// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/graph/relative_uncertainty.hpp"

#include <queue>
#include <tuple>
#include <utility>

#include "oort/graph/tuning.hpp"

namespace oort {
namespace {

double size_of(const Eigen::Matrix3d& covariance) {
  return covariance(0, 0) + covariance(1, 1) +
         GraphTuning::kHeadingLever * GraphTuning::kHeadingLever * covariance(2, 2);
}

/// Covariance of T_from_b, given that of T_from_a and of T_a_b, all along the axes of the map: an error of heading at a
/// moves b sideways.
Eigen::Matrix3d extend(const Eigen::Matrix3d& from_a, const Eigen::Vector2d& a_to_b, const Eigen::Matrix3d& a_b) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J(0, 2) = -a_to_b.y();
  J(1, 2) = a_to_b.x();
  return J * from_a * J.transpose() + a_b;
}

}  // namespace

void RelativeUncertainty::update(const Graph& graph) {
  if (graph.nodes.size() < incident_.size() || graph.edges.size() < edges_ ||
      graph.switchable_edges.size() < switchable_edges_) {
    incident_.clear();
    edges_ = switchable_edges_ = 0;
  }
  incident_.resize(graph.nodes.size());
  const auto add = [this](std::uint64_t i, std::uint64_t j, std::uint64_t edge, bool switchable) {
    incident_[i].push_back({j, edge, switchable});
    incident_[j].push_back({i, edge, switchable});
  };
  for (; edges_ < graph.edges.size(); ++edges_) add(graph.edges[edges_].i, graph.edges[edges_].j, edges_, false);
  for (; switchable_edges_ < graph.switchable_edges.size(); ++switchable_edges_) {
    const SwitchableEdge& edge = graph.switchable_edges[switchable_edges_];
    add(edge.i, edge.j, switchable_edges_, true);
  }
}

std::vector<std::optional<Eigen::Matrix3d>> RelativeUncertainty::from(const Graph& graph, std::uint64_t from) const {
  std::vector<std::optional<Eigen::Matrix3d>> known(graph.nodes.size());
  std::vector<Eigen::Matrix3d> reached(graph.nodes.size());
  using Entry = std::tuple<double, std::uint64_t, std::uint64_t>;  // size, order of arrival, node
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> frontier;
  std::vector<double> best(graph.nodes.size(), -1.0);
  std::uint64_t arrivals = 0;
  const auto reach = [&](std::uint64_t node, const Eigen::Matrix3d& covariance) {
    const double size = size_of(covariance);
    if (best[node] >= 0.0 && best[node] <= size) return;
    best[node] = size;
    reached[node] = covariance;
    frontier.emplace(size, arrivals++, node);
  };
  reach(from, Eigen::Matrix3d::Zero());
  while (!frontier.empty()) {
    const std::uint64_t a = std::get<2>(frontier.top());
    frontier.pop();
    if (known[a]) continue;
    known[a] = reached[a];
    for (const Incidence& incident : incident_[a]) {
      if (known[incident.to]) continue;
      if (incident.switchable && !graph.switchable_edges[incident.edge].is_on()) continue;
      const std::uint64_t i =
          incident.switchable ? graph.switchable_edges[incident.edge].i : graph.edges[incident.edge].i;
      const Constraint& constraint = incident.switchable ? graph.switchable_edges[incident.edge].constraint
                                                         : graph.edges[incident.edge].constraint;
      const Eigen::Vector2d a_to_b = graph.nodes[incident.to].pose.translation() - graph.nodes[a].pose.translation();
      // Seen from the other end, the pose is inverted; its covariance along the axes of that end.
      const Eigen::Matrix3d along_a =
          a == i ? constraint.covariance : inverse_covariance(constraint.T_i_j, constraint.covariance);
      reach(incident.to, extend(*known[a], a_to_b, rotate_covariance(along_a, graph.nodes[a].pose.theta)));
    }
  }
  return known;
}

}  // namespace oort
