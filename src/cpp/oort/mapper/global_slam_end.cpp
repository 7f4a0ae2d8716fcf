// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// What global SLAM does when mapping ends.
#include <cstdint>
#include <vector>

#include "oort/maintenance/outdated.hpp"
#include "oort/maintenance/refinement.hpp"
#include "oort/mapper/global_slam.hpp"
#include "oort/mapper/tuning.hpp"

namespace oort {

Correction GlobalSlam::finish() {
  Correction all = link_docks();
  work_off(all);
  former_gave_way_ = false;  // all that there is to say was said
  if (schedule_.pending() > 0 || !map().graph.switchable_edges.empty()) solve_anew(MapperTuning::kFinalIterations);
  close_far_loops(all);
  tie_loose_parts(all);
  if (parameters_.final_refinement) counts_.refinement = refine(map_.edit(), held());
  all.solution = map_.solution();
  all.counts = counts_;
  if (parameters_.keep_views > 0 && remove_outdated(map_.edit(), map_.segments(), session_begin_) > 0) {
    all.clouds = map().clouds;
    forget_submaps();
  }
  return all;
}

void GlobalSlam::work_off(Correction& all) {
  while (!to_look_from_.empty() || loops_.has_work()) {
    while (!to_look_from_.empty()) loops_.look(map(), map_.segments(), to_look_from_.take().node, nullptr);
    const WorkClock clock(work_seconds_.matching);
    const Correction some = found(trusted(loops_.work_off(map(), map_.segments(), counts_.loops, closure_log_)));
    all.closures.insert(all.closures.end(), some.closures.begin(), some.closures.end());
  }
}

void GlobalSlam::close_far_loops(Correction& all) {
  if (segment_search_.is_lost()) return;
  const Correction some = closed(drift_search_.look_at_end(map(), map_.segments(), session_begin_), nullptr);
  if (some.closures.empty()) return;
  all.closures.insert(all.closures.end(), some.closures.begin(), some.closures.end());
  work_off(all);
  solve_anew(MapperTuning::kFinalIterations);
}

/// Once more with everything, as long as what is found helps to find more.
void GlobalSlam::tie_loose_parts(Correction& all) {
  WorkBudget budget(MapperTuning::kFinalSearch);
  for (int round = 0; round < MapperTuning::kMaxRounds; ++round) {
    std::vector<SegmentFinding> findings;
    {
      const WorkClock clock(work_seconds_.matching);
      findings = segment_search_.look_for_all(map(), map_.segments(), budget);
    }
    bool tied = false;
    for (const SegmentFinding& finding : findings) {
      if (parameters_.frozen_map && finding.nodes.front().begin < session_begin_) continue;
      const Correction some = placed(finding);
      all.segments.insert(all.segments.end(), some.segments.begin(), some.segments.end());
      all.closures.insert(all.closures.end(), some.closures.begin(), some.closures.end());
      tied = tied || !some.closures.empty();
    }
    if (!tied) return;
    solve_anew(MapperTuning::kFinalIterations);
    work_off(all);
    solve_anew(MapperTuning::kFinalIterations);
  }
}

}  // namespace oort
