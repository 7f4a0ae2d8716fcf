// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/merging/merge.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/map/map_check.hpp"
#include "oort/mapper/mapper.hpp"
#include "oort/merging/internal/append_map.hpp"
#include "oort/merging/internal/cross_closures.hpp"
#include "oort/merging/tuning.hpp"

namespace oort {
namespace {

constexpr const char* kDock = "dock";  // the namespace of docks, and how a placement was found
constexpr const char* kGiven = "given";

// Of a given place that cannot be.
const char* const kCheckPlace =
    "check X Y THETA: where the second map's origin lies on the first, in metres and radians";

std::string what_to_do(bool is_given) {
  const std::string say = "say with --at X Y THETA about where the second one's origin lies on the first, or ";
  return "; if both show the same home, " + (is_given ? "" : say) +
         "drive on from the first map (oort replay --resume)";
}

void check(const Map& map, const std::string& name) {
  if (map.graph.nodes.empty()) throw InputError("merge: the " + name + " map is empty: there is nothing to merge");
  const std::optional<std::string> defect = find_defect(map);
  if (defect) throw InputError("merge: the " + name + " map cannot be used: " + *defect);
}

void check_distinct(const Map& a, const Map& b) {
  const std::uint64_t common = count_common_scans(a, b);
  if (common == 0) return;
  throw InputError("merge: " + std::to_string(common) + " of the second map's " + std::to_string(b.clouds.size()) +
                   " scans are in the first map, too: one is a copy of the other or was made from it, so the larger "
                   "one holds all there is");
}

Pose2 pose_of(const Map& map, const Location& location) {
  return map.graph.nodes[location.node_id].pose * location.T_node_location;
}

/// Where map b lies on map a if a dock of one is a dock of the other.
std::vector<MapPlacement> dock_guesses(const Map& a, const Map& b) {
  std::vector<MapPlacement> guesses;
  for (const Location& of_a : a.locations) {
    for (const Location& of_b : b.locations) {
      if (of_a.name_space != kDock || of_b.name_space != kDock || guesses.size() == MergingTuning::kMaxDockPairs) {
        continue;
      }
      MapPlacement guess;
      guess.T_a_b = pose_of(a, of_a) * inverse(pose_of(b, of_b));
      guess.found_by = kDock;
      guesses.push_back(guess);
    }
  }
  return guesses;
}

std::string evidence(const MapPlacement& p, const MapSearch& search) {
  return std::to_string(p.fits) + " of " + std::to_string(search.views) + " views fit, " +
         std::to_string(p.contradicts) + " contradict";
}

bool is_believed(const MapPlacement& p, const MapSearch& search) {
  return p.fits >= search.needed && p.fits > p.contradicts;
}

[[noreturn]] void reject(const MapSearch& search) {
  const bool given = !search.placements.empty() && search.placements.front().found_by == kGiven;
  const std::string best = search.placements.empty() ? "nothing fits" : evidence(search.placements.front(), search);
  if (given) {
    throw InputError("merge: the second map does not fit the first at the place that was given (" + best + "); " +
                     kCheckPlace);
  }
  if (search.views < search.needed) {
    throw InputError("merge: the smaller map shows too little to be searched for: " + std::to_string(search.views) +
                     " places apart, and " + std::to_string(search.needed) + " are needed" + what_to_do(false));
  }
  throw InputError("merge: no place where the second map fits the first was found (at the best place " + best + ")" +
                   what_to_do(false));
}

/// The best placement. One at the docks counts as much as a better one elsewhere, where both fit about as well.
MapPlacement chosen(const MapSearch& search) {
  if (search.placements.empty() || !is_believed(search.placements.front(), search)) reject(search);
  std::vector<MapPlacement> rivals;
  for (const MapPlacement& placement : search.placements) {
    if (placement.score() > MergingTuning::kAmbiguousShare * search.placements.front().score()) {
      rivals.push_back(placement);
    }
  }
  if (rivals.size() == 1) return rivals.front();
  const auto is_at_dock = [](const MapPlacement& placement) { return placement.found_by == kDock; };
  const auto at_dock = std::find_if(rivals.begin(), rivals.end(), is_at_dock);
  if (std::count_if(rivals.begin(), rivals.end(), is_at_dock) == 1 && is_believed(*at_dock, search) &&
      at_dock->score() >= MergingTuning::kDockShare * rivals.front().score()) {
    return *at_dock;
  }
  throw InputError("merge: the second map fits the first in more than one place: at the best " +
                   evidence(rivals[0], search) + ", at the next " + evidence(rivals[1], search) + what_to_do(false));
}

MapPlacement place(const Map& a, const Map& b, const Parameters& parameters, const std::optional<Pose2>& T_a_b,
                   int& views) {
  std::vector<MapPlacement> guesses = dock_guesses(a, b);
  if (T_a_b) {
    MapPlacement given;
    given.T_a_b = *T_a_b;
    given.found_by = kGiven;
    guesses = {given};
  }
  const MapSearch search = find_placements(a, b, parameters, guesses, T_a_b.has_value());
  views = search.views;
  return chosen(search);
}

std::uint64_t count_kept(const Graph& graph, std::uint64_t begin) {
  return static_cast<std::uint64_t>(
      std::count_if(graph.switchable_edges.begin(), graph.switchable_edges.end(), [&](const SwitchableEdge& edge) {
        return edge.is_on() && std::min(edge.i, edge.j) < begin && std::max(edge.i, edge.j) >= begin;
      }));
}

/// A map with other poses: those of the nodes from `first` on.
Map solved(Map map, const Map& joined, std::uint64_t first) {
  for (Node& node : map.graph.nodes) node.pose = joined.graph.nodes[first + node.id].pose;
  return map;
}

/// Throws InputError if closures, or views of the solved maps, speak against the merged map.
void confirm(const Map& a, const Map& b, const Merged& merged, const Parameters& parameters) {
  const std::string advice = what_to_do(merged.placement.found_by == kGiven);
  const std::string what = "merge: where the second map was found on the first is not confirmed: ";
  if (merged.across_kept < MergingTuning::kMinKept ||
      static_cast<double>(merged.across_kept) <
          MergingTuning::kMinKeptShare * static_cast<double>(merged.across.accepted)) {
    throw InputError(what + "of " + std::to_string(merged.across.accepted) + " closures the solution keeps " +
                     std::to_string(merged.across_kept) + advice);
  }
  const MapSearch search = find_placements(solved(a, merged.map, 0), solved(b, merged.map, merged.first_node_b),
                                           parameters, {MapPlacement{}}, true);
  const MapPlacement& p = search.placements.front();
  if (p.fits < search.needed || p.fits < MergingTuning::kFitsPerContradiction * p.contradicts) {
    throw InputError(what + "once both are solved together " + evidence(p, search) + advice);
  }
}

/// Leaves out the second map's places that the first has already.
std::vector<DroppedLocation> drop_doubles(Map& map, std::uint64_t first_node_b) {
  const auto is_of_a = [&](const Location& location) { return location.node_id < first_node_b; };
  std::vector<Location> kept;
  std::copy_if(map.locations.begin(), map.locations.end(), std::back_inserter(kept), is_of_a);
  const std::vector<Location> of_a = kept;
  std::vector<DroppedLocation> dropped;
  for (const Location& location : map.locations) {
    if (is_of_a(location)) continue;
    const auto distance = [&](const Location& other) {
      return (pose_of(map, other).translation() - pose_of(map, location).translation()).norm();
    };
    const auto same = std::find_if(of_a.begin(), of_a.end(), [&](const Location& other) {
      if (other.name_space != location.name_space) return false;
      return other.id == location.id || (location.name_space == kDock && distance(other) <= MergingTuning::kSameDock);
    });
    if (same == of_a.end()) {
      kept.push_back(location);
    } else {
      dropped.push_back({location.name_space, location.id, distance(*same)});
    }
  }
  map.locations = std::move(kept);
  return dropped;
}

}  // namespace

Merged merge_maps(const Map& a, const Map& b, const Parameters& parameters, const std::optional<Pose2>& T_a_b) {
  check(a, "first");
  check(b, "second");
  if (T_a_b) check_reach(*T_a_b, "merge: the given place of the second map", kCheckPlace);
  check_distinct(a, b);
  Merged merged;
  merged.placement = place(a, b, parameters, T_a_b, merged.views);
  Map joined = a;
  merged.first_node_b = append_map(b, merged.placement.T_a_b, joined);
  const Joint joint{merged.placement.node_a, merged.first_node_b + merged.placement.node_b};
  merged.across = close_across(joined, merged.first_node_b, joint, parameters);
  Mapper mapper(parameters);
  mapper.set_map(joined);
  mapper.finish();
  merged.map = mapper.map();
  merged.across_kept = count_kept(merged.map.graph, merged.first_node_b);
  confirm(a, b, merged, parameters);
  merged.dropped = drop_doubles(merged.map, merged.first_node_b);
  return merged;
}

}  // namespace oort
