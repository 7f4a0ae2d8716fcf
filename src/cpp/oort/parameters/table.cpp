// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/parameters/table.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "oort/geometry/errors.hpp"
#include "oort/parameters/internal/declare.hpp"

namespace oort {
namespace {

constexpr double kMaxSearchedCells = 50.0;
constexpr std::size_t kMaxPathLength = 200;  // [bytes] of which a message tells

std::vector<DeclaredParameter> declare(Parameters& p) {
  std::vector<DeclaredParameter> rows;
  const Section root(rows);
  declare_general(root, p);
  declare_output_map(root.section("output_map"), p.output_map);
  declare_incremental(root.section("incremental_graph_builder"), p.incremental_graph_builder);
  declare_loop_closure(root.section("loop_closure_graph_builder"), p.loop_closure_graph_builder);
  declare_dock(root.section("dock_graph_builder"), p.dock_graph_builder);
  declare_localization(root.section("localization"), p.localization);
  return rows;
}

DeclaredParameter find(Parameters& parameters, const std::string& path) {
  std::vector<DeclaredParameter> rows = declare(parameters);
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.entry.path == path; });
  if (row == rows.end()) throw ParameterError(unknown_parameter(path));
  return std::move(*row);
}

/// The length of the longest common subsequence.
std::size_t common_letters(const std::string& a, const std::string& b) {
  std::vector<std::size_t> above(b.size() + 1, 0), row(b.size() + 1, 0);
  for (const char letter : a) {
    for (std::size_t k = 0; k < b.size(); ++k)
      row[k + 1] = letter == b[k] ? above[k] + 1 : std::max(above[k + 1], row[k]);
    std::swap(above, row);
  }
  return above.back();
}

/// How alike two paths are, in [0, 1]: the share of their letters that they have in common.
double similarity(const std::string& a, const std::string& b) {
  return 2.0 * static_cast<double>(common_letters(a, b)) / static_cast<double>(a.size() + b.size());
}

std::string last_key(const std::string& path) {
  return path.substr(path.rfind('.') + 1);  // all of it where there is no point
}

void require(bool holds, const std::string& section, const std::string& rule) {
  if (!holds) throw ParameterError(section + ": " + rule);
}

/// How a file has what a path names.
std::string nested(const std::string& path) {
  std::string text = "{\"", braces = "}";
  for (const char c : path) {
    if (c == '.') braces += '}';
    text += c == '.' ? "\": {\"" : std::string(1, c);
  }
  return text + "\": ..." + braces;
}

}  // namespace

Parameters::Parameters() {
  for (DeclaredParameter& row : declare(*this)) row.set(row.entry.default_value);
}

Parameters default_parameters() {
  return {};
}

std::vector<ParameterEntry> parameter_table() {
  Parameters parameters;
  std::vector<ParameterEntry> table;
  for (DeclaredParameter& row : declare(parameters)) table.push_back(std::move(row.entry));
  return table;
}

ParameterValue get_parameter(const Parameters& parameters, const std::string& path) {
  Parameters copy = parameters;  // the rows bind to fields that can be written
  return find(copy, path).get();
}

std::vector<std::pair<std::string, ParameterValue>> parameter_values(const Parameters& parameters) {
  Parameters copy = parameters;
  std::vector<std::pair<std::string, ParameterValue>> values;
  for (const DeclaredParameter& row : declare(copy)) values.emplace_back(row.entry.path, row.get());
  return values;
}

void set_parameter(Parameters& parameters, const std::string& path, const ParameterValue& value) {
  find(parameters, path).set(value);
}

void check_parameters(const Parameters& parameters) {
  const OutputMapParameters& map = parameters.output_map;
  require(map.threshold.max_free < map.threshold.min_occupied, "output_map.threshold",
          "max_free must be less than min_occupied");
  require(map.median.kernel_size % 2 == 1, "output_map.median", "kernel_size must be odd");
  const MatchFilteringParameters& filtering = parameters.incremental_graph_builder.frsm_matcher.match_filtering;
  require(filtering.x_min_accept < filtering.x_max_accept, "incremental_graph_builder.frsm_matcher.match_filtering",
          "x_min_accept must be less than x_max_accept");
  const FrsmMatcherParameters& frsm = parameters.incremental_graph_builder.frsm_matcher;
  require(frsm.max_point_range <= 5000.0 * frsm.meters_per_pixel, "incremental_graph_builder.frsm_matcher",
          "max_point_range must be at most 5000 times meters_per_pixel: larger tables do not fit in memory");
  require(frsm.initial_search_range_xy <= frsm.max_search_range_xy &&
              frsm.initial_search_range_theta <= frsm.max_search_range_theta,
          "incremental_graph_builder.frsm_matcher", "initial search ranges must not be more than the largest");
  const CartographerMatcherParameters& grid = parameters.incremental_graph_builder.cartographer_matcher;
  require(grid.linear_search_window <= kMaxSearchedCells * grid.resolution,
          "incremental_graph_builder.cartographer_matcher",
          "linear_search_window must be at most 50 times resolution: all poses of a larger one do not fit in memory");
  const CandidateSearchParameters& search = parameters.loop_closure_graph_builder.candidate_search;
  require(search.closest_allowed_id_threshold_small <= search.closest_allowed_id_threshold_large,
          "loop_closure_graph_builder.candidate_search",
          "closest_allowed_id_threshold_small must not be more than closest_allowed_id_threshold_large");
  const DockGraphBuilderParameters& dock = parameters.dock_graph_builder;
  require(dock.dock_match_submap_size < dock.dock_submap_size, "dock_graph_builder",
          "dock_match_submap_size must be less than dock_submap_size");
}

std::string unknown_parameter(const std::string& whole_path) {
  const std::string path = whole_path.substr(0, kMaxPathLength);
  std::set<std::string> known;
  for (const ParameterEntry& entry : parameter_table()) {
    known.insert(entry.path);
    for (std::size_t k = entry.path.find('.'); k != std::string::npos; k = entry.path.find('.', k + 1)) {
      known.insert(entry.path.substr(0, k));
    }
  }
  const std::string key = last_key(path);
  const auto likeness = [&](const std::string& other) {  // a key in a wrong section is nearer than any other
    return std::make_pair(last_key(other) == key, similarity(path, other));
  };
  const std::string& nearest = *std::max_element(
      known.begin(), known.end(), [&](const auto& a, const auto& b) { return likeness(a) < likeness(b); });
  if (nearest == path) return "\"" + path + "\" is written " + nested(path);
  return "unknown parameter \"" + path + "\"; the nearest known is \"" + nearest + "\"";
}

std::string type_name(const ParameterValue& value) {
  static constexpr const char* kNames[] = {"bool", "integer", "number", "string"};
  return kNames[value.index()];
}

}  // namespace oort
