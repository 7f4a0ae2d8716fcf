// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

/// The parameters as the engine reads them: nested as params.json is. What each one means, its unit, default and range
/// stand in the table (declare_*.cpp; printed in docs/parameters.md) and nowhere else.
namespace oort {

struct ProbabilityGridParameters {
  double resolution;
  bool insert_free_space;
  double hit_probability;
  double miss_probability;
};

struct OutputGridParameters : ProbabilityGridParameters {
  bool clear_infs;
  double inf_clear_dist;
};

struct ThresholdParameters {
  int max_free;
  int min_occupied;
};

struct MorphologicalParameters {
  int free_space_morpho_iterations;
  int occupied_morpho_iterations;
};

struct MedianParameters {
  int kernel_size;
  int iter;
};

struct OutputMapParameters {
  OutputGridParameters probability_grid;
  ThresholdParameters threshold;
  double robot_radius;
  double footprint_x;
  double footprint_y;
  bool clean_map;
  std::string speckle_strategy;
  MorphologicalParameters morphological;
  MedianParameters median;
};

struct DebugViewerParameters : ProbabilityGridParameters {
  int viewer_scale;
  int history_length;
};

/// Applies to the difference of the matcher's pose to the odometry's: inverse(T_odometry) * T_match.
struct MatchFilteringParameters {
  double dist_accept_threshold;
  double x_min_accept;
  double x_max_accept;
  double y_abs_accept;
  double theta_abs_accept;
  double min_accept_score;
};

/// How far odometry may be off after a motion; variances grow in proportion to translation and rotation.
struct OdometryNoiseParameters {
  double translation_per_meter;
  double translation_per_radian;
  double rotation_per_meter;
  double rotation_per_radian;
  double translation_floor;
  double rotation_floor;
  double least_learned;
};

struct FrsmMatcherParameters {
  bool debug;
  DebugViewerParameters debug_viewer;
  double meters_per_pixel;
  double theta_resolution;
  int max_num_scans;
  double initial_search_range_xy;
  double initial_search_range_theta;
  double max_search_range_xy;
  double max_search_range_theta;
  double add_scan_hit_thresh;
  bool stationary_motion_model;
  double std_mot_model;
  double key_scan_distance;
  double key_scan_angle;
  double max_point_range;
  double heading_error_per_meter;
  double information_scale;
  double match_error_xy;
  double match_error_theta;
  double scanmatch_cov_scale;
  double inflate_scanmatch_cov_scale;
  double resume_scanmatch_cov_scale;
  double sm_dist_accept_threshold;
  double sm_angle_accept_threshold;
  double min_sm_accept_score;
  MatchFilteringParameters match_filtering;
};

struct CeresSolverParameters {
  bool use_nonmonotonic_steps;
  int max_num_iterations;
  int num_threads;
};

struct CeresScanMatcherParameters {
  double occupied_space_cost_functor_weight;
  double previous_pose_translation_delta_cost_functor_weight;
  double initial_pose_estimate_rotation_delta_cost_functor_weight;
  double covariance_scale;
  CeresSolverParameters ceres_solver_options;
};

/// A Ceres matcher with a grid of its own.
struct GridCeresScanMatcherParameters : ProbabilityGridParameters, CeresScanMatcherParameters {};

struct SecondStageMatcherParameters {
  GridCeresScanMatcherParameters ceres_scan_matcher;
  double sm_dist_accept_threshold;
  double sm_angle_accept_threshold;
  double min_sm_accept_score;
};

struct CartographerMatcherParameters : ProbabilityGridParameters {
  bool debug;
  int debug_viewer_scale;
  int history_length;
  double linear_search_window;
  double angular_search_window;
  double translation_delta_cost_weight;
  double rotation_delta_cost_weight;
  double key_scan_distance;
  double key_scan_angle;
  double max_point_range;
  bool use_ceres_refinement;
  GridCeresScanMatcherParameters ceres_scan_matcher;
  double heading_error_per_meter;
  double scanmatch_cov_scale;
  double inflate_scanmatch_cov_scale;
  double resume_scanmatch_cov_scale;
  double sm_dist_accept_threshold;
  double sm_dist_accept_x_min;
  double sm_dist_accept_x_max;
  double sm_dist_accept_threshold_y;
  double sm_angle_accept_threshold;
  double min_sm_accept_score;
  bool use_second_stage_matcher;
  SecondStageMatcherParameters second_stage_matcher;
};

struct IncrementalGraphBuilderParameters {
  double odom_cov_xx;
  double odom_cov_yy;
  double odom_cov_tt;
  bool match_every_scan;
  std::string odometry_model;
  OdometryNoiseParameters odometry_noise;
  std::string scanmatcher;
  FrsmMatcherParameters frsm_matcher;
  CartographerMatcherParameters cartographer_matcher;
};

struct CandidateSearchParameters {
  int knearest_neighbors;
  int submap_neighborhood_size;
  int closest_allowed_id_threshold_large;
  int closest_allowed_id_threshold_small;
  double max_dist_allowed_threshold;
  double max_candidate_distance;
  int candidate_stride;
};

/// Decides whether a loop closure's match is accepted.
struct MatchFilterParameters {
  double close_node_hitpct_threshold;
  double close_node_max_dist;
  double match_max_ang_diff;
  double match_hitpct_threshold;
  double match_max_dist;
  double match_hitpct_threshold_high;
  double match_max_dist_high;
  double opposite_dir_threshold;
  double match_hitpct_threshold_opposite_dir;
  double match_hitpct_threshold_high_opposite_dir;
};

struct FrsmLoopMatcherParameters {
  int submap_min_neighborhood_size;
  double rough_match_hitpct_threshold;
  double fine_match_hitpct_threshold;
  int query_neighborhood_size;
  double search_window_xy;
  double search_window_theta;
  double search_window_sigmas;
  double min_facing_share;
  MatchFilterParameters match_filter;
};

struct AdaptiveVoxelFilterParameters {
  double max_length;
  int min_num_points;
  double max_range;
};

struct FastCorrelativeScanMatcherParameters {
  double linear_search_window;
  double angular_search_window;
  int branch_and_bound_depth;
};

struct BranchAndBoundMatcherParameters {
  bool debug;
  bool debug_draw_original_cloud;
  bool debug_only_show_matched;
  int submap_min_neighborhood_size;
  double global_localization_min_score;
  double min_score;
  double search_window_sigmas;
  double min_facing_share;
  ProbabilityGridParameters probability_grid;
  AdaptiveVoxelFilterParameters adaptive_voxel_filter;
  FastCorrelativeScanMatcherParameters fast_correlative_scan_matcher;
  CeresScanMatcherParameters ceres_scan_matcher;
  MatchFilterParameters match_filter;
};

struct LoopClosureGraphBuilderParameters {
  CandidateSearchParameters candidate_search;
  std::string scanmatcher;
  FrsmLoopMatcherParameters frsm_matcher;
  BranchAndBoundMatcherParameters branch_and_bound_matcher;
};

struct DockGraphBuilderParameters {
  int dock_submap_size;
  int dock_match_submap_size;
  double dock_contacts_size;
  double dock_max_translation;
  double dock_match_max_dist;
  double dock_match_min_hit_pct;
  double search_window_theta;
  int dock_match_least_size;
  double closure_firmness;
};

/// Finding the robot on a map without a guess.
struct RelocalizerParameters {
  int max_scans;
  double scan_distance;
  double scan_angle;
  int min_points;
  double min_support;
  double min_lead;
  double max_position_deviation;
  double max_heading_deviation;
};

/// Following the robot on a map.
struct TrackingParameters {
  double search_window_xy;
  double search_window_theta;
  double min_support;
  double uncertain_deviation;
  double lost_deviation;
  double doubt_distance;
};

/// Localisation on a map that does not change.
struct LocalizationParameters {
  RelocalizerParameters relocalizer;
  TrackingParameters tracking;
};

struct Parameters {
  Parameters();  ///< every value at its default in the table

  std::string base_frame;
  std::string odom_frame;
  std::string sensor_frame;
  std::string map_frame;
  double linear_update;
  double angular_update;
  double time_update;
  bool global_slam_thread;
  bool motion_compensation;
  std::string beam_order;
  bool find_body;
  double max_extrapolation;
  bool use_imu;
  bool use_odometry;
  int min_pointcloud_size;
  double switchable_constraint_scale;
  bool final_refinement;
  int keep_views;
  bool frozen_map;
  std::string robust_kernel;
  double huber_scale;
  OutputMapParameters output_map;
  IncrementalGraphBuilderParameters incremental_graph_builder;
  LoopClosureGraphBuilderParameters loop_closure_graph_builder;
  DockGraphBuilderParameters dock_graph_builder;
  LocalizationParameters localization;
};

}  // namespace oort
