// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace oort {

/// Constants of maps that are driven again and again that were chosen, not derived (docs/lifelong.md). Fitted on
/// simulated homes.
struct LifelongTuning {
  // What is out of date.
  static constexpr double kEvidenceCell = 0.05;  ///< [m]; as maps are drawn
  /// [m] before its return within which a beam says nothing of a surface: poses and ranges err by as much.
  static constexpr double kShy = 0.1;
  /// Share of the farthest return of a session up to which a beam without return found nothing.
  static constexpr double kReachShare = 0.8;
  /// Nodes that must see through a place from the side from which something was seen there. What is driven past is seen
  /// by more; a beam that slips by an edge now and then is not enough.
  static constexpr unsigned kMinSeeThrough = 4;
  static constexpr unsigned kMinSolid = 4;  ///< nodes that must see something where nothing was
  /// Nodes of a segment that are worth asking, where many are asked one after the other.
  static constexpr std::uint64_t kMinWitnesses = 20;
  /// Cells in which more evidence than this is not made: an area of 200 m by 200 m in one drive.
  static constexpr double kMaxEvidenceCells = 16e6;

  // Views.
  static constexpr double kSurfaceCell = 0.2;  ///< [m] of a surface that views are counted of
  static constexpr unsigned kSides = 4;        ///< from which a surface is seen, each a view of its own
  static constexpr double kPlaceCell = 1.0;    ///< [m] of the floor, where each heading is kept once
  static constexpr unsigned kHeadings = 4;     ///< of a place
  /// A view is kept if so large a share of what it shows, and so many surface cells, has less views than wanted.
  static constexpr double kMinNewShare = 0.25;
  static constexpr std::size_t kMinNewCells = 4;
  /// Pruning less than this share of the nodes, or fewer than these, is not worth the change.
  static constexpr double kMinPrunedShare = 0.2;
  static constexpr std::size_t kMinPruned = 100;

  // Folded edges.
  /// Share of the covariance of an edge by scan matching that each of its nodes brings in: neighbours' errors correlate
  /// by -0.33, -0.34, -0.38 (x, y, heading) in eleven simulated homes, -0.15 to -0.42 at views of 60 to 120 degrees.
  static constexpr double kMatchShare = 0.33;
  /// [m] Standard deviation of such an edge (a radian counting as a metre): the median is 0.008 to 0.010 m in those
  /// homes, fr079 and Intel. What nodes of an edge that was folded before bring in is no more.
  static constexpr double kMatchSigma = 0.01;
  /// Of the largest variance of a folded edge what the least one is at least, where rounding left none: well above
  /// double precision, far below what scans and odometry give.
  static constexpr double kLeastOfVariances = 1e-12;

  // Closures.
  /// [m] Standard deviation of the path over which a closure is carried to a node that is kept.
  static constexpr double kMaxCarriedSigma = 0.1;
  /// Of two closures whose ends are no farther apart than so many kept nodes of a segment the more certain one stays.
  static constexpr std::uint64_t kClosureSpan = 2;
};

}  // namespace oort
