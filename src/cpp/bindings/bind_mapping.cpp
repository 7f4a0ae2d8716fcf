// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "bindings.hpp"
#include "guarded.hpp"
#include "oort/maintenance/lifelong_tuning.hpp"
#include "oort/maintenance/prune.hpp"
#include "oort/mapper/mapper.hpp"
#include "scans.hpp"
#include "states.hpp"

namespace py = pybind11;

namespace oort {
namespace {

py::dict dict_of(const RefinementCounts& counts) {
  py::dict dict;
  dict["rounds"] = counts.rounds;
  dict["links"] = dict_of(counts.links);
  dict["misfit_before"] = counts.misfit_before;
  dict["misfit"] = counts.misfit;
  dict["kept"] = counts.kept;
  dict["moved"] = counts.moved;
  return dict;
}

py::dict dict_of(const TrackingCounts& counts) {
  py::dict dict;
  dict["tracking"] = counts.tracking;
  dict["uncertain"] = counts.uncertain;
  dict["lost"] = counts.lost;
  dict["changes"] = counts.changes;
  return dict;
}

py::dict dict_of(const SolvedCounts& counts) {
  py::dict dict;
  dict["kept"] = counts.kept;
  dict["contradicted"] = counts.contradicted;
  dict["came_back"] = counts.came_back;
  return dict;
}

py::dict dict_of(const WorkSeconds& seconds) {
  py::dict dict;
  dict["tracking"] = seconds.tracking;
  dict["candidates"] = seconds.candidates;
  dict["matching"] = seconds.matching;
  dict["solving"] = seconds.solving;
  dict["waiting"] = seconds.waiting;
  return dict;
}

py::list list_of(const ClosureLog& log) {
  py::list list;
  for (const ClosureAttempt& a : log.attempts()) {
    list.append(
        py::make_tuple(a.query, a.candidate, text_of(a.rejection), tuple_of(a.T_candidate_query), a.inlier_ratio));
  }
  return list;
}

const char* name_of(OdometryFault::Kind kind) {
  switch (kind) {
    case OdometryFault::Kind::kJump:
      return "jump";
    case OdometryFault::Kind::kFreeze:
      return "freeze";
    case OdometryFault::Kind::kReversed:
      return "reversed";
  }
  return "unknown";
}

py::dict dict_of(std::uint64_t count, const std::vector<OdometryFault>& faults) {
  py::list first;
  for (const OdometryFault& fault : faults) {
    py::dict one;
    one["kind"] = name_of(fault.kind);
    one["time"] = fault.time;
    one["distance"] = fault.distance;
    one["angle"] = fault.angle;
    first.append(one);
  }
  py::dict dict;
  dict["count"] = count;
  dict["first"] = first;
  return dict;
}

const char* name_of(BeamOrder order) {
  switch (order) {
    case BeamOrder::kStamped:
      return "stamped";
    case BeamOrder::kReversed:
      return "reversed";
    case BeamOrder::kAtOnce:
      return "at_once";
  }
  return "";
}

py::dict dict_of(const LaserFindings& findings) {
  py::list body;
  for (const BodySector& sector : findings.body) body.append(py::make_tuple(sector.from, sector.to, sector.range));
  py::dict costs;
  for (const BeamOrder order : {BeamOrder::kStamped, BeamOrder::kReversed, BeamOrder::kAtOnce}) {
    costs[name_of(order)] = findings.beam_order_evidence.costs[static_cast<std::size_t>(order)];
  }
  py::dict order;
  order["order"] = name_of(findings.beam_order);
  order["decided"] = findings.beam_order_is_decided;
  order["tests"] = findings.beam_order_evidence.tests;
  order["costs"] = costs;
  py::dict dict;
  dict["beam_order"] = order;
  dict["body"] = body;
  dict["repeated_scans"] = findings.repeated_scans;
  return dict;
}

py::dict dict_of(const MapperStatistics& statistics) {
  py::dict dict;
  dict["scans"] = statistics.local.scans;
  dict["scans_too_small"] = statistics.local.scans_too_small;
  dict["scans_matched"] = statistics.trajectory.scans_matched;
  dict["nodes"] = statistics.trajectory.nodes;
  dict["odometry_links"] = statistics.trajectory.odometry_edges;
  dict["match_rejections"] = dict_of(statistics.trajectory.match_rejections);
  dict["contradictions"] = statistics.trajectory.contradictions;
  dict["tracking"] = dict_of(statistics.tracking);
  dict["odometry_faults"] = dict_of(statistics.odometry_fault_count, statistics.odometry_faults);
  py::dict scale;
  scale["translation"] = statistics.odometry_way_scale;
  scale["rotation"] = statistics.odometry_turn_scale;
  dict["odometry_scale"] = scale;
  dict["laser"] = dict_of(statistics.lasers.front());
  py::list others;
  for (std::size_t k = 1; k < statistics.lasers.size(); ++k) others.append(dict_of(statistics.lasers[k]));
  dict["other_lasers"] = others;
  dict["loops"] = dict_of(statistics.global.loops);
  dict["docks"] = dict_of(statistics.global.docks);
  dict["solved"] = dict_of(statistics.global.solved);
  dict["solves"] = statistics.global.solves;
  dict["solves_cut_short"] = statistics.global.solves_cut_short;
  dict["refinement"] = dict_of(statistics.global.refinement);
  return dict;
}

py::list locations_of(const Mapper& mapper) {
  py::list list;
  for (const Location& l : mapper.map().locations) {
    list.append(py::make_tuple(to_str(l.name_space), to_str(l.id), l.node_id, tuple_of(l.T_node_location)));
  }
  return list;
}

std::optional<std::pair<py::array_t<std::int64_t>, py::array_t<double>>> renumbering_of(Mapper& mapper) {
  const std::optional<Renumbering> nodes = mapper.take_renumbering();
  if (!nodes) return std::nullopt;
  const std::size_t size = nodes->carrier.size();
  py::array_t<std::int64_t> carrier(static_cast<py::ssize_t>(size));
  py::array_t<double> poses({static_cast<py::ssize_t>(size), py::ssize_t{3}});
  auto carriers = carrier.mutable_unchecked<1>();
  auto rows = poses.mutable_unchecked<2>();
  for (std::size_t k = 0; k < size; ++k) {
    const auto row = static_cast<py::ssize_t>(k);
    carriers(row) = static_cast<std::int64_t>(nodes->carrier[k]);
    rows(row, 0) = nodes->T_carrier_node[k].x;
    rows(row, 1) = nodes->T_carrier_node[k].y;
    rows(row, 2) = nodes->T_carrier_node[k].theta;
  }
  return std::make_pair(std::move(carrier), std::move(poses));
}

void bind_pruning(py::module_& m) {
  m.def(
      "prune_map",
      [](const Map& map, unsigned views, bool always) {
        const py::gil_scoped_release release;
        if (always) return prune_grown(map, views).map;
        std::optional<Pruned> pruned = prune(map, {views, LifelongTuning::kMinPrunedShare});
        return pruned ? std::move(pruned->map) : map;
      },
      py::arg("map"), py::arg("views"), py::arg("always") = true,
      "The map without the nodes that show no piece of surface that others do not show from the same side so often, "
      "and without what newer segments contradict. Not always: only if that is a good part of the nodes, and nothing "
      "else.");
}

void bind_scan_result(py::module_& m) {
  py::class_<ScanResult>(m, "ScanResult", "What became of a scan.")
      .def_property_readonly(
          "outcome", [](const ScanResult& r) { return r.outcome; }, "What the scan became.")
      .def_readonly("node_id", &ScanResult::node_id, "The node that the pose is relative to, or None.")
      .def_property_readonly(
          "T_node_sensor", [](const ScanResult& r) { return tuple_of(r.T_node_sensor); },
          "The sensor's pose (x, y, theta) seen from the node.")
      .def_readonly("inlier_ratio", &ScanResult::inlier_ratio, "Share of the returns that lie on the local map.")
      .def_readonly("was_tracked", &ScanResult::was_tracked, "Whether the scan matcher was asked.")
      .def_property_readonly(
          "rejection", [](const ScanResult& r) { return text_of(r.rejection); },
          "Why its match is of no use, for people; None if it is.")
      .def_property_readonly(
          "tracking", [](const ScanResult& r) { return r.tracking; }, "How well the sensor's place is known.")
      .def_property_readonly(
          "T_map_base", [](const ScanResult& r) { return tuple_of(r.T_map_base); },
          "The base's pose (x, y, theta) in the map when the scan came.")
      .def_property_readonly(
          "T_map_odom", [](const ScanResult& r) { return tuple_of(r.T_map_odom); },
          "Where odometry's frame was in the map when the scan came.")
      .def_property_readonly(
          "covariance", [](const ScanResult& r) -> py::array_t<double> { return py::cast(r.covariance); },
          "Of the pose as matched (x, y, theta, along the axes of the map), 3x3; zero if it was not matched.")
      .def_readonly("corrected", &ScanResult::corrected, "Whether closures or a solution took effect with the scan.");
}

void bind_scans(py::class_<Guarded<Mapper>>& c) {
  c.def(py::init([](const Parameters& p, const PoseTuple& pose) {
          return std::make_unique<Guarded<Mapper>>(p, pose_of(pose));
        }),
        py::arg("parameters"), py::arg("sensor_on_base") = PoseTuple{0.0, 0.0, 0.0})
      .def(
          "mount_sensor",
          [](Guarded<Mapper>& guard, const PoseTuple& pose) {
            guard.aside([&](Mapper& mapper) { mapper.mount_sensor(pose_of(pose)); });
          },
          py::arg("sensor_on_base"), "Says where the sensor sits on the base, before the first scan.");
  bind_add_ranges(c);
}

void bind_calls(py::class_<Guarded<Mapper>>& c) {
  c.def("request_dock_closure", guarded(&Mapper::request_dock_closure),
        "Has the current place linked to the dock, beside the scans to come.")
      .def_property_readonly("dock_closure_found", guarded(&Mapper::dock_closure_found),
                             "Whether the last request found a closure; None without one, or while it is looked for.")
      .def("notify_docked", guarded(&Mapper::notify_docked),
           "Links the current place to the dock, and waits for that. Whether a closure was found.")
      .def(
          "begin_session",
          [](Guarded<Mapper>& guard, const PoseTuple& pose) {
            guard.aside([&](Mapper& mapper) { mapper.begin_session(pose_of(pose)); });
          },
          py::arg("sensor_on_map"),
          "The next scan begins a new trajectory segment at about this pose of the map, which is pruned first if it "
          "shows most places more often than keep_views asks for: see take_renumbering.")
      .def(
          "take_renumbering", [](Guarded<Mapper>& guard) { return guard.with(&renumbering_of); },
          "What became of the nodes, if the last scan, session or finish gave them other ids, as the map was reduced "
          "to the views that it needs: for each node that there was the node that it became or by which its place is "
          "known now (n,), and where it is seen from there (x, y, theta; n, 3). Else None. Tells it once.")
      .def("resume_from_paused", guarded(&Mapper::resume_from_paused),
           "The next scan makes a node whose link to the last one is very uncertain.")
      .def("finish", guarded(&Mapper::finish), "Brings the map to its final solution.")
      .def(
          "map",
          [](Guarded<Mapper>& guard) { return guard.aside([](const Mapper& mapper) { return Map(mapper.map()); }); },
          "A snapshot of the map.")
      .def(
          "set_map",
          [](Guarded<Mapper>& guard, const Map& map) {
            const Map snapshot = map;
            guard.aside([&](Mapper& mapper) { mapper.set_map(snapshot); });
          },
          py::arg("map"), "Replaces everything by a map from elsewhere.")
      .def_property_readonly("num_nodes",
                             [](Guarded<Mapper>& guard) {
                               return guard.with([](const Mapper& mapper) { return mapper.map().graph.nodes.size(); });
                             })
      .def_property_readonly("has_pose", guarded(&Mapper::has_pose), "Whether the sensor's pose in the map is known.")
      .def_property_readonly(
          "sensor_pose",
          [](Guarded<Mapper>& guard) {
            return guard.with([](const Mapper& mapper) { return tuple_of(mapper.sensor_pose()); });
          },
          "The latest scan's T_map_sensor at the current solution.")
      .def_property_readonly(
          "odom_pose",
          [](Guarded<Mapper>& guard) {
            return guard.with([](const Mapper& mapper) { return tuple_of(mapper.T_map_odom()); });
          },
          "T_map_odom at the current solution.");
}

void bind_places(py::class_<Guarded<Mapper>>& c) {
  c.def(
       "create_location",
       [](Guarded<Mapper>& guard, const std::string& name_space, const std::string& id, const PoseTuple& pose) {
         guard.aside([&](Mapper& mapper) { mapper.create_location(name_space, id, pose_of(pose)); });
       },
       py::arg("name_space"), py::arg("id"), py::arg("pose"), "Names a pose of the map.")
      .def(
          "create_points",
          [](Guarded<Mapper>& guard, const std::vector<std::string>& name_spaces,
             const std::vector<std::array<double, 2>>& points, const std::vector<std::string>& ids) {
            std::vector<Eigen::Vector2d> vectors;
            for (const auto& p : points) vectors.emplace_back(p[0], p[1]);
            guard.aside([&](Mapper& mapper) { mapper.create_points(name_spaces, vectors, ids); });
          },
          py::arg("name_spaces"), py::arg("points"), py::arg("ids"),
          "Names points of the map, relative to the node nearest to their centroid.")
      .def(
          "delete_location",
          [](Guarded<Mapper>& guard, const std::string& name_space, const std::string& id) {
            return guard.aside([&](Mapper& mapper) { return mapper.delete_location(name_space, id); });
          },
          py::arg("name_space"), py::arg("id"))
      .def(
          "locate",
          [](Guarded<Mapper>& guard, const std::string& name_space, const std::string& id) -> std::optional<PoseTuple> {
            const auto pose = guard.aside([&](const Mapper& mapper) { return mapper.locate(name_space, id); });
            return pose ? std::make_optional(tuple_of(*pose)) : std::nullopt;
          },
          py::arg("name_space"), py::arg("id"), "The place's pose in the map now, or None.")
      .def_property_readonly(
          "locations", [](Guarded<Mapper>& guard) { return guard.with(&locations_of); },
          "(namespace, id, node id, T_node_location) of each place.");
}

void bind_figures(py::class_<Guarded<Mapper>>& c) {
  c.def_property_readonly(
       "statistics",
       [](Guarded<Mapper>& guard) {
         return guard.with([](const Mapper& mapper) { return dict_of(mapper.statistics()); });
       },
       "Counts since the mapper was made.")
      .def_property_readonly(
          "work_seconds",
          [](Guarded<Mapper>& guard) {
            return guard.with([](const Mapper& mapper) { return dict_of(mapper.work_seconds()); });
          },
          "CPU seconds since the mapper was made, by kind of work; they differ from run to run.")
      .def("keep_closure_attempts", guarded(&Mapper::keep_closure_attempts), py::arg("capacity"),
           "Keeps the latest attempts to close loops, so many at most.")
      .def_property_readonly(
          "closure_attempts",
          [](Guarded<Mapper>& guard) {
            return guard.with([](const Mapper& mapper) { return list_of(mapper.closure_attempts()); });
          },
          "(query node, candidate node, why it was rejected or None, T_candidate_query, inlier ratio) of each kept.");
}

}  // namespace

py::dict dict_of(const RejectionCounts& counts) {
  py::dict dict;
  for (const auto& [rejection, count] : counts.by_text()) dict[py::str(std::string(to_string(rejection)))] = count;
  return dict;
}

std::optional<std::string> text_of(Rejection rejection) {
  if (rejection == Rejection::kNone) return std::nullopt;
  return std::string(to_string(rejection));
}

py::dict dict_of(const ClosureCounts& counts) {
  py::dict dict;
  dict["tried"] = counts.tried;
  dict["accepted"] = counts.accepted;
  dict["rejected"] = dict_of(counts.rejected);
  return dict;
}

void bind_mapping(py::module_& m) {
  bind_pruning(m);
  bind_scan_result(m);
  py::class_<Guarded<Mapper>> mapper(
      m, "Mapper",
      "Turns scans with odometry into a map. Threads may share it: its calls are made one after the other.");
  bind_scans(mapper);
  bind_calls(mapper);
  bind_places(mapper);
  bind_figures(mapper);
}

}  // namespace oort
