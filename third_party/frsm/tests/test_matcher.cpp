// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include "frsm/matcher.hpp"
#include "scene.hpp"

namespace frsm {
namespace {

using test::kPi;
using test::Sensor;
using test::turn;

// A map of one scan.
Table draw(const Points& body, const Pose& pose) {
  Table table;
  table.draw(transform(pose, body), extract_contours(body, {}), pose);
  return table;
}

void expect_sound(const Match& match) {
  EXPECT_TRUE(is_finite(match.pose));
  EXPECT_EQ(Eigen::LLT<Eigen::Matrix3d>(match.covariance).info(), Eigen::Success);
  EXPECT_TRUE(match.information.allFinite());
}

TEST(Matcher, IdenticalScanComesBackInPlace) {
  std::mt19937 random(1);
  for (const double heading : {0.0, 0.3, 1.1, -2.5}) {
    const Pose pose{0.213, 0.307, heading};
    const Points body = test::scan(test::room(), pose, {181, kPi, 8.0, 0.01}, random);
    const Match match = Matcher().match(draw(body, pose), body, pose, {0.1, 0.1, 0.1}, nullptr);
    EXPECT_EQ(match.status, Status::kOk);
    EXPECT_LT(distance(match.pose, pose), 1e-3);
    EXPECT_LT(turn(match.pose, pose), 5e-4);
    EXPECT_EQ(match.hits, match.points);
    EXPECT_GE(match.score, 0.88);  // below 1, as points lie up to half a cell's diagonal from a centre
    expect_sound(match);
  }
}

TEST(Matcher, PointsFartherThanTheTableDrawsAreNoMisses) {
  std::mt19937 random(4);
  test::Scene scene = test::room();
  scene.push_back({{-60.0, 40.0}, {60.0, 40.0}});
  scene.erase(scene.begin() + 2);  // the room's far wall: the one outdoors is seen through the gap
  const Points body = test::scan(scene, {}, {361, 2.0 * kPi, 80.0, 0.0}, random);
  const Match match = Matcher().match(draw(body, {}), body, {}, {0.1, 0.1, 0.1}, nullptr);
  EXPECT_LT(match.points, static_cast<int>(body.size()));
  EXPECT_EQ(match.hits, match.points);
}

TEST(Matcher, FindsKnownOffsetsInATurnedRoom) {
  std::mt19937 random(2);
  std::vector<double> distances, turns;
  const test::Scene scene = test::room(0.35);
  const Sensor sensor{181, kPi, 8.0, 0.01};
  const Pose guess{0.1, 0.4, 0.2};
  for (int i = 0; i < 125; ++i) {
    Table table;  // of five scans, so that the error is the match's rather than the map's
    for (int k = 0; k < 5; ++k) {
      const Points drawn = test::scan(scene, guess, sensor, random);
      table.draw(transform(guess, drawn), extract_contours(drawn, {}), guess);
    }
    const Pose truth{guess.x + 0.04 * (i % 5 - 2), guess.y + 0.04 * (i / 5 % 5 - 2), guess.theta + 0.04 * (i / 25 - 2)};
    const Points body = test::scan(scene, truth, sensor, random);
    const Match match = Matcher().match(table, body, guess, {0.1, 0.1, 0.1}, nullptr);
    EXPECT_EQ(match.status, Status::kOk);
    distances.push_back(distance(match.pose, truth));
    turns.push_back(turn(match.pose, truth));
  }
  std::sort(distances.begin(), distances.end());
  std::sort(turns.begin(), turns.end());
  EXPECT_LT(distances[62], 2e-3);
  EXPECT_LT(turns[62], 1e-3);
  EXPECT_LT(distances[123], 1e-2);
}

// A narrow view from outside the drawn area.
TEST(Matcher, RobotOutsideTheDrawnAreaStaysWhereItIs) {
  std::mt19937 random(3);
  const test::Scene scene = {{{3.0, -2.0}, {3.0, 0.8}}, {{3.0, 0.8}, {3.6, 0.8}}, {{3.6, 0.8}, {3.6, 3.0}}};
  const Points body = test::scan(scene, {}, {61, kPi / 3.0, 8.0, 0.0}, random);
  const Match match = Matcher().match(draw(body, {}), body, {}, {0.1, 0.1, 0.1}, nullptr);
  EXPECT_TRUE(match.usable());
  EXPECT_LT(distance(match.pose, {}), 2e-3);
  EXPECT_LT(turn(match.pose, {}), 1e-3);
}

TEST(Matcher, WideWindowFindsTheRobotAnywhereInTheRoom) {
  std::mt19937 random(4);
  const test::Scene scene = test::room(0.2);
  const Sensor sensor{271, 1.5 * kPi, 8.0, 0.01};
  Table table;
  for (const Pose& pose : {Pose{0.0, 0.5, 0.0}, Pose{1.0, 0.5, 2.0}, Pose{-1.5, 0.5, -2.0}, Pose{0.5, -1.0, 0.7}}) {
    const Points body = test::scan(scene, pose, sensor, random);
    table.draw(transform(pose, body), extract_contours(body, {}), pose);
  }
  MatcherParams params;
  params.ambiguity_floor = 0.5;
  for (const Pose& truth : {Pose{0.7, 0.9, 1.0}, Pose{-1.0, 0.7, 3.0}, Pose{1.1, -0.9, -1.2}}) {
    const Points body = test::scan(scene, truth, sensor, random);
    const Match match = Matcher(params).match(table, body, {0.0, 0.0, 0.0}, {2.0, 2.0, kPi}, nullptr);
    EXPECT_TRUE(match.usable()) << to_string(match.status);
    EXPECT_LT(distance(match.pose, truth), 0.01);
    EXPECT_LT(turn(match.pose, truth), 5e-3);
    EXPECT_LT(match.ambiguity, 0.9);
  }
}

TEST(Matcher, SymmetricRoomIsAmbiguous) {
  test::Scene scene;
  test::add_box(&scene, {}, 4.0, 4.0);
  std::mt19937 random(5);
  const Points body = test::scan(scene, {}, {361, 2.0 * kPi, 8.0, 0.0}, random);
  MatcherParams params;
  params.ambiguity_floor = 0.7;
  const Table table = draw(body, {});
  EXPECT_GT(Matcher(params).match(table, body, {}, {0.4, 0.4, kPi}, nullptr).ambiguity, 0.95);
  EXPECT_EQ(Matcher(params).match(table, body, {}, {0.1, 0.1, 0.1}, nullptr).ambiguity, 0.0);
  EXPECT_EQ(Matcher().match(table, body, {}, {0.4, 0.4, kPi}, nullptr).ambiguity, 0.0);
}

TEST(Matcher, PosesBelowTheLeastScoreAreNotFound) {
  std::mt19937 random(7);
  const Pose pose{0.3, 0.5, 0.1};
  const Points body = test::scan(test::room(0.2), pose, {271, 1.5 * kPi, 8.0, 0.01}, random);
  const Table table = draw(body, pose);
  for (const double width : {0.05, 2.0}) {  // all poses are tried, or branch and bound
    MatcherParams params;
    const Match best = Matcher(params).match(table, body, pose, {width, width, 0.1}, nullptr);
    params.min_score = 0.95 * best.score;
    const Match same = Matcher(params).match(table, body, pose, {width, width, 0.1}, nullptr);
    EXPECT_EQ(same.pose.x, best.pose.x);
    EXPECT_EQ(same.status, best.status);
    params.min_score = 1.0;
    const Match none = Matcher(params).match(table, body, {0.29, 0.5, 0.1}, {width, width, 0.1}, nullptr);
    EXPECT_EQ(none.status, Status::kLowHits);
    EXPECT_EQ(none.hits, 0);
    EXPECT_EQ(none.pose.x, 0.29);
  }
}

TEST(Matcher, MissOutsideTheWindowIsSaturated) {
  std::mt19937 random(6);
  const Pose pose{0.1, 0.3, 0.2};
  const Points body = test::scan(test::room(), pose, {181, kPi, 8.0, 0.0}, random);
  const Table table = draw(body, pose);
  const Match match = Matcher().match(table, body, {0.25, 0.3, 0.2}, {0.06, 0.06, 0.06}, nullptr);
  EXPECT_EQ(match.status, Status::kSaturated);
  EXPECT_TRUE(match.saturated);
  EXPECT_FALSE(match.usable());
  EXPECT_FALSE(Matcher().match(table, body, {0.25, 0.3, 0.2}, {0.3, 0.3, 0.06}, nullptr).saturated);
}

TEST(Matcher, PriorDecidesBetweenEqualPeaks) {
  // A comb of posts 0.5 m apart: matches repeat along x.
  Points world;
  for (int i = -8; i <= 8; ++i) {
    for (int j = 0; j < 3; ++j) world.push_back({0.5 * i, 1.0 + 0.5 * j});
  }
  Points body;
  for (int i = -2; i <= 2; ++i) {
    for (int j = 0; j < 3; ++j) body.push_back({0.5 * i, 1.0 + 0.5 * j});
  }
  Table table;
  table.draw(world, extract_contours(world, ContourParams::urg()), {});
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.04, 0.04, 0.01).asDiagonal();
  for (const double x : {-0.5, 0.0, 0.5}) {
    const Prior prior{{x + 0.1, 0.0, 0.0}, covariance};
    EXPECT_NEAR(Matcher().match(table, body, {}, {0.8, 0.2, 0.1}, &prior).pose.x, x, 0.01);
  }
}

// Scans of a map that disagree make its walls thick and the peak blunt: within two cells nothing resists a turn.
// Farther away everything does.
TEST(Matcher, BluntPeakIsNotLeftForThePrior) {
  std::mt19937 random(5);
  const Pose truth{0.2, 0.3, 0.1};
  const Points body = test::scan(test::room(0.3), truth, {181, kPi, 8.0, 0.002}, random);
  Table table;
  for (const double turned : {-0.04, -0.02, 0.0, 0.02, 0.04}) {
    const Pose pose{truth.x, truth.y, truth.theta + turned};
    table.draw(transform(pose, body), extract_contours(body, {}), pose);
  }
  MatcherParams params;
  params.information_scale = 1.0;
  const Prior prior{{truth.x, truth.y, truth.theta + 0.12}, Eigen::Vector3d(1e-3, 1e-3, 6e-3).asDiagonal()};
  const Match match = Matcher(params).match(table, body, prior.mean, {0.1, 0.1, 0.23}, &prior);
  EXPECT_LT(turn(match.pose, truth), 0.06);
  EXPECT_GT(match.inlier_ratio, 0.9);
  EXPECT_FALSE(match.degenerate);
  EXPECT_LT(match.covariance(2, 2), 0.5 * prior.covariance(2, 2));
  expect_sound(match);
}

// Farther along a corridor points leave what was drawn. That says nothing of where the sensor is.
TEST(Matcher, CorridorWhoseMapEndsIsLeftForThePrior) {
  std::mt19937 random(6);
  const test::Scene scene = {{{-20.0, 1.0}, {20.0, 1.0}}, {{-20.0, -1.0}, {20.0, -1.0}}};
  const Sensor sensor{181, kPi, 3.5, 0.005};
  const Table table = draw(test::scan(scene, {}, sensor, random), {});
  MatcherParams params;
  params.information_scale = 1.0;
  for (const double ahead : {0.5, 1.0, 2.0, 3.0}) {
    const Points body = test::scan(scene, {ahead, 0.0, 0.0}, sensor, random);
    const Prior prior{{ahead, 0.0, 0.0}, Eigen::Vector3d(0.25, 1e-3, 1e-3).asDiagonal()};
    const Match match = Matcher(params).match(table, body, prior.mean, {1.5, 0.1, 0.1}, &prior);
    EXPECT_TRUE(match.degenerate) << ahead;
    EXPECT_NEAR(match.pose.x, ahead, 0.05);
    EXPECT_GT(match.covariance(0, 0), 0.2);
  }
}

TEST(Matcher, SaysWhyThereIsNoMatch) {
  std::mt19937 random(7);
  const Pose pose{0.1, 0.3, 0.2};
  const Points body = test::scan(test::room(), pose, {181, kPi, 8.0, 0.0}, random);
  const Table table = draw(body, pose);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Pose guess{0.12, 0.31, 0.21};
  const Prior prior{guess, Eigen::Vector3d(0.01, 0.02, 0.03).asDiagonal()};
  const auto expect_guess = [&](const Points& points, const Table& map, Status status) {
    for (const Prior* p : {static_cast<const Prior*>(nullptr), &prior}) {
      const Match match = Matcher().match(map, points, guess, {0.1, 0.1, 0.1}, p);
      EXPECT_EQ(match.status, status) << to_string(match.status);
      EXPECT_EQ(match.pose.x, guess.x);
      EXPECT_EQ(match.pose.theta, guess.theta);
      EXPECT_EQ(match.hits, 0);
      EXPECT_TRUE(match.information.isZero());
      expect_sound(match);
      if (p != nullptr) {
        EXPECT_EQ(match.covariance, prior.covariance);
      }
    }
  };
  expect_guess({}, table, Status::kEmptyScan);
  expect_guess({{kNan, 0.0}, {0.0, kNan}}, table, Status::kEmptyScan);
  expect_guess({{1.0, 0.0}}, table, Status::kTooFewPoints);
  Points far = body;
  for (Point& p : far) p.x += 100.0;
  expect_guess(far, table, Status::kTooFewPoints);
  expect_guess(body, Table(), Status::kNoOverlap);
  Points elsewhere = body;
  for (Point& p : elsewhere) p.x += 15.0;
  expect_guess(elsewhere, table, Status::kNoOverlap);
}

TEST(Matcher, PointsThatAreNotPlacesChangeNothing) {
  std::mt19937 random(8);
  const Pose pose{0.1, 0.3, 0.2};
  const Points body = test::scan(test::room(), pose, {181, kPi, 8.0, 0.01}, random);
  Points dirty = body;
  dirty.insert(dirty.begin() + 50, {std::numeric_limits<double>::quiet_NaN(), 1.0});
  dirty.push_back({1.0, std::numeric_limits<double>::infinity()});
  const Table table = draw(body, pose);
  const Match clean = Matcher().match(table, body, pose, {0.1, 0.1, 0.1}, nullptr);
  const Match match = Matcher().match(table, dirty, pose, {0.1, 0.1, 0.1}, nullptr);
  EXPECT_EQ(match.pose.x, clean.pose.x);
  EXPECT_EQ(match.points, clean.points);
}

TEST(Matcher, StrangeSceneIsLowHits) {
  std::mt19937 random(9);
  const Points drawn = test::scan(test::room(), {0.0, 0.5, 0.0}, {181, kPi, 8.0, 0.0}, random);
  Points strange;
  std::uniform_real_distribution<double> range(0.3, 2.5);
  for (int i = 0; i < 181; ++i) {
    const double r = range(random);
    strange.push_back({r * std::cos(i * kPi / 180.0 - kPi / 2.0), r * std::sin(i * kPi / 180.0 - kPi / 2.0)});
  }
  const Match match = Matcher().match(draw(drawn, {0.0, 0.5, 0.0}), strange, {0.0, 0.5, 0.0}, {0.1, 0.1, 0.1}, nullptr);
  EXPECT_EQ(match.status, Status::kLowHits);
  EXPECT_LT(match.inlier_ratio, 0.4);
}

TEST(Matcher, RefusesInputThatMakesNoSense) {
  const Table table;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Prior flat{{}, Eigen::Matrix3d::Zero()};
  EXPECT_THROW(Matcher().match(table, {}, {kNan, 0.0, 0.0}, {}, nullptr), std::invalid_argument);
  EXPECT_THROW(Matcher().match(table, {}, {1e9, 0.0, 0.0}, {}, nullptr), std::invalid_argument);
  EXPECT_THROW(Matcher().match(table, {}, {}, {kNan, 0.0, 0.0}, nullptr), std::invalid_argument);
  EXPECT_THROW(Matcher().match(table, {}, {}, {-0.1, 0.0, 0.0}, nullptr), std::invalid_argument);
  EXPECT_THROW(Matcher().match(table, {}, {}, {1e9, 0.0, 0.0}, nullptr), std::invalid_argument);
  EXPECT_THROW(Matcher().match(table, {}, {}, {0.1, 0.1, 0.1}, &flat), std::invalid_argument);
  MatcherParams params;
  params.theta_step = 0.0;
  EXPECT_THROW(Matcher{params}, std::invalid_argument);
}

TEST(Matcher, ThreadsSharingATableAgree) {
  std::mt19937 random(10);
  const Pose pose{0.1, 0.3, 0.2};
  const Points body = test::scan(test::room(), pose, {181, kPi, 8.0, 0.01}, random);
  const Table table = draw(body, pose);
  const Matcher matcher;
  std::vector<Match> matches(4);
  std::vector<std::thread> threads;
  for (Match& match : matches) {
    threads.emplace_back([&] { match = matcher.match(table, body, {0.3, 0.2, 0.1}, {0.8, 0.8, 0.4}, nullptr); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const Match& match : matches) {
    EXPECT_EQ(match.pose.x, matches[0].pose.x);
    EXPECT_EQ(match.pose.theta, matches[0].pose.theta);
    EXPECT_LT(distance(match.pose, pose), 5e-3);
  }
}

TEST(Status, EachHasAName) {
  for (const Status status : {Status::kOk, Status::kEmptyScan, Status::kTooFewPoints, Status::kNoOverlap,
                              Status::kSaturated, Status::kDegenerate, Status::kLowHits}) {
    EXPECT_NE(to_string(status), "unknown");
  }
}

}  // namespace
}  // namespace frsm
