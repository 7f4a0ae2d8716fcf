// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/loop_matcher.hpp"

#include "oort/loop_closure/frsm_loop_matcher.hpp"
#include "oort/loop_closure/grid_loop_matcher.hpp"

namespace oort {

std::unique_ptr<LoopMatcher> make_loop_matcher(const Parameters& parameters, const LoopScale& scale) {
  if (parameters.loop_closure_graph_builder.scanmatcher == "branch_and_bound_matcher") {
    return std::make_unique<GridLoopMatcher>(parameters, scale);
  }
  return std::make_unique<FrsmLoopMatcher>(parameters, scale);
}

}  // namespace oort
