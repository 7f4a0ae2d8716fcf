// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace oort {

/// Constants of the lanes that were chosen, not derived (docs/architecture.md, two lanes).
struct MapperTuning {
  /// Share of the time between scans that global SLAM is granted, on a laptop. On a machine five times slower it is
  /// half a core.
  static constexpr double kGlobalShare = 0.1;

  // Limits within which the time between scans is believed as stamps tell it.
  static constexpr double kMinInterval = 0.02;  ///< [s]
  static constexpr double kMaxInterval = 0.5;   ///< [s]

  // Motion since the dock was linked within which the robot is still parked there: scans differ by less while it
  // stands.
  static constexpr double kParkedDistance = 0.03;  ///< [m]
  static constexpr double kParkedAngle = 0.03;     ///< [rad]

  // Iterations of a solve.
  static constexpr int kIterations = 15;        ///< while mapping or merging: the poses start near the optimum
  static constexpr int kFinalIterations = 100;  ///< when mapping stops

  // When to solve.
  static constexpr std::uint64_t kMinProgress = 10;    ///< nodes (merging: closures) between solves of the whole graph
  static constexpr std::uint64_t kGrowthParts = 20;    ///< the graph grows by one part in so many between them
  static constexpr std::uint64_t kNewestNodes = 1000;  ///< that are moved when a large graph has a large innovation

  // When an untied segment is looked for on the whole map (docs/tracking.md): after so many nodes,
  static constexpr std::uint64_t kFirstSearch = 4;  ///< where nothing is known of its place
  /// where odometry is merely doubted: closures near by are likelier, and cheaper
  static constexpr std::uint64_t kFirstSearchNearby = 6;
  static constexpr std::uint64_t kLeastSearchSpacing = 2;  ///< then after as many more,
  static constexpr std::uint64_t kSearchGrowthParts = 5;   ///< or one part in so many of what it has by then;
  static constexpr std::uint64_t kDoubtGrowthParts = 2;    ///< of what is merely doubted
  static constexpr std::size_t kNodesPerSearch = 11;       ///< that are looked for together: some 2 m of travel

  // What one search may cost while mapping: about 0.1 s at most. Searches that find something in homes cost a third.
  /// Least share of the best score that a rival has. To 0.75, as for a robot that is looked for on a saved map, the
  /// search of fr079 would not end; the support of what scores less differs by relocalizer.min_lead anyway.
  static constexpr double kRivalScore = 0.85;
  static constexpr std::size_t kSearchPoints = 250;
  static constexpr std::size_t kSearchExpansions = 100000;
  static constexpr std::size_t kSearchPeaks = 8;  ///< where more score as well, the place is ambiguous

  // Two answers agree within this; what they say of a bent map is no better.
  static constexpr double kSameAnswer = 0.3;          ///< [m]
  static constexpr double kSameAnswerAngle = 0.15;    ///< [rad]
  static constexpr double kAnswerTravel = 0.3;        ///< [m] from one answer to the next
  static constexpr std::size_t kAgreeingAnswers = 3;  ///< that are believed, if they are
  static constexpr double kAnswersApart = 1.0;        ///< [m] from the first to the last
  // Errors of an answer that the shape of its match does not show.
  static constexpr double kAnswerSigma = 0.05;        ///< [m]
  static constexpr double kAnswerSigmaTheta = 0.015;  ///< [rad]

  // A place that a search gave is wrong if so many looks in a row see this share of their returns behind walls or on
  // free floor.
  static constexpr double kContradictingShare = 0.3;
  static constexpr int kContradictions = 3;

  static constexpr std::uint64_t kMaxLooks = 16;  ///< for a segment when mapping ends
  static constexpr int kMaxLooksInAll = 100;      ///< some 10 s in a building, 60 s on large grounds (fr-clinic)
  static constexpr int kMaxRounds = 8;            ///< of looking for all of them: what was found helps to find others

  static constexpr double kReferenceMoved = 0.1;  ///< [m] by which a node moves until the map is drawn anew,
  /// which is done once the map has grown by one part in so many: all drawings together cost four of the final map's
  static constexpr std::uint64_t kRedrawParts = 3;

  // When a map that is gone on with stays as it was (docs/lifelong.md). A day's measurements moved places of a
  // simulated home (seed 3) by up to 0.04 m.
  static constexpr double kMaxDeformed = 0.05;       ///< [m] by which the session's measurements move
  static constexpr double kMaxDeformedShare = 0.05;  ///< of its nodes at most
  /// Closures of the session that may be switched off for that: some, and a share of all.
  static constexpr double kMaxLostClosures = 2.0;
  static constexpr double kMaxLostShare = 0.1;

  // When a session that goes on and on is reduced to the views that it needs (docs/lifelong.md).
  static constexpr std::uint64_t kFirstReduction = 1000;  ///< nodes: three drives of four minutes through a home
  static constexpr std::uint64_t kReductionGrowth = 2;    ///< times the nodes that were left
  /// Of the nodes: a first session must drive the same ground again and again. Intel, whose loops are driven three
  /// times, could lose half.
  static constexpr double kMinFirstReducedShare = 0.6;
  static constexpr double kMinReducedShare = 0.4;        ///< the same of a map that was gone on with, or reduced
  static constexpr std::uint64_t kUnsettledNodes = 200;  ///< the newest: what they close may be still looked for

  static constexpr double kLooseSigma = 15.0;  ///< [m, rad] of an edge that shall tell nothing

  // Work units (geometry/work_meter.hpp).
  static constexpr double kWorkPerReferencePoint = 1.5;
  static constexpr double kWorkPerLookup = 0.0015;
  static constexpr double kWorkPerRayStep = 0.006;
  static constexpr double kWorkPerView = 50.0;      ///< node that is looked at whether it is needed,
  static constexpr double kWorkPerReduced = 250.0;  ///< and for the rest of a reduction, beside solving
  static constexpr double kWeighedPlaces = 2.0;     ///< per search, usually
};

}  // namespace oort
