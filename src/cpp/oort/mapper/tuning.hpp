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
  static constexpr std::uint64_t kDoubtGrowthParts = 2;    ///< of what is merely doubted, and not contradicted,
  static constexpr std::uint64_t kSearchSoon = 60;         ///< and of all that has more nodes

  // Answers that agree with each other are believed:
  static constexpr double kAgreeingAnswers = 3.0;  ///< so many,
  static constexpr double kAnswersApart = 1.0;     ///< [m] from the first to the last
  /// A place that a search gave is wrong if so many looks in a row contradict it.
  static constexpr int kContradictions = 3;

  /// Looks in a row after which odometry is believed where it was merely doubted: they confirm where it has the robot,
  /// or nothing contradicts it and no place of the map looks like what it sees.
  static constexpr int kQuietLooks = 3;

  // Where drift may be more than loops are searched for (DriftSearch): what was mapped so much way before is older,
  static constexpr double kDriftWay = 30.0;  ///< [m]: outdoors 30 m are seen
  // and is looked for so far around where the map has them, at most: near by mostly, which takes 15 ms, and farther off
  // at each third look, which takes 0.2 s.
  static constexpr double kDriftNear = 30.0;      ///< [m]
  static constexpr double kDriftNearTheta = 0.5;  ///< [rad]
  static constexpr double kDriftFar = 100.0;     ///< [m]; the hospital's grounds, with 5 mm of noise, 88 m after 1.2 km
  static constexpr double kDriftFarTheta = 0.8;  ///< [rad]
  static constexpr int kDriftFarEvery = 3;
  static constexpr std::size_t kDriftFarExpansions = 240000;
  static constexpr std::uint64_t kDriftSpacing = 25;     ///< [nodes at the usual spacing] from one look to the next,
  static constexpr std::uint64_t kDriftSpacingSoon = 4;  ///< and while answers wait for others
  static constexpr std::uint64_t kDriftAtEnd = 15;  ///< such looks when mapping ends: many drives end where they began
  static constexpr double kDriftViewSpacing = 1.0;  ///< [m] between views, and between the nodes they are looked for on
  /// Outdoors half of what is seen was not there before. That answers agree says more: of 125 stretches of 20 looks of
  /// Killian court (whole and at 3 m), the hospital, Intel and fr079 (3 m), expected up to 20 m and 0.2 rad off, 36
  /// of the 56 that lead where the map was known were found, and none at a wrong place.
  static constexpr double kDriftSupport = 0.3;
  /// [nodes at the usual spacing] After closures that solving contradicts it is looked for no more for so long.
  static constexpr std::uint64_t kDriftPause = 250;
  static constexpr int kDriftMisses = 8;             ///< looks without an answer after which those before are forgotten
  static constexpr double kDriftAnswersApart = 3.0;  ///< [m] from the first to the last
  static constexpr double kLookAgain = 1.0;  ///< [m] by which a loop must move a node that looks for loops again

  // How far somebody may have carried a robot whose odometry is merely doubted: so far from one scan to the next, and
  // farther while it was switched off or saw nothing.
  static constexpr double kCarriedFar = 20.0;   ///< [m]
  static constexpr double kCarriedSpeed = 2.0;  ///< [m/s]

  static constexpr std::uint64_t kMaxLooks = 16;  ///< for a segment when mapping ends
  static constexpr double kFinalSearch = 2e6;     ///< [work units] of all looks when mapping ends
  static constexpr int kMaxRounds = 8;            ///< of looking for all of them: what was found helps to find others

  // Whether a node is where the map has it (PlaceWatch). It is compared with so many older nodes around it,
  static constexpr std::size_t kWatchNeighbours = 4;
  static constexpr std::uint64_t kWatchAge = 30;  ///< [nodes] older at least: from another passage
  static constexpr double kWatchReach = 1.5;      ///< [m] within this, a radian of heading counting as
  static constexpr double kWatchLever = 0.5;      ///< [m]
  static constexpr int kLeastCompared = 60;       ///< returns, of both sides
  // A return lies on what must be free if it is nearer than what the other node saw there by more than
  static constexpr double kFreeMargin = 0.25;       ///< [m]
  static constexpr double kFreeMarginShare = 0.05;  ///< and this share of its range
  /// Share of such returns above which a node is suspect. In homes 97 % of the nodes have less than 0.03, and half of
  /// those at a wrong place more than 0.14 (homes 105 and 128 of bench/kidnapped.py).
  static constexpr double kSuspectShare = 0.1;
  static constexpr std::size_t kWatched = 4;  ///< latest nodes that are weighed,
  static constexpr int kSuspects = 3;         ///< so many of which must be suspect
  /// Answers that agree on another place are believed against scans that fitted each other where nothing was mapped,
  /// too.
  static constexpr double kAnswersAgainstMap = 5.0;

  /// [nodes] After so many a place that was found to be right may be doubted again; and a new local map that was begun
  /// no longer before is where the doubt begins.
  static constexpr std::uint64_t kSuspectReach = 30;

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
  static constexpr double kWorkPerView = 50.0;      ///< node that is looked at whether it is needed,
  static constexpr double kWorkPerReduced = 250.0;  ///< and for the rest of a reduction, beside solving
  static constexpr double kWorkPerWatched = 0.005;  ///< node of the map
  static constexpr double kWorkPerCompared = 0.06;  ///< return
};

}  // namespace oort
