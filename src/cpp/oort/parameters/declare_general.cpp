// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// The keys at the top of params.json, and those of the dock.
#include "oort/parameters/internal/declare.hpp"

namespace oort {

void declare_general(const Section& v, Parameters& p) {
  v(p.base_frame, "base_frame", {"base_footprint"},
    "TF frame of the robot's base; the motion gate measures its motion.");
  v(p.odom_frame, "odom_frame", {"odom"}, "TF frame that odometry reports in.");
  v(p.sensor_frame, "sensor_frame", {"hokuyo_laser_link"}, "TF frame of the range sensor; a node's pose is its pose.");
  v(p.map_frame, "map_frame", {"map"}, "TF frame of the map.");
  v(p.linear_update, "linear_update", {0.2, "m", {0.001, 100}}, "A new node is made once the base moved this far.");
  v(p.angular_update, "angular_update", {0.6, "rad", {0.001, 3.15}},
    "A new node is made once the base turned this far.");
  v(p.time_update, "time_update", {0.0, "s", {0.0, 86400.0}},
    "A new node is made once so much time has passed since the last one, even if the base stands; 0: a parked robot "
    "adds none.")
      .own(0.0);
  v(p.global_slam_thread, "global_slam_thread", true,
    "Whether loops are looked for and the graph is solved in a thread beside the mapping of scans. The map is the same "
    "without; scans then wait for that work.")
      .own(true);
  v(p.motion_compensation, "motion_compensation", true,
    "Whether the beams of a scan with a time_increment are brought to its stamp by odometry (docs/motion.md).")
      .own(false, "A scan that took 0.1 s while the robot turned at 1 rad/s is bent by 6 degrees otherwise.");
  v(p.beam_order, "beam_order", {"auto", {"auto", "stamped", "reversed"}},
    "In which order the beams of a scan with a time_increment were measured: as it says, the last one first, or as the "
    "scans themselves show while the robot turns (docs/sensor.md).")
      .own("stamped", "Drivers of clockwise lasers turn the beams round and keep their times.");
  v(p.find_body, "find_body", true,
    "Whether beams that see the robot itself are found, by their range that never changes, and left out.")
      .own(false, "A home with 10 degrees of the robot's body at both edges of the view.");
  v(p.max_extrapolation, "max_extrapolation", {0.1, "s", {0.0, 1.0}},
    "How far beyond the last odometry a scan may lie where no more odometry comes: its motion goes on evenly.")
      .own(0.0, "The last scans of a drive count as well.");
  v(p.use_imu, "use_imu", false, "Whether a gyro's yaw rate takes the place of odometry's turns (docs/motion.md).")
      .own(false);
  v(p.use_odometry, "use_odometry", true,
    "Whether odometry says how the base moves. Without, scans alone do: what odometry there may be is ignored "
    "(docs/tracking.md).")
      .own(true);
  v(p.min_pointcloud_size, "min_pointcloud_size", {3, "points", {1, 100000}}, "Scans with fewer returns are skipped.");
  v(p.switchable_constraint_scale, "switchable_constraint_scale", {4.0, "", {1e-6, 1e6}},
    "Weight of the squared pull of a loop closure's switch towards on: the larger, the harder it is switched off.")
      .documented(2.0,
                  "Good closures are not switched off: with readings cut at 3 m, Intel is off by 0.026 m instead of "
                  "1.49 m; the worst of 20 made-up homes by 0.044 m instead of 0.19 m (with 10: 0.030 m and 0.053 m).");
  v(p.final_refinement, "final_refinement", true,
    "Whether scans that saw the same surfaces are brought to agree when mapping stops (docs/refinement.md).")
      .own(false,
           "The median error of 20 made-up homes falls from 0.013 m to 0.007 m, with a view of 90 degrees from 0.037 m "
           "to "
           "0.024 m; Intel with readings cut at 3 m from 0.0177 m to 0.0165 m.");
  v(p.keep_views, "keep_views", {3, "views", {0, 1000}},
    "How many views of a piece of surface from one side a map keeps when it is gone on with; what newer views "
    "contradict is taken out of older ones when mapping stops (docs/lifelong.md). 0: all stays as it was seen.")
      .own(0, "A map that is gone on with day after day otherwise grows with each, and shows what was moved away.");
  v(p.frozen_map, "frozen_map", false,
    "Whether the nodes of a map that is gone on with keep their poses, so that what was drawn by hand on top of it "
    "stays right; only new nodes are moved by solutions.")
      .own(false);
  v(p.robust_kernel, "robust_kernel", {"switchable", {"switchable", "huber"}},
    "How a loop closure that disagrees loses its weight: by a switch, or, as in Cartographer, by Huber's loss.")
      .own("switchable");
  v(p.huber_scale, "huber_scale", {10.0, "standard deviations", {1e-3, 1e6}},
    "From this error on a closure's cost grows in proportion to it, not to its square; with robust_kernel huber.")
      .own(10.0);
}

void declare_dock(const Section& v, DockGraphBuilderParameters& p) {
  v(p.dock_submap_size, "dock_submap_size", {31, "nodes", {2, 10000}},
    "Nodes from the dock's node onwards that make the reference submap.");
  v(p.dock_match_submap_size, "dock_match_submap_size", {7, "nodes", {1, 10000}},
    "Latest nodes that make the submap matched against it; fewer than dock_submap_size.");
  v(p.dock_contacts_size, "dock_contacts_size", {0.15, "m", {0.0, 5.0}},
    "Width of the dock's contacts: how far docked poses may lie apart.");
  v(p.dock_max_translation, "dock_max_translation", {0.25, "m", {0.0, 5.0}},
    "How far the dock may have been moved between two visits.");
  v(p.dock_match_max_dist, "dock_match_max_dist", {0.4, "m", {0.0, 10.0}},
    "Matches that put the two docked poses farther apart are rejected.");
  v(p.dock_match_min_hit_pct, "dock_match_min_hit_pct", {0.6, "fraction", {0.0, 1.0}},
    "Matches with a lower inlier ratio are rejected.");
  v(p.search_window_theta, "search_window_theta", {0.35, "rad", {0.01, 3.15}},
    "Half width of the search in heading: how crooked the robot may stand on the dock.")
      .own(0.35);
  v(p.dock_match_least_size, "dock_match_least_size", {1, "nodes", {1, 10000}},
    "Where the match of the latest nodes is rejected, that of half as many is tried, and so on down to this.")
      .own(7, "A narrow view that turns on the spot before it backs onto the dock bends its last nodes.");
  v(p.closure_firmness, "closure_firmness", {100.0, "", {1.0, 1e6}},
    "How many times as much as for another closure it costs to switch off a matched dock closure.")
      .own(1.0,
           "The robot touches its dock: when the trajectory contradicts that, it is the trajectory that is wrong.");
}

}  // namespace oort
