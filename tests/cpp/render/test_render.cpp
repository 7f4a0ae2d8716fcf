// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "oort/geometry/errors.hpp"
#include "oort/render/render.hpp"
#include "oort/render/speckle.hpp"

namespace oort {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr int kFree = OccupancyGrid::kFree;
constexpr int kOccupied = OccupancyGrid::kOccupied;
constexpr int kUnknown = OccupancyGrid::kUnknown;

/// The documented values, whatever the defaults are.
OutputMapParameters documented() {
  OutputMapParameters parameters = Parameters().output_map;
  parameters.probability_grid.resolution = 0.05;
  parameters.probability_grid.insert_free_space = true;
  parameters.probability_grid.hit_probability = 0.55;
  parameters.probability_grid.miss_probability = 0.49;
  parameters.probability_grid.clear_infs = true;
  parameters.probability_grid.inf_clear_dist = 0.5;
  parameters.threshold = {48, 55};
  parameters.robot_radius = 0.15;
  parameters.speckle_strategy = "median";
  parameters.morphological = {1, 1};
  parameters.median = {3, 2};
  return parameters;
}

/// The cell at a point of the map frame [m].
int cell_at(const OccupancyGrid& map, double x, double y) {
  const int column = static_cast<int>(std::floor((x - map.origin_x) / map.resolution));
  const int row = static_cast<int>(std::floor((y - map.origin_y) / map.resolution));
  return map.cells.at(static_cast<std::size_t>(row * map.width + column));
}

long count(const OccupancyGrid& map, int state) {
  return std::count(map.cells.begin(), map.cells.end(), state);
}

/// The same cloud seen `times` times from the origin, each by its own node.
RenderedMap render_repeated(const std::vector<Point2>& points, int times, const OutputMapParameters& parameters) {
  std::vector<Node> nodes;
  std::vector<PointCloud> clouds;
  for (int k = 0; k < times; ++k) {
    nodes.push_back({static_cast<std::uint64_t>(k), {}});
    clouds.push_back({static_cast<std::uint64_t>(k), 0.0, points});
  }
  return render(nodes, clouds, parameters);
}

TEST(Render, AnEmptyMapGivesEmptyGrids) {
  const RenderedMap rendered = render({}, {}, documented());
  EXPECT_EQ(rendered.map.width * rendered.map.height, 0);
  EXPECT_TRUE(rendered.map.cells.empty());
  EXPECT_TRUE(rendered.map_cleaned.cells.empty());
}

TEST(Render, ANodeThatSawNothingIsAFootprint) {
  const RenderedMap rendered = render({{0, {1.0, 2.0, 0.5}}}, PointClouds({{0, 0.0, {}}}), documented());
  EXPECT_GT(count(rendered.map, kFree), 20);
  EXPECT_EQ(count(rendered.map, kOccupied), 0);
}

TEST(Render, OneHitIsOccupiedAndTwoMissesAreFree) {
  const std::vector<Point2> wall = {{2.0, 0.0, 1.0}, {0.0, 1.0, 1.0}, {0.0, -1.0, 1.0}};
  const OccupancyGrid once = render_repeated(wall, 1, documented()).map;
  EXPECT_EQ(cell_at(once, 2.0 - 0.01, 0.0), kOccupied);
  EXPECT_EQ(cell_at(once, 1.0, 0.0), kUnknown) << "one miss is 49 percent";
  const OccupancyGrid twice = render_repeated(wall, 2, documented()).map;
  EXPECT_EQ(cell_at(twice, 2.0 - 0.01, 0.0), kOccupied);
  EXPECT_EQ(cell_at(twice, 1.0, 0.0), kFree) << "two misses are 48 percent";
}

TEST(Render, AHitAndAMissLeaveACellUnknown) {
  std::vector<Node> nodes = {{0, {}}, {1, {}}};
  const std::vector<PointCloud> clouds = {{0, 0.0, {{1.0, 0.0, 1.0}}}, {1, 0.0, {{2.0, 0.0, 1.0}}}};
  EXPECT_EQ(cell_at(render(nodes, clouds, documented()).map, 0.99, 0.0), kUnknown);
}

TEST(Render, TheGridEndsAtTheFarthestHits) {
  const std::vector<Point2> points = {{2.03, 0.0, 1.0}, {-1.0, 1.49, 1.0}, {0.0, -1.0, 1.0}};
  const OccupancyGrid map = render_repeated(points, 1, documented()).map;
  EXPECT_NEAR(map.origin_x + map.width * map.resolution, 2.03, 1e-12);
  EXPECT_NEAR(map.origin_y + map.height * map.resolution, 1.49, 1e-12);
  EXPECT_EQ(map.width, 61);   // 3.03 m
  EXPECT_EQ(map.height, 50);  // 2.49 m
}

TEST(Render, ANodeOutsideTheHitsIsInside) {
  const OccupancyGrid map = render_repeated({{2.0, 0.0, 1.0}, {2.0, 0.5, 1.0}}, 1, documented()).map;
  EXPECT_EQ(cell_at(map, 0.0, 0.0), kFree);
}

TEST(Render, ClearsADiscAroundEachNode) {
  // The grid begins at (-1, -1). The node is 20.6 cells from there in x, which rounds to 21; the disc reaches 3
  // further.
  const std::vector<Point2> corners = {{-1.03, -1.0, 1.0}, {0.97, 1.0, 1.0}};
  OutputMapParameters parameters = documented();
  parameters.probability_grid.insert_free_space = false;
  const Node node{0, {0.03, 0.0, 0.0}};
  const OccupancyGrid map = render({node}, PointClouds({{0, 0.0, corners}}), parameters).map;
  EXPECT_EQ(count(map, kFree), 29);  // the lattice points with dx^2 + dy^2 <= 9
  EXPECT_EQ(cell_at(map, 0.225, 0.025), kFree);
  EXPECT_EQ(cell_at(map, -0.125, 0.025), kUnknown);
  parameters.robot_radius = 0.0;
  EXPECT_EQ(count(render({node}, PointClouds({{0, 0.0, corners}}), parameters).map, kFree), 1);
}

TEST(Render, TheDiscMayBeAroundTheBase) {
  const std::vector<Point2> corners = {{-1.0, -1.0, 1.0}, {1.0, 1.0, 1.0}};
  OutputMapParameters parameters = documented();
  parameters.probability_grid.insert_free_space = false;
  parameters.footprint_x = -0.5;  // the sensor is at the robot's front, and the robot looks along y
  const OccupancyGrid map = render({{0, {0.0, 0.0, M_PI / 2.0}}}, PointClouds({{0, 0.0, corners}}), parameters).map;
  EXPECT_EQ(count(map, kFree), 29);
  EXPECT_EQ(cell_at(map, 0.01, -0.49), kFree);
  EXPECT_EQ(cell_at(map, 0.01, 0.01), kUnknown);
}

TEST(Render, IsTheSameEachTime) {
  std::vector<Node> nodes;
  std::vector<PointCloud> clouds;
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  for (std::uint64_t k = 0; k < 30; ++k) {
    nodes.push_back({k, {uniform(engine), uniform(engine), uniform(engine)}});
    clouds.push_back({k, 0.0, {}});
    for (int i = 0; i < 60; ++i) clouds.back().points.push_back({uniform(engine), uniform(engine), 1.0});
  }
  const RenderedMap first = render(nodes, clouds, documented());
  const RenderedMap second = render(nodes, clouds, documented());
  EXPECT_EQ(first.map.cells, second.map.cells);
  EXPECT_EQ(first.map_cleaned.cells, second.map_cleaned.cells);
}

/// The message of the InputError that rendering ends with.
std::string input_error(const std::vector<Node>& nodes, const std::vector<PointCloud>& clouds) {
  try {
    render(nodes, clouds, documented());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Render, NamesTheNodeThatLiesTooFarOff) {
  std::vector<Node> nodes;
  std::vector<PointCloud> clouds;
  for (std::uint64_t k = 0; k < 5; ++k) {
    nodes.push_back({k, {static_cast<double>(k), 0.0, 0.0}});
    clouds.push_back({k, 0.0, {{1.0, 0.0, 1.0}}});
  }
  auto far_nodes = nodes;
  far_nodes[0].pose.x = 1e9;
  EXPECT_NE(input_error(far_nodes, clouds).find("node 0"), std::string::npos) << input_error(far_nodes, clouds);
  auto far_clouds = clouds;
  far_clouds[3].points[0].y = -1e9;
  EXPECT_NE(input_error(nodes, far_clouds).find("node 3"), std::string::npos) << input_error(nodes, far_clouds);
  auto broken = nodes;
  broken[2].pose.theta = kNan;
  EXPECT_NE(input_error(broken, clouds).find("node 2"), std::string::npos) << input_error(broken, clouds);
  clouds.pop_back();
  EXPECT_NE(input_error(nodes, clouds).find("5 nodes but 4 clouds"), std::string::npos);
}

TEST(Render, IgnoresReturnsThatAreNotFinite) {
  const OccupancyGrid map = render_repeated({{kNan, 0.0, 1.0}, {1.0, kInf, 1.0}, {1.0, 0.0, 1.0}}, 2, documented()).map;
  EXPECT_EQ(count(map, kOccupied), 1);
}

TEST(Render, RefusesParametersThatMakeNoSense) {
  const auto refuses = [](auto&& change) {
    OutputMapParameters parameters = documented();
    change(parameters);
    EXPECT_THROW(render({{0, {}}}, PointClouds({{0, 0.0, {}}}), parameters), ParameterError);
  };
  refuses([](auto& p) { p.probability_grid.resolution = 0.0; });
  refuses([](auto& p) { p.probability_grid.hit_probability = 1.5; });
  refuses([](auto& p) { p.probability_grid.inf_clear_dist = kInf; });
  refuses([](auto& p) { p.robot_radius = kNan; });
  refuses([](auto& p) { p.median.kernel_size = 4; });
  refuses([](auto& p) { p.median.iter = -1; });
  refuses([](auto& p) { p.speckle_strategy = "blur"; });
}

/// A map from a picture: '.' free, '#' occupied, ' ' unknown; the first line is row 0.
OccupancyGrid picture(const std::vector<std::string>& rows) {
  OccupancyGrid map{0.05, 0.0, 0.0, static_cast<int>(rows.at(0).size()), static_cast<int>(rows.size()), {}};
  for (const std::string& row : rows) {
    for (const char c : row) {
      map.cells.push_back(c == '.'   ? OccupancyGrid::kFree
                          : c == '#' ? OccupancyGrid::kOccupied
                                     : OccupancyGrid::kUnknown);
    }
  }
  return map;
}

std::vector<std::string> rows_of(const OccupancyGrid& map) {
  std::vector<std::string> rows(static_cast<std::size_t>(map.height));
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    const int cell = map.cells[i];
    rows[i / static_cast<std::size_t>(map.width)] += cell == kFree ? '.' : cell == kOccupied ? '#' : ' ';
  }
  return rows;
}

// clang-format off
const std::vector<std::string> kRoom = {
    "          ",
    "          ",
    "##########",
    "..........",
    "..........",
    "..........",
    "...... ...",
    "..#...  ..",
    "..........",
    "..........",
    "..........",
    "#########.",
    "..........",
    "..........",
};
// clang-format on

TEST(Speckle, MedianKeepsThinWallsAndRemovesStrayCells) {
  std::vector<std::string> expected = kRoom;
  expected[6] = expected[7] = "..........";  // the stray cell and the hole go, nothing else changes
  EXPECT_EQ(rows_of(remove_speckles(picture(kRoom), documented())), expected);
}

TEST(Speckle, MedianOfOneCellOrNoPassChangesNothing) {
  OutputMapParameters parameters = documented();
  parameters.median = {1, 2};
  EXPECT_EQ(rows_of(remove_speckles(picture(kRoom), parameters)), kRoom);
  parameters.median = {3, 0};
  EXPECT_EQ(rows_of(remove_speckles(picture(kRoom), parameters)), kRoom);
}

TEST(Speckle, MorphologicalFillsHolesAndKeepsEveryOccupiedCell) {
  OutputMapParameters parameters = documented();
  parameters.speckle_strategy = "morphological";
  std::vector<std::string> expected = kRoom;
  expected[6] = "..........";
  expected[7] = "..#.......";
  EXPECT_EQ(rows_of(remove_speckles(picture(kRoom), parameters)), expected);
}

TEST(Speckle, MorphologicalClosesGapsInWalls) {
  OutputMapParameters parameters = documented();
  parameters.speckle_strategy = "morphological";
  const OccupancyGrid gap = picture({"........", "........", "###.####", "........", "........"});
  EXPECT_EQ(rows_of(remove_speckles(gap, parameters))[2], "########");
  parameters.morphological = {0, 0};
  EXPECT_EQ(rows_of(remove_speckles(picture(kRoom), parameters)), kRoom);
}

TEST(Speckle, TheMapIsCleanedTooWhereThatIsWanted) {
  OutputMapParameters parameters = documented();
  const std::vector<Point2> stray = {{2.0, 0.0, 1.0}, {1.0, 1.0, 1.0}, {0.0, -1.5, 1.0}};
  const RenderedMap plain = render_repeated(stray, 1, parameters);
  parameters.clean_map = true;
  const RenderedMap cleaned = render_repeated(stray, 1, parameters);
  EXPECT_NE(plain.map.cells, plain.map_cleaned.cells);
  EXPECT_EQ(cleaned.map.cells, plain.map_cleaned.cells);
}

TEST(Speckle, TheRobotsWayStaysFreeInTheCleanedMap) {
  // One node between hits all around it: filtering would close some of its disc.
  std::vector<Point2> ring;
  for (int i = 0; i < 360; ++i) ring.push_back({0.12 * std::cos(i * M_PI / 180), 0.12 * std::sin(i * M_PI / 180), 1.0});
  OutputMapParameters parameters = documented();
  parameters.speckle_strategy = "morphological";
  parameters.morphological = {0, 4};
  const RenderedMap rendered = render_repeated(ring, 1, parameters);
  for (std::size_t i = 0; i < rendered.map.cells.size(); ++i) {
    if (rendered.map.cells[i] != kFree) continue;
    ASSERT_EQ(rendered.map_cleaned.cells[i], kFree);
  }
}

}  // namespace
}  // namespace oort
