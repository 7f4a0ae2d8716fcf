// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// loop_closure_graph_builder: where loops are looked for and which matches are believed.
#include "oort/parameters/internal/declare.hpp"

namespace oort {
namespace {

void declare_candidate_search(const Section& v, CandidateSearchParameters& p) {
  v(p.knearest_neighbors, "knearest_neighbors", {2, "nodes", {0, 1000}},
    "Nearest nodes tried as candidates: more cost more and close more loops.")
      .documented(
          5, "Costs half the time (Intel 14.6 s instead of 28.1 s) and is as accurate (0.0127 m instead of 0.0149 m).");
  v(p.submap_neighborhood_size, "submap_neighborhood_size", {15, "nodes", {1, 10000}},
    "Nodes along the candidate's trajectory that make its submap; nodes within half as many hops are no further "
    "candidates.");
  v(p.closest_allowed_id_threshold_large, "closest_allowed_id_threshold_large", {30, "nodes", {1, 1000000}},
    "Least difference of a candidate's id to the query's.");
  v(p.closest_allowed_id_threshold_small, "closest_allowed_id_threshold_small", {5, "nodes", {1, 1000000}},
    "The same, for a second search if the first finds no candidate.");
  v(p.max_dist_allowed_threshold, "max_dist_allowed_threshold", {4.0, "m", {0.0, 1000.0}}, "Documented as unused.")
      .no_effect();
  v(p.max_candidate_distance, "max_candidate_distance", {4.0, "m", {0.0, 1000.0}},
    "Nodes farther away are no candidates; 0: no limit.")
      .own(0.0,
           "Nodes far apart see little in common, and what they match is more often false: 20 made-up homes have a "
           "median "
           "error of 0.017 m instead of 0.020 m.");
  v(p.candidate_stride, "candidate_stride", {8, "nodes", {1, 1000}},
    "Every how many-th node of a segment may be a candidate: fewer submaps are drawn.")
      .own(1, "Half the time (Intel 14.6 s instead of 29.4 s) at the same error (0.0127 m, 0.0129 m).");
}

void declare_match_filter(const Section& v, MatchFilterParameters& p) {
  v(p.close_node_hitpct_threshold, "close_node_hitpct_threshold", {0.8, "fraction", {0.0, 1.0}},
    "Least inlier ratio of a close match: its ids differ by less than closest_allowed_id_threshold_large.");
  v(p.close_node_max_dist, "close_node_max_dist", {0.5, "m", {0.0, 1000.0}},
    "A close match must move the candidate, from where the graph expects it, by less than this.");
  v(p.match_max_ang_diff, "match_max_ang_diff", {2.09, "rad", {0.0, 3.15}},
    "A close match must turn the candidate by less than this.");
  v(p.match_hitpct_threshold, "match_hitpct_threshold", {0.7, "fraction", {0.0, 1.0}},
    "A match that moves the candidate by less than match_max_dist needs an inlier ratio above this.");
  v(p.match_max_dist, "match_max_dist", {0.5, "m", {0.0, 1000.0}}, "Goes with match_hitpct_threshold.");
  v(p.match_hitpct_threshold_high, "match_hitpct_threshold_high", {0.8, "fraction", {0.0, 1.0}},
    "A match that moves the candidate by less than match_max_dist_high needs an inlier ratio above this.");
  v(p.match_max_dist_high, "match_max_dist_high", {6.0, "m", {0.0, 1000.0}}, "Goes with match_hitpct_threshold_high.")
      .documented(2.0, "What moves the query by more than 0.5 m is confirmed by other matches instead.");
  v(p.opposite_dir_threshold, "opposite_dir_threshold", {1.74, "rad", {0.0, 3.15}},
    "From this difference in heading on, before the match, two nodes look in opposite ways.");
  v(p.match_hitpct_threshold_opposite_dir, "match_hitpct_threshold_opposite_dir", {0.67, "fraction", {0.0, 1.0}},
    "Takes the place of match_hitpct_threshold for them.");
  v(p.match_hitpct_threshold_high_opposite_dir, "match_hitpct_threshold_high_opposite_dir",
    {0.75, "fraction", {0.0, 1.0}}, "Takes the place of match_hitpct_threshold_high for them.");
}

}  // namespace

void declare_loop_closure(const Section& v, LoopClosureGraphBuilderParameters& p) {
  declare_candidate_search(v.section("candidate_search"), p.candidate_search);
  v(p.scanmatcher, "scanmatcher", {"frsm_matcher", {"frsm_matcher", "branch_and_bound_matcher"}},
    "The matcher that closes loops.");
  const Section frsm = v.section("frsm_matcher");
  frsm(p.frsm_matcher.submap_min_neighborhood_size, "submap_min_neighborhood_size", {3, "nodes", {1, 10000}},
       "Candidates with a smaller submap are rejected.");
  frsm(p.frsm_matcher.rough_match_hitpct_threshold, "rough_match_hitpct_threshold", {0.3, "fraction", {0.0, 1.0}},
       "Least inlier ratio of the rough match.");
  frsm(p.frsm_matcher.fine_match_hitpct_threshold, "fine_match_hitpct_threshold", {0.6, "fraction", {0.0, 1.0}},
       "Least inlier ratio of the fine match.");
  frsm(p.frsm_matcher.query_neighborhood_size, "query_neighborhood_size", {1, "nodes", {1, 100}},
       "Nodes around the query whose scans are matched together.")
      .own(1);
  frsm(p.frsm_matcher.search_window_xy, "search_window_xy", {5.0, "m", {0.01, 20.0}},
       "Widest half width of the search around where the graph expects the query.")
      .own(2.0, "Intel's first round drifts by 3.3 m with readings cut at 3 m.");
  frsm(p.frsm_matcher.search_window_theta, "search_window_theta", {0.5, "rad", {0.01, 3.15}},
       "Widest half width of the search in heading.")
      .own(0.52, "No trajectory turned by more.");
  frsm(p.frsm_matcher.search_window_sigmas, "search_window_sigmas", {4.0, "standard deviations", {0.0, 100.0}},
       "Half width of the search by how well the graph knows where the query is; search_window_xy and "
       "search_window_theta are the widest. 0: always the widest.")
      .own(0.0, "Long loops drift more than short ones.");
  frsm(
      p.frsm_matcher.min_facing_share, "min_facing_share", {0.6, "fraction", {0.0, 1.0}},
      "Least share of the surfaces on which a match rests that face the same way as before: a thin wall looks the same "
      "from both sides.")
      .own(0.0, "Matches through walls are off by the walls' thickness.");
  declare_match_filter(frsm.section("match_filter"), p.frsm_matcher.match_filter);
  declare_branch_and_bound_matcher(v.section("branch_and_bound_matcher"), p.branch_and_bound_matcher);
}

}  // namespace oort
