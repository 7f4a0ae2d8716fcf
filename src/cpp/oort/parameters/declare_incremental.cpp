// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// incremental_graph_builder: how consecutive nodes are linked.
#include "oort/parameters/internal/declare.hpp"

namespace oort {
namespace {

void declare_debug_viewer(const Section& v, DebugViewerParameters& p) {
  v(p.viewer_scale, "viewer_scale", {4, "", {1, 100}}, "Screen pixels per cell.");
  v(p.history_length, "history_length", {30, "poses", {1, 10000}}, "Latest poses shown.");
  v(p.resolution, "resolution", {0.025, "m", {0.005, 1.0}}, "Cell of the viewer's grid.");
  declare_grid_probabilities(v, p, false);
}

void declare_search(const Section& v, FrsmMatcherParameters& p) {
  v(p.meters_per_pixel, "meters_per_pixel", {0.02, "m", {0.005, 0.5}},
    "Cell of the matcher's table. Documented as unused; used here.")
      .documented(
          0.01,
          "1 cm cells take 1.6 times as long (Intel 23.8 s instead of 14.6 s) at the same error (0.0128 m, 0.0127 m).");
  v(p.theta_resolution, "theta_resolution", {0.01, "rad", {0.001, 0.2}},
    "Angular step of the matcher's search. Documented as unused; used here.");
  v(p.max_num_scans, "max_num_scans", {20, "scans", {2, 1000}},
    "Latest scans that make the matcher's local map: the map holds between half as many and as many, and twice that of "
    "scans that are far apart.");
  v(p.initial_search_range_xy, "initial_search_range_xy", {0.01, "m", {0.0, 5.0}},
    "Half width of the search around the odometry's guess; more where odometry is less certain.");
  v(p.initial_search_range_theta, "initial_search_range_theta", {0.01, "rad", {0.0, 3.15}},
    "Half width of the search in heading.");
  v(p.max_search_range_xy, "max_search_range_xy", {0.1, "m", {0.0, 5.0}},
    "Half width to which the search may grow; 0.3 m at least for scans more than 0.5 s apart and where odometry is "
    "doubted.");
  v(p.max_search_range_theta, "max_search_range_theta", {0.1, "rad", {0.0, 3.15}},
    "Half width in heading to which the search may grow; 0.5 rad at least for scans more than 0.5 s apart and where "
    "odometry is doubted.");
  v(p.add_scan_hit_thresh, "add_scan_hit_thresh", {0.95, "fraction", {0.0, 1.0}},
    "A scan joins the local map if its inlier ratio is lower.");
  v(p.stationary_motion_model, "stationary_motion_model", false,
    "Whether a search without odometry starts at the last pose (else: same velocity).");
  v(p.std_mot_model, "std_mot_model", {0.4, "m^2", {0.0, 1000.0}},
    "Width w of the pull towards the odometry's position: scores are multiplied by exp(-d^2 / w), so w is 2 sigma^2; "
    "up to 0.1 there is no pull.");
  v(p.key_scan_distance, "key_scan_distance", {0.2, "m", {0.0, 100.0}},
    "A matched scan this far from the last one in the local map joins it too; 0: only by inlier ratio.")
      .own(0.0, "Intel 0.207 degrees instead of 0.217; and a parked robot adds no scans.");
  v(p.key_scan_angle, "key_scan_angle", {0.2, "rad", {0.001, 3.15}},
    "The same for a turn; in force with key_scan_distance.")
      .own(0.2);
  v(p.max_point_range, "max_point_range", {25.0, "m", {0.5, 100.0}},
    "Points farther away are not drawn into the matcher's tables.")
      .own(25.0);
  v(p.heading_error_per_meter, "heading_error_per_meter", {0.03, "rad", {0.0, 1.0}},
    "What a matched heading may be off for reasons that no single match shows, such as ranges that are all too long.")
      .own(0.0, "Otherwise long loops in a short-range sensor's map do not close.");
  v(p.information_scale, "information_scale", {1.0, "", {0.001, 1000.0}},
    "Log-likelihood of one point that lies on the map: how much a match counts against what odometry expects. Low, so "
    "that a narrow view that fits well somewhere else is not believed.")
      .own(1.0);
  v(p.match_error_xy, "match_error_xy", {0.0, "m", {0.0, 1.0}},
    "Standard deviation of x and y of a match beyond what the shape of its score shows, of nodes and of closures.")
      .own(0.012, "Covariances follow from the scores and from what is said to be bent.");
  v(p.match_error_theta, "match_error_theta", {0.0, "rad", {0.0, 1.0}}, "The same of its heading.")
      .own(0.0306, "As match_error_xy. The map that the original saved has 0.001 rad^2 for each match.");
}

void declare_odometry_noise(const Section& v, OdometryNoiseParameters& p) {
  v(p.translation_per_meter, "translation_per_meter", {0.1, "m", {0.0, 10.0}},
    "Standard deviation of x and y after one metre.")
      .own(0.1);
  v(p.translation_per_radian, "translation_per_radian", {0.05, "m", {0.0, 10.0}},
    "Standard deviation of x and y after turning one radian.")
      .own(0.05);
  v(p.rotation_per_meter, "rotation_per_meter", {0.1, "rad", {0.0, 10.0}},
    "Standard deviation of the heading after one metre.")
      .own(0.1);
  v(p.rotation_per_radian, "rotation_per_radian", {0.15, "rad", {0.0, 10.0}},
    "Standard deviation of the heading after turning one radian.")
      .own(0.15);
  v(p.translation_floor, "translation_floor", {0.005, "m", {1e-5, 1.0}},
    "Standard deviation of x and y of any motion, however small.")
      .own(0.005);
  v(p.rotation_floor, "rotation_floor", {0.005, "rad", {1e-5, 1.0}}, "Standard deviation of the heading of any motion.")
      .own(0.005);
  v(p.least_learned, "least_learned", {0.2, "", {0.01, 1.0}},
    "How far the standard deviations above may shrink, as a factor, when matches that see all directions keep agreeing "
    "with odometry; they grow (up to 3) when they keep disagreeing. The scales of translation and rotation are learned "
    "too. 1: nothing is learned.")
      .own(1.0,
           "How good a base is differs much. 25 simulated homes seen with 60 degrees: ATE median 0.079 m instead of "
           "0.23 m, 1 broken map instead of 7; with 90 degrees 0.032 m instead of 0.037 m.");
}

void declare_match_filtering(const Section& v, MatchFilteringParameters& p) {
  v(p.dist_accept_threshold, "dist_accept_threshold", {0.06, "m", {0.0, 100.0}}, "Documented as unused.").no_effect();
  v(p.x_min_accept, "x_min_accept", {-1.0, "m", {-100.0, 100.0}},
    "Least forward difference, match minus odometry, that is accepted.")
      .documented(
          -0.05,
          "Odometry may be worse than the match: with the documented gates fr079, whose odometry counts backward "
          "motion as forward, is off by 3.62 m instead of 0.030 m.");
  v(p.x_max_accept, "x_max_accept", {1.0, "m", {-100.0, 100.0}}, "Largest forward difference that is accepted.")
      .documented(0.12, "As x_min_accept.");
  v(p.y_abs_accept, "y_abs_accept", {1.0, "m", {0.0, 100.0}}, "Largest sideways difference that is accepted.")
      .documented(0.11, "As x_min_accept.");
  v(p.theta_abs_accept, "theta_abs_accept", {1.0, "rad", {0.0, 3.15}},
    "Largest difference in heading that is accepted.")
      .documented(0.07, "As x_min_accept.");
  v(p.min_accept_score, "min_accept_score", {0.45, "fraction", {0.0, 1.0}}, "Least inlier ratio that is accepted.");
}

void declare_frsm_matcher(const Section& v, FrsmMatcherParameters& p) {
  v(p.debug, "debug", false, "The original's viewer, which is not there: see oort view.").no_effect();
  declare_debug_viewer(v.section("debug_viewer", ParameterStatus::kNoEffect), p.debug_viewer);
  declare_search(v, p);
  v(p.scanmatch_cov_scale, "scanmatch_cov_scale", {0.35, "", {0.001, 1e6}},
    "Factor on the standard deviations of the match's covariance.")
      .documented(5.0,
                  "Makes covariances honest: NEES 2.4 in simulated homes and in views of 90 and 60 degrees, and 0.45 "
                  "with 1 and information_scale 2. Intel 0.013 m instead of 0.0135 m, and 0.018 m instead of 0.089 m "
                  "with readings cut at 3 m.");
  v(p.inflate_scanmatch_cov_scale, "inflate_scanmatch_cov_scale", {40.0, "", {0.001, 1e6}},
    "Takes the place of scanmatch_cov_scale for the first edge after resume_from_paused.");
  v(p.resume_scanmatch_cov_scale, "resume_scanmatch_cov_scale", {50.0, "", {0.001, 1e6}},
    "Takes the place of scanmatch_cov_scale for the first edge of a new session on an old map.");
  v(p.sm_dist_accept_threshold, "sm_dist_accept_threshold", {0.06, "m", {0.0, 100.0}}, "Documented as unused.")
      .no_effect();
  v(p.sm_angle_accept_threshold, "sm_angle_accept_threshold", {0.07, "rad", {0.0, 3.15}}, "Documented as unused.")
      .no_effect();
  v(p.min_sm_accept_score, "min_sm_accept_score", {0.45, "fraction", {0.0, 1.0}}, "Documented as unused.").no_effect();
  declare_match_filtering(v.section("match_filtering"), p.match_filtering);
}

}  // namespace

void declare_incremental(const Section& v, IncrementalGraphBuilderParameters& p) {
  v(p.odom_cov_xx, "odom_cov_xx", {0.02, "m^2", {1e-9, 1e4}}, "Variance along x of an edge from odometry alone.");
  v(p.odom_cov_yy, "odom_cov_yy", {0.02, "m^2", {1e-9, 1e4}}, "Variance along y of an edge from odometry alone.");
  v(p.odom_cov_tt, "odom_cov_tt", {0.01, "rad^2", {1e-9, 1e4}},
    "Variance of the heading of an edge from odometry alone.");
  v(p.match_every_scan, "match_every_scan", true, "Whether scans between two nodes are matched too.")
      .own(false,
           "Scans between nodes are then located by the matcher instead of by odometry: fr079 0.030 m instead of 2.30 "
           "m, Intel "
           "0.0127 m instead of 0.0217 m.");
  v(p.odometry_model, "odometry_model", {"motion", {"motion", "constant"}},
    "How uncertain odometry is: motion, growing as odometry_noise says; constant, std_mot_model for the matcher and "
    "odom_cov_* for edges.")
      .own("constant", "An edge's weight follows from how far the robot moved: Intel 0.0127 m instead of 0.0130 m.");
  declare_odometry_noise(v.section("odometry_noise"), p.odometry_noise);
  v(p.scanmatcher, "scanmatcher", {"frsm_matcher", {"frsm_matcher", "cartographer_matcher"}},
    "The matcher that links consecutive nodes.");
  declare_frsm_matcher(v.section("frsm_matcher"), p.frsm_matcher);
  declare_cartographer_matcher(v.section("cartographer_matcher"), p.cartographer_matcher);
}

}  // namespace oort
