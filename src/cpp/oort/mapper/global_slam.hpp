// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "oort/geometry/work_meter.hpp"
#include "oort/loop_closure/closure_log.hpp"
#include "oort/loop_closure/dock_graph_builder.hpp"
#include "oort/loop_closure/loop_closure_builder.hpp"
#include "oort/maintenance/prune.hpp"
#include "oort/mapper/drift_search.hpp"
#include "oort/mapper/former_map.hpp"
#include "oort/mapper/growing_map.hpp"
#include "oort/mapper/look_queue.hpp"
#include "oort/mapper/place_watch.hpp"
#include "oort/mapper/segment_search.hpp"
#include "oort/mapper/solve_schedule.hpp"
#include "oort/mapper/statistics.hpp"
#include "oort/mapper/work_clock.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// What global SLAM found out: closures to add, then a solution that knows them and all before.
struct Correction {
  std::vector<Closure> closures;
  std::optional<Solution> solution;
  GlobalCounts counts;  ///< since the beginning
  /// The clouds without what newer ones contradict, if anything was.
  std::optional<PointClouds> clouds;
  /// First of all: what the nodes known to global SLAM were reduced to, if they were.
  std::shared_ptr<const Pruned> reduced;
  std::vector<bool> docked;  ///< of requests for the dock, oldest first: whether a closure was found
  /// What was found of untied nodes, before the closures that may tie them.
  std::vector<SegmentFinding> segments;
};

/// Global SLAM: looks for loops, matches and confirms them, solves the graph. It works on a map of its own, to which
/// the local lane's nodes are added, in pieces that are charged to a meter. Sequential; knows nothing of threads.
class GlobalSlam {
 public:
  explicit GlobalSlam(const Parameters& parameters);

  /// Replaces the map. Nothing that was begun on the old one goes on.
  void set_map(const Map& map);
  /// A new session: loops are looked for as on a map that was just loaded.
  void begin_session();
  /// Clouds were changed: what was drawn of them shows them as they were.
  void forget_submaps() { loops_ = LoopClosureBuilder(parameters_); }
  void add(const NodeAddition& node);

  /// A node's cloud with some readings taken out. What was drawn of it stays until begin_session().
  void replace_cloud(std::uint64_t node, PointClouds::Shared cloud) { map_.edit().clouds.set(node, std::move(cloud)); }

  void set_locations(std::vector<Location> locations) { map_.edit().locations = std::move(locations); }

  /// Notes that the newest node is at the dock and is to be linked to it.
  void request_dock() { dock_requests_.push_back(map_.node_count() - 1); }

  /// Nodes to come are numbered by the last reduction.
  void reduction_was_taken() { reduction_.is_under_way = false; }

  bool has_work() const;
  /// Does the next piece of work.
  Correction work(WorkMeter& meter);

  /// Works off all that was noted, solves with all that is known, and lets scans agree (refinement.hpp).
  Correction finish();

  /// Works off the requests for the dock: links their nodes to it and solves. Without closures if what they see does
  /// not fit.
  Correction link_docks(WorkMeter* meter = nullptr);

  const Map& map() const { return map_.map(); }
  const GlobalCounts& counts() const { return counts_; }
  const WorkSeconds& work_seconds() const { return work_seconds_; }
  ClosureLog& closure_log() { return closure_log_; }
  const ClosureLog& closure_log() const { return closure_log_; }

 private:
  /// When a session that goes on and on is reduced next.
  struct Reduction {
    std::uint64_t due = 0;      // number of nodes
    bool is_under_way = false;  // the local lane has not taken the last one yet
  };

  Correction nothing() const;
  Correction found(const std::vector<Closure>& closures);
  std::vector<Closure> trusted(std::vector<Closure> closures) const;
  void watch(std::uint64_t node, WorkMeter& meter);
  Correction placed(const SegmentFinding& finding);
  bool may_be_drifted() const;
  Correction closed(const std::vector<Closure>& closures, WorkMeter* meter);
  void work_off(Correction& all);
  void close_far_loops(Correction& all);
  void tie_loose_parts(Correction& all);
  Correction solved();
  void solve_due(SolveSchedule::Extent extent, WorkMeter* meter);
  bool solve_newest(WorkMeter* meter);
  void solve_anew(int max_iterations, WorkMeter* meter = nullptr);
  void leave_former(int max_iterations, WorkMeter* meter);
  OptimizerSummary solve(int max_iterations, std::uint64_t first_free_node, WorkMeter* meter);
  OptimizerSummary solve(const OptimizerOptions& options);
  void count_switches();
  bool is_reduction_due() const;
  Correction reduce(WorkMeter& meter);
  void go_on_with(const Pruned& pruned, std::uint64_t size);
  void begin_schedule();
  std::vector<bool> held() const;

  Parameters parameters_;
  GrowingMap map_;
  LoopClosureBuilder loops_;
  DockGraphBuilder docks_;
  SegmentSearch segment_search_;
  DriftSearch drift_search_;
  PlaceWatch watch_;
  SolveSchedule schedule_;
  LookQueue to_look_from_;
  std::uint64_t session_begin_ = 0;          // the session's first node
  std::optional<FormerMap> former_;          // what is before it, once something was solved
  bool former_stays_ = false;                // whether it is where it was at the last solution
  bool former_gave_way_ = false;             // in this session: its nodes do not jump to and fro
  std::deque<std::uint64_t> dock_requests_;  // the nodes to be linked to the dock
  Reduction reduction_;
  std::vector<bool> is_on_;  // each switchable edge, at the last solution
  GlobalCounts counts_;
  ClosureLog closure_log_;
  WorkSeconds work_seconds_;
};

}  // namespace oort
