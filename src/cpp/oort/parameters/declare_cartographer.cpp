// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// The matchers on probability grids, after Cartographer: cartographer_matcher and branch_and_bound_matcher.
#include "oort/parameters/internal/declare.hpp"

namespace oort {
namespace {

constexpr const char* kGates = "As match_filtering of frsm_matcher: odometry may be worse than the match.";
constexpr const char* kFr079 = "As the gates: fr079's odometry counts backward motion as forward.";

struct CeresDefaults {
  double occupied_space, translation, rotation, covariance_scale;
  int iterations;
};

void declare_ceres(const Section& v, CeresScanMatcherParameters& p, const CeresDefaults& d) {
  v(p.occupied_space_cost_functor_weight, "occupied_space_cost_functor_weight", {d.occupied_space, "", {0.0, 1e6}},
    "Weight of points lying on occupied cells.");
  v(p.previous_pose_translation_delta_cost_functor_weight, "previous_pose_translation_delta_cost_functor_weight",
    {d.translation, "", {0.0, 1e6}}, "Weight of keeping the position of the guess.");
  v(p.initial_pose_estimate_rotation_delta_cost_functor_weight,
    "initial_pose_estimate_rotation_delta_cost_functor_weight", {d.rotation, "", {0.0, 1e6}},
    "Weight of keeping the heading of the guess.");
  v(p.covariance_scale, "covariance_scale", {d.covariance_scale, "", {1e-9, 1e6}}, "Factor on the covariance.");
  const Section solver = v.section("ceres_solver_options");
  solver(p.ceres_solver_options.use_nonmonotonic_steps, "use_nonmonotonic_steps", true,
         "Whether the solver may pass through worse steps.");
  solver(p.ceres_solver_options.max_num_iterations, "max_num_iterations", {d.iterations, "", {1, 10000}},
         "Most iterations of the solver.");
  solver(p.ceres_solver_options.num_threads, "num_threads", {1, "", {1, 64}},
         "Threads of the solver. The result is the same.");
}

void declare_grid_ceres(const Section& v, GridCeresScanMatcherParameters& p, double resolution,
                        const CeresDefaults& d) {
  v(p.resolution, "resolution", {resolution, "m", {0.005, 1.0}}, "Cell of the matcher's grid.");
  declare_grid_probabilities(v, p, false);
  declare_ceres(v, p, d);
}

void declare_acceptance(const Section& v, CartographerMatcherParameters& p) {
  v(p.heading_error_per_meter, "heading_error_per_meter", {0.03, "rad", {0.0, 1.0}},
    "What a matched heading may be off for reasons that no single match shows, such as ranges that are all too long.")
      .own(0.0, "As in frsm_matcher.");
  v(p.scanmatch_cov_scale, "scanmatch_cov_scale", {1.0, "", {0.001, 1e6}},
    "Factor on the standard deviations of the match's covariance.")
      .documented(10.0, "As in frsm_matcher.");
  v(p.inflate_scanmatch_cov_scale, "inflate_scanmatch_cov_scale", {40.0, "", {0.001, 1e6}},
    "Takes the place of scanmatch_cov_scale for the first edge after resume_from_paused.");
  v(p.resume_scanmatch_cov_scale, "resume_scanmatch_cov_scale", {50.0, "", {0.001, 1e6}},
    "Takes the place of scanmatch_cov_scale for the first edge of a new session on an old map.");
  v(p.sm_dist_accept_threshold, "sm_dist_accept_threshold", {1.5, "m", {0.0, 100.0}},
    "Largest distance of match and odometry that is accepted.")
      .documented(0.05, kGates);
  v(p.sm_dist_accept_x_min, "sm_dist_accept_x_min", {-1.0, "m", {-100.0, 100.0}},
    "Least forward difference, odometry minus match, that is accepted.")
      .documented(-0.12, kGates);
  v(p.sm_dist_accept_x_max, "sm_dist_accept_x_max", {1.0, "m", {-100.0, 100.0}},
    "Largest forward difference that is accepted.")
      .documented(0.05, kGates);
  v(p.sm_dist_accept_threshold_y, "sm_dist_accept_threshold_y", {1.0, "m", {0.0, 100.0}},
    "Largest sideways difference that is accepted.")
      .documented(0.11, kGates);
  v(p.sm_angle_accept_threshold, "sm_angle_accept_threshold", {1.0, "rad", {0.0, 3.15}},
    "Largest difference in heading that is accepted.")
      .documented(0.1, kGates);
  v(p.min_sm_accept_score, "min_sm_accept_score", {0.2, "fraction", {0.0, 1.0}},
    "Least inlier ratio that is accepted. Scans with a lower one join no local map.")
      .documented(0.0, "A scan of another place must not join; 99 % of 3500 scans of Intel have more than 0.46.");
}

void declare_second_stage(const Section& v, SecondStageMatcherParameters& p) {
  declare_grid_ceres(v.section("ceres_scan_matcher"), p.ceres_scan_matcher, 0.01, {20.0, 20.0, 50.0, 6.0, 50});
  v(p.sm_dist_accept_threshold, "sm_dist_accept_threshold", {0.051, "m", {0.0, 100.0}},
    "Largest distance of match and odometry that is accepted.");
  v(p.sm_angle_accept_threshold, "sm_angle_accept_threshold", {0.07, "rad", {0.0, 3.15}},
    "Largest difference in heading that is accepted.");
  v(p.min_sm_accept_score, "min_sm_accept_score", {0.0, "fraction", {0.0, 1.0}},
    "Least inlier ratio that is accepted.");
}

void declare_lenient_match_filter(const Section& v, MatchFilterParameters& p) {
  const Range fraction{0.0, 1.0};
  const char* const as_frsm = "As in frsm_matcher.match_filter.";
  v(p.close_node_hitpct_threshold, "close_node_hitpct_threshold", {0.0, "fraction", fraction}, as_frsm);
  v(p.close_node_max_dist, "close_node_max_dist", {0.5, "m", {0.0, 1000.0}}, as_frsm);
  v(p.match_max_ang_diff, "match_max_ang_diff", {2.09, "rad", {0.0, 3.15}}, as_frsm);
  v(p.match_hitpct_threshold, "match_hitpct_threshold", {0.0, "fraction", fraction}, as_frsm);
  v(p.match_hitpct_threshold_high, "match_hitpct_threshold_high", {0.0, "fraction", fraction}, as_frsm);
  v(p.opposite_dir_threshold, "opposite_dir_threshold", {1.74, "rad", {0.0, 3.15}}, as_frsm);
  v(p.match_hitpct_threshold_opposite_dir, "match_hitpct_threshold_opposite_dir", {0.0, "fraction", fraction}, as_frsm);
  v(p.match_hitpct_threshold_high_opposite_dir, "match_hitpct_threshold_high_opposite_dir", {0.0, "fraction", fraction},
    as_frsm);
  v(p.match_max_dist, "match_max_dist", {0.5, "m", {0.0, 1000.0}}, as_frsm);
  v(p.match_max_dist_high, "match_max_dist_high", {2.0, "m", {0.0, 1000.0}}, as_frsm);
}

}  // namespace

void declare_cartographer_matcher(const Section& v, CartographerMatcherParameters& p) {
  v(p.debug, "debug", false, "The original's viewer, which is not there: see oort view.").no_effect();
  v(p.debug_viewer_scale, "debug_viewer_scale", {4, "", {1, 100}}, "Screen pixels per cell of the viewer.").no_effect();
  v(p.history_length, "history_length", {60, "scans", {2, 10000}},
    "Latest scans that make the matcher's local map: the map holds between half as many and as many.")
      .documented(30, "With insert_free_space: 150 scans of Intel without loops drift by 0.016 m instead of 0.041 m.");
  v(p.resolution, "resolution", {0.05, "m", {0.01, 1.0}}, "Cell of the matcher's grid.");
  v(p.insert_free_space, "insert_free_space", false, "Whether cells that a beam crosses are updated as free.")
      .documented(true, "As history_length.");
  declare_hit_and_miss(v, p);
  v(p.linear_search_window, "linear_search_window", {0.2, "m", {0.0, 100.0}}, "Half width of the search.")
      .documented(0.1, kFr079);
  v(p.angular_search_window, "angular_search_window", {0.2, "rad", {0.0, 3.15}}, "Half width of the search in heading.")
      .documented(0.1, kFr079);
  v(p.translation_delta_cost_weight, "translation_delta_cost_weight", {2.0, "", {0.0, 1e6}},
    "Weight of keeping the position of the guess.")
      .documented(
          0.1,
          "Matches slide along corridors: Intel 0.033 m instead of 0.15 m with 1. With 5 it is 0.016 m, but then "
          "fr079, whose odometry counts backward motion as forward, breaks (3.1 m instead of 0.030 m).");
  v(p.rotation_delta_cost_weight, "rotation_delta_cost_weight", {0.1, "", {0.0, 1e6}},
    "Weight of keeping the heading of the guess.");
  v(p.key_scan_distance, "key_scan_distance", {0.2, "m", {0.0, 100.0}},
    "A scan joins the local map when it is this far from the last one that joined; 0: every scan.")
      .own(0.0, "A parked robot adds no scans, and the local map reaches back further.");
  v(p.key_scan_angle, "key_scan_angle", {0.1, "rad", {0.0, 3.15}}, "The same for a turn; 0: every scan.")
      .own(0.0, "As key_scan_distance.");
  v(p.max_point_range, "max_point_range", {25.0, "m", {0.5, 100.0}},
    "Points farther away are neither matched nor drawn into the local map.")
      .own(25.0);
  v(p.use_ceres_refinement, "use_ceres_refinement", true, "Whether a Ceres matcher refines the match.");
  declare_grid_ceres(v.section("ceres_scan_matcher"), p.ceres_scan_matcher, 0.025, {20.0, 1.0, 100.0, 0.5, 50});
  declare_acceptance(v, p);
  v(p.use_second_stage_matcher, "use_second_stage_matcher", false, "Whether a second, finer matcher follows.");
  declare_second_stage(v.section("second_stage_matcher"), p.second_stage_matcher);
}

void declare_branch_and_bound_matcher(const Section& v, BranchAndBoundMatcherParameters& p) {
  v(p.debug, "debug", false, "The original's viewer, which is not there: see oort view.").no_effect();
  v(p.debug_draw_original_cloud, "debug_draw_original_cloud", false,
    "Whether the viewer draws the cloud unmatched too.")
      .no_effect();
  v(p.debug_only_show_matched, "debug_only_show_matched", true, "Whether the viewer shows accepted matches only.")
      .no_effect();
  v(p.submap_min_neighborhood_size, "submap_min_neighborhood_size", {3, "nodes", {1, 10000}},
    "Candidates with a smaller submap are rejected.");
  v(p.global_localization_min_score, "global_localization_min_score", {0.21, "fraction", {0.0, 1.0}},
    "Least score of a match without a guess, that is of a place that the relocaliser looks at: the mean of the coarse "
    "table under its points.");
  v(p.min_score, "min_score", {0.55, "fraction", {0.0, 1.0}},
    "Least score of a match: the mean probability of the cells under its points, unknown ones counting 0.1.");
  v(p.search_window_sigmas, "search_window_sigmas", {4.0, "standard deviations", {0.0, 100.0}},
    "As in frsm_matcher; the widest window is that of fast_correlative_scan_matcher.")
      .own(0.0, "As in frsm_matcher.");
  v(p.min_facing_share, "min_facing_share", {0.6, "fraction", {0.0, 1.0}}, "As in frsm_matcher.")
      .own(0.0, "As in frsm_matcher.");
  const Section grid = v.section("probability_grid");
  grid(p.probability_grid.resolution, "resolution", {0.05, "m", {0.005, 1.0}}, "Cell of the submap's grid.");
  declare_grid_probabilities(grid, p.probability_grid, false);
  const Section voxels = v.section("adaptive_voxel_filter");
  voxels(p.adaptive_voxel_filter.max_length, "max_length", {0.9, "m", {0.0, 100.0}},
         "Side of the largest voxel; 0: points are not thinned.");
  voxels(p.adaptive_voxel_filter.min_num_points, "min_num_points", {150, "points", {1, 1000000}},
         "Points that must be left: voxels are as large as this allows.");
  voxels(p.adaptive_voxel_filter.max_range, "max_range", {50.0, "m", {0.0, 1000.0}},
         "Points farther away are dropped.");
  const Section search = v.section("fast_correlative_scan_matcher");
  search(p.fast_correlative_scan_matcher.linear_search_window, "linear_search_window", {7.0, "m", {0.0, 100.0}},
         "Half width of the search.");
  search(p.fast_correlative_scan_matcher.angular_search_window, "angular_search_window", {0.524, "rad", {0.0, 3.15}},
         "Half width of the search in heading.");
  search(p.fast_correlative_scan_matcher.branch_and_bound_depth, "branch_and_bound_depth", {7, "levels", {1, 12}},
         "Levels of precomputed grids.");
  declare_ceres(v.section("ceres_scan_matcher"), p.ceres_scan_matcher, {20.0, 10.0, 1.0, 0.125, 10});
  declare_lenient_match_filter(v.section("match_filter"), p.match_filter);
}

}  // namespace oort
