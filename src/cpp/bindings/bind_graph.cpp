// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bindings.hpp"
#include "oort/geometry/errors.hpp"
#include "oort/graph/landmarks.hpp"
#include "oort/graph/tuning.hpp"
#include "oort/map/map.hpp"

namespace py = pybind11;

namespace oort {
namespace {

template <typename T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

std::string text_of(const std::vector<py::ssize_t>& shape) {
  std::string text;
  for (const py::ssize_t size : shape) text += (text.empty() ? "(" : ", ") + std::to_string(size);
  return text + ")";
}

void require_shape(const py::array& array, const std::vector<py::ssize_t>& shape, const char* name) {
  const std::vector<py::ssize_t> actual(array.shape(), array.shape() + array.ndim());
  if (actual != shape) {
    throw InputError(std::string(name) + " must have the shape " + text_of(shape) + ", not " + text_of(actual));
  }
}

/// The edge at position k of the arrays gets the id k.
Graph graph_of(const Array<double>& node_poses, const Array<std::int64_t>& i, const Array<std::int64_t>& j,
               const Array<double>& measurements, const Array<double>& covariances, const Array<bool>& switchable,
               const std::optional<Array<double>>& switches) {
  const py::ssize_t nodes = node_poses.ndim() > 0 ? node_poses.shape(0) : 0;
  const py::ssize_t edges = i.ndim() > 0 ? i.shape(0) : 0;
  require_shape(node_poses, {nodes, 3}, "node_poses");
  require_shape(i, {edges}, "i");
  require_shape(j, {edges}, "j");
  require_shape(measurements, {edges, 3}, "measurements");
  require_shape(covariances, {edges, 3, 3}, "covariances");
  require_shape(switchable, {edges}, "switchable");
  if (switches) require_shape(*switches, {edges}, "switches");

  Graph graph;
  const auto pose = node_poses.unchecked<2>();
  for (py::ssize_t k = 0; k < nodes; ++k) {
    graph.nodes.push_back({static_cast<std::uint64_t>(k), {pose(k, 0), pose(k, 1), pose(k, 2)}});
  }
  const auto z = measurements.unchecked<2>();
  for (py::ssize_t k = 0; k < edges; ++k) {
    const auto id = static_cast<std::uint64_t>(k);
    const auto from = static_cast<std::uint64_t>(i.at(k)), to = static_cast<std::uint64_t>(j.at(k));
    Constraint constraint;
    constraint.id = to;
    constraint.T_i_j = {z(k, 0), z(k, 1), z(k, 2)};
    constraint.covariance = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(covariances.data(k, 0, 0));
    if (switchable.at(k)) {
      graph.switchable_edges.push_back({id, from, to, constraint, switches ? switches->at(k) : 1.0});
    } else {
      graph.edges.push_back({id, from, to, constraint});
    }
  }
  return graph;
}

py::array_t<double> poses_of(const Graph& graph) {
  py::array_t<double> result({static_cast<py::ssize_t>(graph.nodes.size()), py::ssize_t{3}});
  auto out = result.mutable_unchecked<2>();
  for (const Node& node : graph.nodes) {
    const auto k = static_cast<py::ssize_t>(node.id);
    out(k, 0) = node.pose.x;
    out(k, 1) = node.pose.y;
    out(k, 2) = node.pose.theta;
  }
  return result;
}

/// One number per edge, in the order of the caller's arrays.
py::array_t<double> switches_of(const Graph& graph) {
  py::array_t<double> result(static_cast<py::ssize_t>(graph.edges.size() + graph.switchable_edges.size()));
  auto out = result.mutable_unchecked<1>();
  for (const Edge& edge : graph.edges) out(static_cast<py::ssize_t>(edge.id)) = 1.0;
  for (const SwitchableEdge& edge : graph.switchable_edges) out(static_cast<py::ssize_t>(edge.id)) = edge.switch_value;
  return result;
}

std::tuple<py::array_t<double>, py::array_t<double>, OptimizerSummary> optimize_graph(
    const Array<double>& node_poses, const Array<std::int64_t>& i, const Array<std::int64_t>& j,
    const Array<double>& measurements, const Array<double>& covariances, const Array<bool>& switchable,
    const OptimizerOptions& options, const std::optional<Array<double>>& switches) {
  Graph graph = graph_of(node_poses, i, j, measurements, covariances, switchable, switches);
  OptimizerSummary summary;
  {
    const py::gil_scoped_release release;
    summary = optimize(graph, options);
  }
  return {poses_of(graph), switches_of(graph), summary};
}

/// The place in the drive of each time, by the stamps of the clouds. InputError for a time before the first node or
/// after the last.
LandmarkObservation placed(const Map& map, double time) {
  for (std::size_t k = 0; k + 1 < map.clouds.size(); ++k) {
    const double before = map.clouds[k].time, after = map.clouds[k + 1].time;
    if (before <= time && time <= after) {
      LandmarkObservation observation;
      observation.before = k;
      observation.after = k + 1;
      observation.fraction = after > before ? (time - before) / (after - before) : 0.0;
      return observation;
    }
  }
  throw InputError("landmark observation at " + std::to_string(time) + " s: no two nodes were made around that time");
}

std::tuple<std::map<std::uint64_t, std::tuple<double, double, double>>, OptimizerSummary> optimize_map_with_landmarks(
    Map& map, const Array<double>& times, const Array<std::int64_t>& landmarks, const Array<double>& measurements,
    const Array<double>& covariances, const OptimizerOptions& options) {
  const py::ssize_t count = times.ndim() > 0 ? times.shape(0) : 0;
  require_shape(times, {count}, "times");
  require_shape(landmarks, {count}, "landmarks");
  require_shape(measurements, {count, 3}, "measurements");
  require_shape(covariances, {count, 3, 3}, "covariances");
  std::vector<LandmarkObservation> observations;
  const auto z = measurements.unchecked<2>();
  for (py::ssize_t k = 0; k < count; ++k) {
    LandmarkObservation observation = placed(map, times.at(k));
    observation.landmark = static_cast<std::uint64_t>(landmarks.at(k));
    observation.T_sensor_landmark = {z(k, 0), z(k, 1), z(k, 2)};
    observation.covariance = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(covariances.data(k, 0, 0));
    observations.push_back(observation);
  }
  Landmarks found;
  const OptimizerSummary summary = optimize_with_landmarks(map.graph, observations, found, options);
  std::map<std::uint64_t, std::tuple<double, double, double>> poses;
  for (const auto& [id, pose] : found) poses[id] = {pose.x, pose.y, pose.theta};
  return {poses, summary};
}

void bind_options(py::module_& m) {
  py::enum_<Whitening>(m, "Whitening", "How an error e is weighted by its information L L^T.")
      .value("CORRECT", Whitening::kCorrect, "L^T e")
      .value("ORIGINAL", Whitening::kOriginal, "L e, as Mayfield's Oort did");
  py::enum_<RobustKernel>(m, "RobustKernel", "How a switchable link that disagrees loses its weight.")
      .value("SWITCHABLE", RobustKernel::kSwitchable, "by its switch")
      .value("HUBER", RobustKernel::kHuber, "its cost grows in proportion to its error, no longer its square");
  py::class_<OptimizerOptions>(m, "OptimizerOptions", "How the pose graph is solved.")
      .def(py::init([](double scale, Whitening whitening, int max_iterations, bool decide, std::uint64_t first_free,
                       RobustKernel kernel, double huber) {
             return OptimizerOptions{scale, whitening, max_iterations, decide, first_free, kernel, huber};
           }),
           py::kw_only(), py::arg("switchable_constraint_scale") = OptimizerOptions{}.switchable_constraint_scale,
           py::arg("whitening") = OptimizerOptions{}.whitening,
           py::arg("max_iterations") = OptimizerOptions{}.max_iterations, py::arg("decide") = OptimizerOptions{}.decide,
           py::arg("first_free_node") = OptimizerOptions{}.first_free_node,
           py::arg("robust_kernel") = OptimizerOptions{}.robust_kernel,
           py::arg("huber_scale") = OptimizerOptions{}.huber_scale)
      .def_readwrite("switchable_constraint_scale", &OptimizerOptions::switchable_constraint_scale,
                     "The squared Mahalanobis distance at which a link is half switched off.")
      .def_readwrite("whitening", &OptimizerOptions::whitening)
      .def_readwrite("max_iterations", &OptimizerOptions::max_iterations)
      .def_readwrite("decide", &OptimizerOptions::decide,
                     "Whether links that disagree with the optimum of the switches (at 95 %) are then left out.")
      .def_readwrite("first_free_node", &OptimizerOptions::first_free_node, "Nodes before this one keep their poses.")
      .def_readwrite("robust_kernel", &OptimizerOptions::robust_kernel)
      .def_readwrite("huber_scale", &OptimizerOptions::huber_scale,
                     "Standard deviations from which on a link's cost is no longer squared, with HUBER.");
  py::class_<OptimizerSummary>(m, "OptimizerSummary", "How solving the pose graph went.")
      .def_readonly("converged", &OptimizerSummary::converged)
      .def_readonly("iterations", &OptimizerSummary::iterations)
      .def_readonly("initial_cost", &OptimizerSummary::initial_cost,
                    "Half the sum of chi^2 over the edges and of scale chi^2 / (scale + chi^2) over the switchable "
                    "ones, chi^2 being the squared Mahalanobis distance.")
      .def_readonly("final_cost", &OptimizerSummary::final_cost)
      .def_property_readonly(
          "chi_squared",
          [](const OptimizerSummary& summary) {
            return py::array_t<double>(static_cast<py::ssize_t>(summary.chi_squared.size()),
                                       summary.chi_squared.data());
          },
          "(S,) of each switchable edge, in their order, at the final poses.")
      .def_readonly("message", &OptimizerSummary::message, "Why the solver stopped.");
}

}  // namespace

void bind_graph(py::module_& m) {
  bind_options(m);
  m.attr("SWITCH_ON") = kSwitchOn;
  m.attr("AGREEMENT_CHI2") = GraphTuning::kAgreement;
  m.attr("ODOMETRY_EDGE") = static_cast<int>(ConstraintType::kOdometry);
  m.def(
      "optimize_graph", &optimize_graph, py::arg("node_poses"), py::arg("i"), py::arg("j"), py::arg("measurements"),
      py::arg("covariances"), py::arg("switchable"), py::arg("options") = OptimizerOptions{},
      py::arg("switches") = py::none(),
      "Solves a pose graph given as arrays: node_poses (N, 3: x, y [m], theta [rad]) to start from; for each of M "
      "edges the nodes i and j (M,), the measured T_i_j (M, 3), its covariance (M, 3, 3; along the axes of node i) "
      "and whether it may be switched off (M,). `switches` (M,) are those of an earlier solution; without them all are "
      "new. The first node of each connected part keeps its pose. Returns "
      "(poses (N, 3), switches (M,) in [0, 1], summary). Raises InputError and ParameterError.");
  m.def(
      "optimize_map",
      [](Map& map, const OptimizerOptions& options) {
        Graph graph = map.graph;
        const OptimizerOptions copy = options;
        OptimizerSummary summary;
        {
          const py::gil_scoped_release release;
          summary = optimize(graph, copy);
        }
        map.graph = std::move(graph);
        return summary;
      },
      py::arg("map"), py::arg("options") = OptimizerOptions{},
      "Solves the pose graph of a map in place, from its poses and switches. Dock closures of a Mapper's map are as "
      "firm as its parameters say (docs/optimiser.md), those of a "
      "map that was loaded are like others. Returns the summary. Raises InputError and ParameterError; the map is then "
      "unchanged.");
  m.def("optimize_map_with_landmarks", &optimize_map_with_landmarks, py::arg("map"), py::arg("times"),
        py::arg("landmarks"), py::arg("measurements"), py::arg("covariances"), py::arg("options") = OptimizerOptions{},
        "Solves the pose graph of a map in place, always with Huber's loss, together with landmarks that are known "
        "again when they are seen: for each of M observations the time (M,) [s], which landmark it is (M,), its pose "
        "in the sensor frame (M, 3), and the covariance of that (M, 3, 3). The sensor is where it was between the two "
        "nodes made before and after. Returns (pose in the map by landmark, summary). Raises InputError and "
        "ParameterError; the map is then unchanged.");
}

}  // namespace oort
