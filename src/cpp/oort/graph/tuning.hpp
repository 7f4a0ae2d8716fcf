// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "oort/geometry/chi_square.hpp"

namespace oort {

/// Constants of the optimiser that were chosen, not derived (docs/optimiser.md).
struct GraphTuning {
  /// Squared error up to which an edge agrees with the poses.
  static constexpr double kAgreement = ChiSquare3::k95;
  /// An edge that was on and now has a larger squared error says that the solution may be another one altogether.
  static constexpr double kLargeInnovation = ChiSquare3::k999;

  // Levenberg-Marquardt damping, relative to the diagonal. Graphs start near their optimum, where Gauss-Newton steps
  // are right, so it starts weak. It holds each node where it is; what holds a long loop together is far softer than
  // any of its edges: at 1e-6 a loop of 2,000 nodes that ended 8 m off did not close (Killian court).
  static constexpr double kInitialDamping = 1e-12;
  static constexpr double kMinDamping = 1e-14;  ///< above rounding, for parts that no edge holds
  static constexpr double kMaxDamping = 1e6;
  static constexpr double kDampingGrowth = 10.0;  ///< factor after a step that does not lower the cost
  static constexpr double kDampingDecay = 0.3;    ///< factor after one that does
  static constexpr double kMinDiagonal = 1e-6;    ///< of a variable that no edge holds

  // Solving ends with a step that lowers the cost by less: it moves nothing by as much as a thousandth of its standard
  // deviation, or, while the solution is searched for, a fifth.
  static constexpr double kTolerance = 1e-6;
  static constexpr double kSearchTolerance = 1e-2;
  /// A large graph is solved when the gain is small beside its cost, too.
  static constexpr double kRelativeTolerance = 1e-7;

  /// While the solution is searched for, an edge whose best switch is below this is left out: it hardly pulls, and
  /// false edges, which join distant nodes, make each step expensive.
  static constexpr double kOffWhileSearching = 0.01;

  // Steps before edges that are off are left out; then rounds of looking anew which those are, and steps in between.
  static constexpr int kFirstSteps = 2;
  static constexpr int kSearchRounds = 3;
  static constexpr int kSearchSteps = 3;

  /// Blocks in the factor from which on a step is so expensive that one start must do.
  static constexpr std::size_t kExpensiveBlocks = 100'000;

  /// Edges that surprised and are off at the best solution, the newest ones, that are tried as if they were certain.
  static constexpr std::size_t kBelieved = 3;
  static constexpr int kBelievedSteps = 20;  ///< of each of them, beside the others: far bends take more

  /// From this round of deciding on, edges are only left out, so that deciding ends.
  static constexpr int kRoundsBothWays = 10;

  /// Cost of the edges that are always believed below which the poses follow from those edges alone.
  static constexpr double kNoCost = 1e-3;

  // A covariance of a loaded map outside of these is damaged: numbers of the solver would over- or underflow.
  static constexpr double kMaxVariance = 1e12;  ///< [m^2, rad^2]
  static constexpr double kMaxWeight = 1e12;    ///< [1/m, 1/rad] entry of the whitening matrix

  /// [m] Lever at which an error of heading counts like one of position, where the least uncertain path is looked for.
  static constexpr double kHeadingLever = 1.0;

  // Work units (geometry/work_meter.hpp), measured on graphs of 1,000 to 12,000 nodes.
  static constexpr double kWorkPerPattern = 0.4;    ///< per edge and variable: ordering and symbolic factorisation
  static constexpr double kWorkPerEdge = 0.3;       ///< linearisation and cost
  static constexpr double kWorkPerBlock = 0.02;     ///< of the factor: both substitutions
  static constexpr double kWorkPerProduct = 0.01;   ///< of two blocks: numeric factorisation
  static constexpr double kWorkPerHuberEdge = 3.0;  ///< and iteration of Ceres
};

}  // namespace oort
