// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <frsm/types.hpp>
#include <memory>
#include <optional>

#include "oort/geometry/pose2.hpp"
#include "oort/graph/graph.hpp"
#include "oort/local_slam/scan_tracker.hpp"
#include "oort/odometry/odometry_model.hpp"
#include "oort/parameters/parameters.hpp"

namespace oort {

/// What the scan matcher says of a node, seen from the last node of its segment whose match was accepted.
struct MatchedEdge {
  Pose2 T_anchor_node;
  Eigen::Matrix3d covariance;              ///< along the axes of the anchor
  Rejection rejection = Rejection::kNone;  ///< why it is not accepted
  /// Whether the match is farther from odometry than odometry errs, so that neither is trusted. Never with the
  /// constant odometry model, nor with a matcher that does not have odometry as its prior, nor of a match that is
  /// rejected for what it is. Of one that is rejected only for how far it is from odometry, odometry's pose counts.
  bool contradicts_odometry = false;
  Pose2 T_anchor_node_weighed;  ///< then: the mean of both by their information; odometry's where the match is free
};

/// What the chosen matcher's section says of edges.
struct EdgeParameters {
  double scanmatch_cov_scale = 1.0;          ///< factors on standard deviations: of matches,
  double inflate_scanmatch_cov_scale = 1.0;  ///< of the first edge after a pause,
  double resume_scanmatch_cov_scale = 1.0;   ///< and of a session's first
  double heading_error_per_meter = 0.0;      ///< [rad/m]
  double min_inlier_ratio = 0.0;             ///< least of a match that is accepted
  /// Whether odometry, as uncertain as it is, is the matcher's prior, so that a match farther from it contradicts it.
  bool odometry_is_prior = false;
};

EdgeParameters edge_parameters(const IncrementalGraphBuilderParameters& parameters);

/// Follows the sensor from scan to scan and links node to node: by the match where it may be trusted, else by odometry
/// (docs/architecture.md, the ten steps of a scan).
class IncrementalGraphBuilder {
 public:
  explicit IncrementalGraphBuilder(const Parameters& parameters);

  /// Starts a fresh local map; its first scan will be at this pose of the local frame.
  void begin(const Pose2& T_local_sensor);

  /// Takes the next scan: its returns in the sensor frame and the sensor's motion by odometry since the last one taken
  /// (since begin(): the identity).
  /// `alternatives`: what the motion may have been instead, where odometry is doubted.
  /// `reversed`: what it may have been if a scan that moved as odometry says would fit badly.
  /// `covariance`: of the motion, along the axes of the frame before, where odometry's model does not tell.
  TrackedScan track(const frsm::Points& points, double time, const Pose2& T_previous_sensor,
                    const std::vector<Pose2>& alternatives = {}, const std::optional<Pose2>& reversed = std::nullopt,
                    const std::optional<Eigen::Matrix3d>& covariance = std::nullopt);

  /// Whether a scan's match says where it is: usable, and with an inlier ratio that is accepted.
  bool is_placed(const TrackedScan& scan) const;

  /// Judges the match of the scan just tracked, which becomes a node, against the motion by odometry since the anchor,
  /// and learns from it how good the odometry is.
  /// The edge's covariance is that of the match and of odometry together; `odometry_has_edges`: of the match alone, as
  /// edges by odometry lead from the anchor to the node already and would count twice.
  /// `doubt`: covariance of what odometry is doubted for over the motion; nothing is learned from it then.
  MatchedEdge make_edge(const Pose2& T_local_anchor, const Pose2& T_anchor_node_odometry, const TrackedScan& node,
                        bool odometry_has_edges, const Eigen::Matrix3d& doubt = Eigen::Matrix3d::Zero());

  /// Overrules the matcher: the scan just tracked is at this pose of the local frame.
  void correct(const Pose2& T_local_sensor);

  /// Whether odometry has a covariance of its own, that grows with the motion (odometry_model).
  bool knows_odometry() const { return motion_model_; }

  /// A motion of the base by odometry, with what it is always wrong by taken out.
  Pose2 corrected(const Pose2& T_before_after) const { return odometry_model_.corrected(T_before_after); }
  const LearnedOdometry& odometry() const { return odometry_model_; }
  bool learns_odometry() const { return motion_model_ && parameters_.odometry_noise.least_learned < 1.0; }

  /// Covariance of a motion by odometry alone, along the axes of the frame before. What has been learned of odometry
  /// holds while scans do not speak against it: with a rejection of what was seen, it is as uncertain as configured.
  Eigen::Matrix3d odometry_covariance(const Pose2& T_before_after, Rejection rejection = Rejection::kNone) const;

 private:
  Eigen::Matrix3d prior_covariance(const Pose2& T_before_after) const;
  Eigen::Matrix3d match_covariance(const TrackedScan& node, double heading, const Eigen::Matrix3d& others,
                                   double distance) const;
  void compare(const TrackedScan& node, double heading, const Pose2& T_anchor_node_odometry,
               const Eigen::Matrix3d& doubt, MatchedEdge& edge) const;
  Eigen::Matrix3d match_information(const TrackedScan& node, double heading) const;

  IncrementalGraphBuilderParameters parameters_;
  bool motion_model_;  // odometry's covariance grows with the motion, else it is constant
  LearnedOdometry odometry_model_;
  EdgeParameters edge_parameters_;
  std::unique_ptr<ScanTracker> tracker_;
};

}  // namespace oort
