// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/localization/localizer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "localization_fixtures.hpp"
#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

using testing::kMount;
using testing::make_room;
using testing::reference_of;
using testing::see;
using testing::views_of_room;

const Eigen::Matrix3d kRoughly = Eigen::Vector3d(0.02, 0.02, 0.02).asDiagonal();

Localizer localizer_of_room() {
  return {reference_of(make_room(), views_of_room()), Parameters{}, kMount};
}

// Drives on in a world; returns how far the pose is off at the end [m].
double drive(Localizer& localizer, const testing::World& world, const std::vector<Pose2>& truth,
             const std::vector<Pose2>& odometry) {
  for (std::size_t k = 0; k < truth.size(); ++k) {
    localizer.add_scan(see(world, truth[k] * kMount, 0.1 * static_cast<double>(k)), odometry[k]);
  }
  const auto pose = localizer.T_map_sensor();
  return pose ? between(truth.back() * kMount, *pose).translation().norm() : std::numeric_limits<double>::infinity();
}

TEST(Localizer, FindsItselfAndFollowsWhereOdometryDrifts) {
  Localizer localizer = localizer_of_room();
  EXPECT_FALSE(localizer.T_map_sensor());
  const std::vector<Pose2> truth = testing::laps(1.5);
  const double error = drive(localizer, make_room(), truth, testing::odometry_of(truth, 0.03, 0.02));
  EXPECT_LT(error, 0.04);
  EXPECT_EQ(localizer.state(), LocalizationState::kTracking);
  EXPECT_EQ(localizer.statistics().jumps, 0U);
  EXPECT_LT(between(*localizer.T_map_sensor(),
                    *localizer.T_map_odom() * testing::odometry_of(truth, 0.03, 0.02).back() * kMount)
                .translation()
                .norm(),
            1e-9);
}

TEST(Localizer, AToldPoseIsUncertainUntilItIsSeen) {
  Localizer localizer = localizer_of_room();
  const Pose2 start = testing::laps(1.0).front();
  localizer.start_at(start * kMount * Pose2{0.1, -0.1, 0.1}, kRoughly);
  EXPECT_EQ(localizer.state(), LocalizationState::kUncertain);
  EXPECT_EQ(localizer.add_scan(see(make_room(), start * kMount, 0.0), {}), LocalizationState::kTracking);
  EXPECT_LT(between(start * kMount, *localizer.T_map_sensor()).translation().norm(), 0.03);
}

TEST(Localizer, SaysThatItIsLostInAnotherWorld) {
  Localizer localizer = localizer_of_room();
  const std::vector<Pose2> truth = testing::laps(0.35);
  localizer.start_at(truth.front() * kMount, kRoughly);
  testing::World other;
  testing::add_outline({{-3.9, -2.9}, {3.5, -3.2}, {4.1, 3.3}, {-3.5, 2.9}}, other);
  drive(localizer, other, truth, truth);
  EXPECT_EQ(localizer.state(), LocalizationState::kLost);
  EXPECT_GT(localizer.statistics().searches, 5U);
}

TEST(Localizer, IsFoundAgainAfterItWasCarriedAway) {
  Localizer localizer = localizer_of_room();
  const std::vector<Pose2> truth = testing::laps(1.0);
  localizer.start_at(truth.front() * kMount, kRoughly);
  const std::size_t half = truth.size() / 2;
  drive(localizer, make_room(), {truth.begin(), truth.begin() + 20}, {truth.begin(), truth.begin() + 20});
  ASSERT_EQ(localizer.state(), LocalizationState::kTracking);
  // It goes on half a lap away, while odometry goes on from where it was.
  std::vector<Pose2> after(truth.begin() + static_cast<std::ptrdiff_t>(half), truth.end());
  std::vector<Pose2> odometry;
  for (const Pose2& pose : after) odometry.push_back(truth[20] * between(after.front(), pose));
  bool was_uncertain = false;
  for (std::size_t k = 0; k < after.size(); ++k) {
    const auto state = localizer.add_scan(see(make_room(), after[k] * kMount, 0.0), odometry[k]);
    was_uncertain = was_uncertain || state != LocalizationState::kTracking;
    if (state != LocalizationState::kTracking) continue;
    if (was_uncertain) {
      EXPECT_LT(between(after[k] * kMount, *localizer.T_map_sensor()).translation().norm(), 0.05);
    }
  }
  EXPECT_TRUE(was_uncertain);
  EXPECT_EQ(localizer.state(), LocalizationState::kTracking);
  EXPECT_EQ(localizer.statistics().jumps, 1U);
}

TEST(Localizer, WhatWasSeenBeforeOutweighsScansThatFitSomewhereElse) {
  Localizer localizer = localizer_of_room();
  const std::vector<Pose2> truth = testing::laps(1.0);
  localizer.start_at(truth.front() * kMount, kRoughly);
  for (std::size_t k = 0; k < 90; ++k) {
    const bool is_blind = k >= 50 && k < 80;  // odometry alone, which makes the search window wide
    const Pose2 seen = k < 80 ? truth[k] : Pose2{0.25, 0.0, 0.0} * truth[k];
    localizer.add_scan(see(is_blind ? testing::World{} : make_room(), seen * kMount, 0.0), truth[k]);
    if (k == 79) {
      EXPECT_GT(std::sqrt(localizer.covariance()(0, 0)), 0.08);
    }
  }
  EXPECT_GT(localizer.statistics().match_rejections[Rejection::kContradictsEarlierViews], 0U);
  EXPECT_LT(between(truth[89] * kMount, *localizer.T_map_sensor()).translation().norm(), 0.05);
}

// Of two rooms alike but for a shelf the robot is in the one without, and somebody stands where the other one has it.
TEST(Localizer, AnAnswerThatWasNeverReliedOnIsTakenBackWhenAnotherPlaceIsAsGood) {
  const Pose2 T_first_second{12.0, 1.0, 0.5};
  testing::World second = make_room();
  testing::add_outline({{0.9, 0.9}, {2.9, 0.9}, {2.9, 1.1}, {0.9, 1.1}}, second);
  const testing::World world = testing::joined(make_room(), testing::moved(second, T_first_second));
  std::vector<Pose2> views = views_of_room();
  for (const Pose2& view : views_of_room(T_first_second)) views.push_back(view);
  Localizer localizer(reference_of(world, views), Parameters{}, kMount);
  const Pose2 start{1.5, -1.3, 2.0};
  localizer.add_scan(see(second, start * kMount, 0.0), {});
  ASSERT_TRUE(localizer.T_map_sensor());
  ASSERT_GT(localizer.T_map_sensor()->x, 6.0);  // in the other room
  ASSERT_EQ(localizer.state(), LocalizationState::kUncertain);
  for (int k = 1; k <= 14; ++k) {  // turning to where the rooms are alike
    const Pose2 moved{0.0, 0.0, 0.2 * k};
    localizer.add_scan(see(make_room(), start * moved * kMount, 0.1 * k), moved);
    ASSERT_NE(localizer.state(), LocalizationState::kTracking) << k;
  }
  EXPECT_EQ(localizer.state(), LocalizationState::kSearching);
}

TEST(Localizer, AParkedRobotStaysWhereItIs) {
  Localizer localizer = localizer_of_room();
  const Pose2 place = testing::laps(1.0).front();
  localizer.add_scan(see(make_room(), place * kMount, 0.0), {});
  const Pose2 first = *localizer.T_map_sensor();
  for (int k = 0; k < 50; ++k) localizer.add_scan(see(make_room(), place * kMount, 0.1 * k), {});
  EXPECT_LT(between(first, *localizer.T_map_sensor()).translation().norm(), 0.01);
  EXPECT_EQ(localizer.statistics().searches, 1U);
}

TEST(Localizer, RefusesWhatIsNotAPose) {
  Localizer localizer = localizer_of_room();
  EXPECT_THROW(localizer.start_at({NAN, 0.0, 0.0}, kRoughly), InputError);
  EXPECT_THROW(localizer.start_at({}, Eigen::Matrix3d::Zero()), InputError);
  EXPECT_THROW(localizer.add_scan(see(make_room(), {}, 0.0), {0.0, INFINITY, 0.0}), InputError);
  EXPECT_THROW(localizer.add_scan(see(make_room(), {}, 0.0), {2e6, 0.0, 0.0}), InputError);
  EXPECT_THROW(localizer.start_at({0.0, -2e6, 0.0}, kRoughly), InputError);
  EXPECT_EQ(localizer.statistics().scans, 0u);
}

}  // namespace
}  // namespace oort
