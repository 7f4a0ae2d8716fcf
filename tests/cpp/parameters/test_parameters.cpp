// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "oort/geometry/errors.hpp"
#include "oort/parameters/internal/declare.hpp"
#include "oort/parameters/table.hpp"

namespace oort {
namespace {

constexpr const char* kIncrementalMatcher = "incremental_graph_builder.scanmatcher";

/// The message of the ParameterError that setting the value throws, or "".
std::string refusal(const std::string& path, const ParameterValue& value) {
  Parameters parameters;
  try {
    set_parameter(parameters, path, value);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "";
}

ParameterEntry entry_of(const std::string& path) {
  for (ParameterEntry& entry : parameter_table()) {
    if (entry.path == path) return entry;
  }
  throw std::logic_error("no entry " + path);
}

TEST(ParameterTable, EachPathOnce) {
  std::set<std::string> paths;
  for (const ParameterEntry& entry : parameter_table()) EXPECT_TRUE(paths.insert(entry.path).second) << entry.path;
  EXPECT_GT(paths.size(), 150u);
}

/// An allowed value that is not the default, where there is one.
ParameterValue other_value(const ParameterEntry& entry) {
  if (const auto* flag = std::get_if<bool>(&entry.default_value)) return !*flag;
  if (!entry.range) return entry.choices.empty() ? "other" : entry.choices.back();
  if (const auto* real = std::get_if<double>(&entry.default_value)) {
    return *real == entry.range->max ? entry.range->min : entry.range->max;
  }
  const auto max = static_cast<std::int64_t>(entry.range->max);
  return entry.default_value == ParameterValue(max) ? static_cast<std::int64_t>(entry.range->min) : max;
}

TEST(ParameterTable, EachPathHasAFieldOfItsOwn) {
  const auto before = parameter_values(default_parameters());
  for (const ParameterEntry& entry : parameter_table()) {
    const ParameterValue value = other_value(entry);
    Parameters parameters;
    set_parameter(parameters, entry.path, value);
    EXPECT_EQ(get_parameter(parameters, entry.path), value) << entry.path;
    const auto after = parameter_values(parameters);
    int changed = 0;
    for (std::size_t i = 0; i < before.size(); ++i) changed += before[i] != after[i];
    EXPECT_EQ(changed, value != entry.default_value) << entry.path;
  }
}

TEST(ParameterTable, DocumentedValuesAreAllowedAndOfTheSameType) {
  for (const ParameterEntry& entry : parameter_table()) {
    EXPECT_EQ(entry.documented_value.index(), entry.default_value.index()) << entry.path;
    EXPECT_EQ(refusal(entry.path, entry.documented_value), "");
  }
}

TEST(ParameterTable, EachDifferenceHasAReasonAndOnlyThose) {
  for (const ParameterEntry& entry : parameter_table()) {
    EXPECT_EQ(entry.default_value != entry.documented_value, !entry.reason.empty()) << entry.path;
    EXPECT_FALSE(entry.meaning.empty()) << entry.path;
  }
}

TEST(ParameterTable, StatusFollowsTheSection) {
  EXPECT_EQ(entry_of("incremental_graph_builder.frsm_matcher.debug_viewer.viewer_scale").status,
            ParameterStatus::kNoEffect);
  EXPECT_EQ(entry_of("loop_closure_graph_builder.branch_and_bound_matcher.debug").status, ParameterStatus::kNoEffect);
  EXPECT_EQ(entry_of("loop_closure_graph_builder.branch_and_bound_matcher.min_score").status, ParameterStatus::kUsed);
  EXPECT_EQ(entry_of("loop_closure_graph_builder.candidate_search.max_dist_allowed_threshold").status,
            ParameterStatus::kNoEffect);
  EXPECT_EQ(entry_of("linear_update").status, ParameterStatus::kUsed);
}

TEST(Parameters, StartAtTheDefaults) {
  const Parameters parameters;
  for (const ParameterEntry& entry : parameter_table()) {
    EXPECT_EQ(get_parameter(parameters, entry.path), entry.default_value) << entry.path;
  }
}

TEST(Parameters, DocumentedValuesReachTheirFields) {
  Parameters p;
  for (const ParameterEntry& entry : parameter_table()) set_parameter(p, entry.path, entry.documented_value);
  EXPECT_EQ(p.base_frame, "base_footprint");
  EXPECT_EQ(p.linear_update, 0.2);
  EXPECT_EQ(p.output_map.median.iter, 2);
  EXPECT_TRUE(p.output_map.probability_grid.clear_infs);
  EXPECT_EQ(p.incremental_graph_builder.frsm_matcher.meters_per_pixel, 0.01);
  EXPECT_EQ(p.incremental_graph_builder.frsm_matcher.match_filtering.x_min_accept, -0.05);
  EXPECT_EQ(p.incremental_graph_builder.cartographer_matcher.second_stage_matcher.ceres_scan_matcher.resolution, 0.01);
  EXPECT_EQ(p.loop_closure_graph_builder.frsm_matcher.match_filter.match_hitpct_threshold, 0.7);
  EXPECT_EQ(p.loop_closure_graph_builder.branch_and_bound_matcher.match_filter.match_hitpct_threshold, 0.0);
  EXPECT_EQ(p.dock_graph_builder.dock_submap_size, 31);
}

TEST(Parameters, SetWritesTheFieldAndGetReadsIt) {
  Parameters p;
  set_parameter(p, "incremental_graph_builder.frsm_matcher.debug_viewer.viewer_scale", std::int64_t{7});
  EXPECT_EQ(p.incremental_graph_builder.frsm_matcher.debug_viewer.viewer_scale, 7);
  set_parameter(p, "output_map.speckle_strategy", std::string("morphological"));
  EXPECT_EQ(p.output_map.speckle_strategy, "morphological");
  set_parameter(p, "switchable_constraint_scale", std::int64_t{3});  // an integer is a number
  EXPECT_EQ(std::get<double>(get_parameter(p, "switchable_constraint_scale")), 3.0);
}

TEST(Parameters, RefusesUnknownPaths) {
  EXPECT_NE(refusal("linear_updat", 0.2).find("\"linear_updat\""), std::string::npos);
  EXPECT_NE(refusal("output_map", 0.2), "");
  EXPECT_THROW(get_parameter(Parameters(), ""), ParameterError);
}

TEST(Parameters, RefusesWrongTypes) {
  EXPECT_EQ(refusal("min_pointcloud_size", 3.0),
            "min_pointcloud_size: 3 is of the wrong type (number); it takes an integer from 1 to 100000 points");
  EXPECT_NE(refusal("linear_update", true), "");
  EXPECT_NE(refusal("linear_update", std::string("0.2")), "");
  EXPECT_NE(refusal("output_map.probability_grid.clear_infs", std::int64_t{1}), "");
  EXPECT_NE(refusal("map_frame", std::int64_t{1}), "");
}

TEST(Parameters, RefusesValuesOutOfRange) {
  EXPECT_EQ(refusal("linear_update", 0.0), "linear_update: 0 is out of range; it takes a number from 0.001 to 100 m");
  EXPECT_NE(refusal("linear_update", std::numeric_limits<double>::quiet_NaN()), "");
  EXPECT_NE(refusal("linear_update", std::numeric_limits<double>::infinity()), "");
  EXPECT_NE(refusal("min_pointcloud_size", std::numeric_limits<std::int64_t>::max()), "");
  EXPECT_NE(refusal("output_map.probability_grid.hit_probability", 0.5), "");
  EXPECT_NE(refusal("map_frame", std::string()), "");
  EXPECT_NE(refusal("output_map.speckle_strategy", std::string("mean")), "");
}

TEST(Parameters, EveryDocumentedMatcherCanBeChosen) {
  EXPECT_EQ(refusal(kIncrementalMatcher, std::string("cartographer_matcher")), "");
  EXPECT_EQ(refusal("loop_closure_graph_builder.scanmatcher", std::string("branch_and_bound_matcher")), "");
  EXPECT_NE(refusal(kIncrementalMatcher, std::string("branch_and_bound_matcher")), "");
}

TEST(Parameters, ARefusalChangesNothing) {
  Parameters p;
  p.linear_update = 0.5;
  EXPECT_THROW(set_parameter(p, "linear_update", -1.0), ParameterError);
  EXPECT_EQ(p.linear_update, 0.5);
}

TEST(Parameters, ChecksValuesAgainstEachOther) {
  EXPECT_NO_THROW(check_parameters(default_parameters()));
  const std::pair<const char*, ParameterValue> bad[] = {
      {"output_map.threshold.max_free", std::int64_t{100}},
      {"output_map.median.kernel_size", std::int64_t{4}},
      {"incremental_graph_builder.frsm_matcher.match_filtering.x_min_accept", 100.0},
      {"loop_closure_graph_builder.candidate_search.closest_allowed_id_threshold_small", std::int64_t{1000000}},
      {"dock_graph_builder.dock_match_submap_size", std::int64_t{10000}}};
  for (const auto& [path, value] : bad) {
    Parameters p;
    set_parameter(p, path, value);
    EXPECT_THROW(check_parameters(p), ParameterError) << path;
  }
}

TEST(Declaration, OwnKeysSayWhichValueGivesTheDocumentedBehaviour) {
  std::vector<DeclaredParameter> rows;
  double field = 0.0;
  Section(rows).section("part")(field, "own_key", {0.5, "m", {0.0, 1.0}}, "For this test.").own(0.0, "Better.");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].entry.path, "part.own_key");
  EXPECT_TRUE(rows[0].entry.own);
  EXPECT_EQ(rows[0].entry.documented_value, ParameterValue(0.0));
  EXPECT_EQ(rows[0].entry.reason, "Better.");
  rows[0].set(std::int64_t{1});
  EXPECT_EQ(field, 1.0);
}

}  // namespace
}  // namespace oort
