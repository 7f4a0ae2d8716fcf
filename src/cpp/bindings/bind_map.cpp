// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "oort/map/locations.hpp"
#include "oort/map/map.hpp"
#include "oort/map/map_of_views.hpp"
#include "oort/map/parts.hpp"
#include "oort/render/crop.hpp"
#include "oort/render/render.hpp"
#include "oort/storage/map_file.hpp"
#include "oort/storage/paths.hpp"

namespace py = pybind11;

namespace oort {
namespace {

/// A column of an array of structs: one number per element.
template <typename T, typename Range, typename Get>
py::array_t<T> column(const Range& range, Get&& get) {
  py::array_t<T> result(static_cast<py::ssize_t>(range.size()));
  auto out = result.template mutable_unchecked<1>();
  for (py::ssize_t k = 0; k < out.shape(0); ++k) out(k) = static_cast<T>(get(range[static_cast<std::size_t>(k)]));
  return result;
}

/// Poses as an array (N, 3) of x, y, theta.
template <typename Range, typename Get>
py::array_t<double> poses(const Range& range, Get&& get) {
  py::array_t<double> result({static_cast<py::ssize_t>(range.size()), py::ssize_t{3}});
  auto out = result.mutable_unchecked<2>();
  for (py::ssize_t k = 0; k < out.shape(0); ++k) {
    const Pose2& pose = get(range[static_cast<std::size_t>(k)]);
    out(k, 0) = pose.x;
    out(k, 1) = pose.y;
    out(k, 2) = pose.theta;
  }
  return result;
}

/// Covariances as an array (N, 3, 3).
template <typename Range, typename Get>
py::array_t<double> covariances(const Range& range, Get&& get) {
  py::array_t<double> result({static_cast<py::ssize_t>(range.size()), py::ssize_t{3}, py::ssize_t{3}});
  auto out = result.mutable_unchecked<3>();
  for (py::ssize_t k = 0; k < out.shape(0); ++k) {
    const Eigen::Matrix3d& covariance = get(range[static_cast<std::size_t>(k)]);
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 3; ++col) out(k, row, col) = covariance(row, col);
    }
  }
  return result;
}

/// Of edges of either kind.
template <typename AnyEdge>
py::dict edge_columns(const std::vector<AnyEdge>& edges) {
  py::dict result;
  result["id"] = column<std::uint64_t>(edges, [](const auto& e) { return e.id; });
  result["i"] = column<std::uint64_t>(edges, [](const auto& e) { return e.i; });
  result["j"] = column<std::uint64_t>(edges, [](const auto& e) { return e.j; });
  result["time"] = column<double>(edges, [](const auto& e) { return e.constraint.time; });
  result["node"] = column<std::uint64_t>(edges, [](const auto& e) { return e.constraint.id; });
  result["pose"] = poses(
      edges, [](const auto& e) -> const auto& { return e.constraint.T_i_j; });
  result["covariance"] = covariances(
      edges, [](const auto& e) -> const auto& { return e.constraint.covariance; });
  result["type"] = column<std::uint8_t>(edges, [](const auto& e) { return static_cast<int>(e.constraint.type); });
  return result;
}

py::dict switchable_edge_columns(const Map& map) {
  const auto& edges = map.graph.switchable_edges;
  py::dict result = edge_columns(edges);
  result["switch"] = column<double>(edges, [](const auto& e) { return e.switch_value; });
  return result;
}

py::dict incremental_result_columns(const Map& map) {
  const auto& results = map.incremental_results;
  py::dict columns;
  columns["id"] = column<std::uint64_t>(results, [](const auto& r) { return r.id; });
  columns["target"] = column<std::uint64_t>(results, [](const auto& r) { return r.target; });
  columns["local_pose"] = poses(
      results, [](const auto& r) -> const auto& { return r.T_local_id; });
  columns["covariance"] = covariances(
      results, [](const auto& r) -> const auto& { return r.covariance; });
  columns["pose"] = poses(
      results, [](const auto& r) -> const auto& { return r.T_target_id; });
  columns["hit_fraction"] = column<double>(results, [](const auto& r) { return r.inlier_ratio; });
  return columns;
}

py::dict loop_result_columns(const Map& map) {
  const auto& results = map.loop_results;
  py::dict columns;
  columns["id"] = column<std::uint64_t>(results, [](const auto& r) { return r.id; });
  columns["target"] = column<std::uint64_t>(results, [](const auto& r) { return r.target; });
  columns["pose"] = poses(
      results, [](const auto& r) -> const auto& { return r.T_id_target; });
  columns["covariance"] = covariances(
      results, [](const auto& r) -> const auto& { return r.covariance; });
  columns["hit_fraction"] = column<double>(results, [](const auto& r) { return r.inlier_ratio; });
  return columns;
}

py::array_t<double> cloud_points(const Map& map, std::size_t k) {
  if (k >= map.clouds.size()) throw py::index_error("the map has " + std::to_string(map.clouds.size()) + " clouds");
  const std::vector<Point2>& points = map.clouds[k].points;
  py::array_t<double> result({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
  auto out = result.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < out.shape(0); ++i) {
    const Point2& point = points[static_cast<std::size_t>(i)];
    out(i, 0) = point.x;
    out(i, 1) = point.y;
    out(i, 2) = point.z;
  }
  return result;
}

py::list clouds(const Map& map) {
  py::list result;
  for (std::size_t k = 0; k < map.clouds.size(); ++k) result.append(cloud_points(map, k));
  return result;
}

// Maps and parameters are taken by value (clouds are shared) where Python's lock is given up: other threads may change
// them meanwhile.
RenderedMap rendered(const Map map, const Parameters parameters) {  // NOLINT(*-unnecessary-value-param)
  const py::gil_scoped_release release;
  return render(map, parameters);
}

using Box = std::array<double, 4>;  // x_min, y_min, x_max, y_max

RenderedMap rendered_within(const Map map, const Parameters parameters, const std::optional<Box>& within,
                            const std::optional<std::vector<std::uint64_t>>& nodes) {
  const py::gil_scoped_release release;
  const std::vector<std::uint64_t> chosen = nodes ? *nodes : parts_of(map).main;
  if (!within) return render(map, chosen, parameters);
  const auto& [x_min, y_min, x_max, y_max] = *within;
  const Eigen::AlignedBox2d box(Eigen::Vector2d(x_min, y_min), Eigen::Vector2d(x_max, y_max));
  const Cropped views = choose(map, chosen);
  const Cropped cropped = crop(views.nodes, views.clouds, box);
  return render(cropped.nodes, cropped.clouds, parameters.output_map);
}

py::list loose_parts(const Map& map) {
  py::list result;
  for (const std::vector<std::uint64_t>& nodes : parts_of(map).loose) {
    result.append(py::array_t<std::uint64_t>(static_cast<py::ssize_t>(nodes.size()), nodes.data()));
  }
  return result;
}

std::optional<PoseTuple> located(const Map& map, const std::string& name_space, const std::string& id) {
  const std::optional<Pose2> pose = locate(map, name_space, id);
  return pose ? std::make_optional(tuple_of(*pose)) : std::nullopt;
}

py::list get_locations(const Map& map) {
  py::list result;
  for (const Location& location : map.locations) {
    const Pose2& pose = location.T_node_location;
    result.append(py::make_tuple(to_str(location.name_space), to_str(location.id), location.node_id,
                                 py::make_tuple(pose.x, pose.y, pose.theta)));
  }
  return result;
}

using LocationTuple = std::tuple<std::string, std::string, std::uint64_t, std::tuple<double, double, double>>;

void set_locations(Map& map, const std::vector<LocationTuple>& locations) {
  map.locations.clear();
  for (const auto& [name_space, id, node_id, pose] : locations) {
    map.locations.push_back({name_space, id, node_id, {std::get<0>(pose), std::get<1>(pose), std::get<2>(pose)}});
  }
}

void bind_map_class(py::module_& m) {
  py::class_<Map>(m, "Map",
                  "A map as a map file holds it. All arrays are copies; poses are rows of x, y [m], theta [rad].")
      .def(py::init<>(), "An empty map.")
      .def("__len__", [](const Map& map) { return map.graph.nodes.size(); })
      .def_property_readonly(
          "node_ids",
          [](const Map& map) { return column<std::uint64_t>(map.graph.nodes, [](auto& n) { return n.id; }); },
          "(N,) ids of the nodes, 0...N-1.")
      .def_property_readonly(
          "node_poses",
          [](const Map& map) {
            return poses(
                map.graph.nodes, [](auto& n) -> const auto& { return n.pose; });
          },
          "(N, 3) T_map_sensor of each node.")
      .def_property_readonly(
          "edges", [](const Map& map) { return edge_columns(map.graph.edges); },
          "The links that are always believed, as a dict of arrays: id, i, j, time [s], node (at which it was "
          "calculated), pose (E, 3: T_i_j), covariance (E, 3, 3), type "
          "(0 laser, 1 odometry).")
      .def_property_readonly("switchable_edges", &switchable_edge_columns,
                             "The links that the optimiser may switch off: as edges, and switch in [0, 1].")
      .def("cloud", &cloud_points, py::arg("k"),
           "(M, 3) beams of node k in the sensor's frame, in scan order: x, y, 1 for a return; z is nan otherwise, and "
           "x "
           "nan or inf with y the bearing [rad] where the range was. Raises IndexError.")
      .def_property_readonly("clouds", &clouds, "All of them, in the order of the nodes: a list of arrays as cloud().")
      .def_property_readonly(
          "cloud_times", [](const Map& map) { return column<double>(map.clouds, [](auto& c) { return c.time; }); },
          "(N,) stamp of each cloud [s].")
      .def_property_readonly("incremental_results", &incremental_result_columns,
                             "How each node was linked to the one before it, as a dict of arrays: id, target, "
                             "local_pose (T_local_id), covariance (of local_pose), pose (T_target_id), hit_fraction.")
      .def_property_readonly("loop_results", &loop_result_columns,
                             "How loops were closed, as a dict of arrays: id, target, pose (T_id_target), covariance, "
                             "hit_fraction.")
      .def_property(
          "locations", &get_locations, &set_locations,
          "Named places: a list of (namespace, id, node_id, (x, y, theta)) with the pose in the node's frame. "
          "Assign a list to replace them.")
      .def_property_readonly("loose_parts", &loose_parts,
                             "Nodes that nothing ties to the rest, after a pause, in a session or after a kidnapping: "
                             "for each such part an array of their ids. Where it lies is not known.")
      .def("locate", &located, py::arg("name_space"), py::arg("id"), "A place's pose in the map, or None.")
      .def(
          "save",
          [](const Map& map, const PathText& path) {
            const Map snapshot = map;
            const py::gil_scoped_release release;
            save_map(path.text, snapshot);
          },
          py::arg("path"), "Writes the map's three files as one, as save_map does. Raises MapFileError.")
      .def("render", &rendered, py::arg("parameters") = Parameters(),
           "Draws the map to navigate by; of the parameters output_map counts. Raises ParameterError or InputError.");
}

void bind_storage(py::module_& m) {
  py::enum_<Saved>(m, "Saved", "What save_metadata wrote.")
      .value("MAP", Saved::kMap)
      .value("METADATA", Saved::kMetadata);
  m.def(
      "load_map",
      [](const PathText& path, bool ignore_checksum) {
        const py::gil_scoped_release release;
        return load_map(path.text, LoadOptions{ignore_checksum});
      },
      py::arg("path"), py::arg("ignore_checksum") = false,
      "Reads a map given by its base path, one of its files, or X.capnp. Raises MapFileError.");
  py::class_<MapFormat>(m, "MapFormat", "Which format a map file has.")
      .def_readonly("version", &MapFormat::version, "0 for a map of the original Oort.")
      .def_property_readonly(
          "written_by", [](const MapFormat& format) { return to_str(format.written_by); },
          "The program and its version; empty if it is not known.");
  m.attr("FORMAT_VERSION") = py::int_(kFormatVersion);
  m.def(
      "read_map_format",
      [](const PathText& path, bool ignore_checksum) {
        const py::gil_scoped_release release;
        return read_map_format(path.text, LoadOptions{ignore_checksum});
      },
      py::arg("path"), py::arg("ignore_checksum") = false,
      "In which format a map is, even if it is too new to be loaded. Raises MapFileError.");
  m.def(
      "save_map",
      [](const PathText& path, const Map& map, bool as_original) {
        const Map snapshot = map;
        const py::gil_scoped_release release;
        save_map(path.text, snapshot, SaveOptions{as_original});
      },
      py::arg("path"), py::arg("map"), py::arg("as_original") = false,
      "Writes a map's three files as one, in the newest format or as the original Oort did. Raises MapFileError; the "
      "old map is then still whole.");
  m.def(
      "save_metadata",
      [](const PathText& path, const Map& map) {
        const Map snapshot = map;
        const py::gil_scoped_release release;
        return save_metadata(path.text, snapshot);
      },
      py::arg("path"), py::arg("map"),
      "Writes a map's locations, or the whole map where those on disk would not fit them. Raises MapFileError.");
  m.def(
      "normalise_map_path",
      [](const PathText& path) {
        const std::string base = normalise_map_path(path.text);
        return py::reinterpret_steal<py::str>(
            PyUnicode_DecodeFSDefaultAndSize(base.data(), static_cast<py::ssize_t>(base.size())));
      },
      py::arg("path"),
      "The absolute base path B of a map given as B, B.map_capnp, B.map_meta_capnp or X.capnp, links followed. Raises "
      "MapFileError.");
}

void bind_grids(py::module_& m) {
  py::class_<OccupancyGrid>(m, "OccupancyGrid", "A map to navigate by: the fields of nav_msgs/OccupancyGrid.")
      .def_readonly("resolution", &OccupancyGrid::resolution, "Side of a cell [m].")
      .def_property_readonly(
          "origin", [](const OccupancyGrid& grid) { return std::make_pair(grid.origin_x, grid.origin_y); },
          "Lower left corner (x, y) in the map frame [m].")
      .def_readonly("width", &OccupancyGrid::width, "Columns.")
      .def_readonly("height", &OccupancyGrid::height, "Rows.")
      .def_property_readonly(
          "cells",
          [](const OccupancyGrid& grid) {
            return py::array_t<std::int8_t>({grid.height, grid.width}, grid.cells.data());
          },
          "(height, width) int8, a copy: 0 free, 100 occupied, -1 unknown; row 0 has the least y.");
  py::class_<RenderedMap>(m, "RenderedMap", "A map drawn.")
      .def_readonly("map", &RenderedMap::map, "As the scans say, with the robot's way cleared.")
      .def_readonly("map_cleaned", &RenderedMap::map_cleaned, "The same without speckle noise, for path planning.");
}

void bind_rendering(py::module_& m) {
  m.def(
      "render_map",
      [](const Map& map, const Parameters& parameters, const std::optional<Box>& within,
         const std::optional<std::vector<std::uint64_t>>& nodes) {
        RenderedMap result = rendered_within(map, parameters, within, nodes);
        return std::make_pair(std::move(result.map), std::move(result.map_cleaned));
      },
      py::arg("map"), py::arg("parameters"), py::arg("within") = py::none(), py::arg("nodes") = py::none(),
      "Draws a map without its loose parts, or some nodes of it: (map, map_cleaned), the second without speckle noise. "
      "Of the parameters output_map counts. Of a box within (x_min, y_min, x_max, y_max) [m] only what lies there. "
      "Raises ParameterError or InputError.");
}

}  // namespace

py::str to_str(const std::string& text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace"));
}

void bind_map(py::module_& m) {
  bind_grids(m);
  bind_map_class(m);
  bind_storage(m);
  bind_rendering(m);
  m.def(
      "map_of_views",
      [](const std::vector<PoseTuple>& poses, const std::vector<std::vector<std::array<double, 2>>>& views) {
        std::vector<Pose2> T_map_sensor;
        for (const PoseTuple& pose : poses) T_map_sensor.push_back(pose_of(pose));
        std::vector<PointCloud> clouds(views.size());
        for (std::size_t k = 0; k < views.size(); ++k) {
          for (const auto& [x, y] : views[k]) clouds[k].points.push_back({x, y, 1.0});
        }
        return map_of_views(T_map_sensor, std::move(clouds));
      },
      py::arg("poses"), py::arg("views"),
      "A map without a graph of the returns (x, y, in the sensor frame) seen from each pose (T_map_sensor).");
}

}  // namespace oort
