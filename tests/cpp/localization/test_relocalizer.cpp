// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/localization/relocalizer.hpp"

#include <gtest/gtest.h>

#include "localization_fixtures.hpp"
#include "oort/geometry/errors.hpp"

namespace oort {
namespace {

using testing::make_room;
using testing::placed;
using testing::reference_of;
using testing::views_of_room;

const std::vector<Pose2> kPlaces = {{-1.4, 1.6, -0.9}, {2.3, 1.7, -2.4}, {1.5, -1.3, 2.0},
                                    {-2.3, -1.2, 0.4}, {0.1, 2.2, -1.6}, {-1.6, 0.4, 1.2}};

Relocalizer relocalizer(std::shared_ptr<const ReferenceMap> map) {
  return {std::move(map), Parameters{}};
}

TEST(Relocalizer, FindsARobotAnywhereInARoom) {
  const Relocalizer relocalizer_of_room = relocalizer(reference_of(make_room(), views_of_room()));
  for (const Pose2& place : kPlaces) {
    const Relocalization found = relocalizer_of_room.find({placed(make_room(), place)});
    ASSERT_EQ(found.rejection, Rejection::kNone) << place.x << " " << place.y;
    const Pose2 error = between(place, found.best->T_map_sensor);
    EXPECT_LT(error.translation().norm(), 0.03);
    EXPECT_LT(std::abs(error.theta), 0.015);
    EXPECT_GT(found.best->support.value(), 0.9);
  }
}

TEST(Relocalizer, JoinsScansByOdometryAndAnswersForTheNewest) {
  const Relocalizer relocalizer_of_room = relocalizer(reference_of(make_room(), views_of_room()));
  const Pose2 T_odom_map{5.0, -3.0, 2.0};
  std::vector<PlacedScan> scans;
  for (const double x : {-1.2, -1.0, -0.8}) scans.push_back(placed(make_room(), {x, 1.7, 0.2}, T_odom_map));
  for (PlacedScan& scan : scans) scan.cloud.id = 0;
  const Relocalization found = relocalizer_of_room.find(scans);
  ASSERT_EQ(found.rejection, Rejection::kNone);
  EXPECT_LT(between({-0.8, 1.7, 0.2}, found.best->T_map_sensor).translation().norm(), 0.03);
}

TEST(Relocalizer, LooksAtNoPlaceThatScoresLess) {
  Parameters parameters;
  parameters.loop_closure_graph_builder.branch_and_bound_matcher.global_localization_min_score = 0.999;
  const Relocalizer strict(reference_of(make_room(), views_of_room()), parameters);
  EXPECT_EQ(strict.find({placed(make_room(), {-0.8, 1.7, 0.2})}).rejection, Rejection::kNoMatch);
}

TEST(Relocalizer, RefusesToChooseBetweenTwoRoomsThatLookAlike) {
  const Pose2 T_first_second{12.0, 1.0, 0.5};
  const testing::World world = testing::joined(make_room(), testing::moved(make_room(), T_first_second));
  std::vector<Pose2> views = views_of_room();
  for (const Pose2& view : views_of_room(T_first_second)) views.push_back(view);
  const Relocalizer relocalizer_of_both = relocalizer(reference_of(world, views));
  for (const Pose2& place : kPlaces) {
    const Relocalization found = relocalizer_of_both.find({placed(world, T_first_second * place)});
    EXPECT_EQ(found.rejection, Rejection::kAmbiguous);
    ASSERT_TRUE(found.best && found.second);
    EXPECT_GT(between(found.best->T_map_sensor, found.second->T_map_sensor).translation().norm(), 5.0);
  }
}

// What hides a wall from one scan does so for all of its beams: alone it must lead by more than scans from several
// places.
TEST(Relocalizer, OneScanAloneMustLeadByMore) {
  const double min_lead = Parameters{}.localization.relocalizer.min_lead;
  const Pose2 T_first_second{12.0, 1.0, 0.5};
  int told_apart_by_two_alone = 0;
  for (double width = 0.5; width < 2.0; width += 0.1) {
    testing::World second = make_room();  // the rooms differ by a shelf
    testing::add_outline({{0.9, 0.9}, {0.9 + width, 0.9}, {0.9 + width, 1.1}, {0.9, 1.1}}, second);
    const testing::World world = testing::joined(make_room(), testing::moved(second, T_first_second));
    std::vector<Pose2> views = views_of_room();
    for (const Pose2& view : views_of_room(T_first_second)) views.push_back(view);
    const Relocalizer relocalizer_of_both = relocalizer(reference_of(world, views));
    const PlacedScan scan = placed(world, T_first_second * kPlaces[2]);
    const Relocalization by_one = relocalizer_of_both.find({scan}), by_two = relocalizer_of_both.find({scan, scan});
    ASSERT_NEAR(by_one.lead(), by_two.lead(), 1e-9);
    EXPECT_EQ(by_one.found(), by_one.lead() >= 1.5 * min_lead) << by_one.lead();
    EXPECT_EQ(by_two.found(), by_two.lead() >= min_lead) << by_two.lead();
    told_apart_by_two_alone += by_two.found() && !by_one.found();
  }
  EXPECT_GT(told_apart_by_two_alone, 0);
}

TEST(Relocalizer, RefusesPlacesThatAreNotOnTheMap) {
  const Relocalizer relocalizer_of_room = relocalizer(reference_of(make_room(), views_of_room()));
  testing::World other;
  testing::add_outline({{-1.0, -4.0}, {2.5, -4.5}, {3.0, 1.0}, {0.4, 1.6}, {-1.4, 0.4}}, other);
  testing::add_outline({{0.9, -1.5}, {1.5, -1.9}, {1.9, -1.1}}, other);
  for (const Pose2& place : {Pose2{0.2, -2.0, 0.0}, Pose2{0.3, 0.3, -1.5}, Pose2{1.4, -3.2, 2.0}}) {
    EXPECT_NE(relocalizer_of_room.find({placed(other, place)}).rejection, Rejection::kNone);
  }
}

TEST(Relocalizer, AWallIsNotTakenForItsOtherSide) {
  // The room's outline, seen from outside of it, where the map has seen only its inside.
  const Relocalizer relocalizer_of_room = relocalizer(reference_of(make_room(), views_of_room()));
  for (const Pose2& place : {Pose2{3.6, -2.4, 2.2}, Pose2{-3.8, 0.0, 0.1}, Pose2{1.0, 4.2, -1.6}}) {
    const Relocalization found = relocalizer_of_room.find({placed(make_room(), place)});
    EXPECT_NE(found.rejection, Rejection::kNone) << to_string(found.rejection);
  }
}

TEST(Relocalizer, AStraightWallTellsNotWhere) {
  const testing::World corridor = {{{-15.0, -0.9}, {15.0, -0.9}}, {{-15.0, 0.9}, {15.0, 0.9}}};
  std::vector<Pose2> views;
  for (double x = -6.0; x <= 6.0; x += 0.25) views.push_back({x, 0.0, 0.0});
  const Relocalization found = relocalizer(reference_of(corridor, views)).find({placed(corridor, {1.0, 0.1, 0.05})});
  EXPECT_TRUE(found.rejection == Rejection::kAmbiguous || found.rejection == Rejection::kImprecise)
      << to_string(found.rejection);
}

TEST(Relocalizer, SaysWhenThereIsTooLittleToSee) {
  const auto map = reference_of(make_room(), views_of_room());
  const testing::World pole = {{{1.0, -0.1}, {1.0, 0.1}}};
  EXPECT_EQ(relocalizer(map).find({placed(pole, {})}).rejection, Rejection::kSearchTooFewPoints);
  EXPECT_THROW(relocalizer(map).find({}), InputError);
  EXPECT_THROW(relocalizer(map).find({placed(make_room(), {NAN, 0.0, 0.0})}), InputError);
}

TEST(Relocalizer, AnEmptyMapIsAnError) {
  EXPECT_THROW(ReferenceMap(Map{}, Parameters{}), InputError);
}

TEST(ReferenceMap, TellsFreeFloorFromWallsAndTheirSides) {
  const auto map = reference_of(make_room(), views_of_room());
  EXPECT_TRUE(map->space().is_free({-1.5, 0.5}));
  EXPECT_FALSE(map->space().is_free({0.0, 0.2}));  // inside the cupboard
  EXPECT_FALSE(map->space().is_free({-50.0, 0.2}));
  EXPECT_TRUE(map->space().is_blocked({-2.0, 0.2}, {1.5, 0.2}, 0.25));
  EXPECT_FALSE(map->space().is_blocked({-2.5, 1.5}, {2.5, 1.5}, 0.25));
  EXPECT_EQ(map->space().facing({-3.0, 0.2}, {1.0, 0.0}), KnownSpace::Facing::kSame);
  EXPECT_EQ(map->space().facing({-3.0, 0.2}, {-1.0, 0.0}), KnownSpace::Facing::kOther);
  EXPECT_EQ(map->space().facing({-1.5, 0.5}, {1.0, 0.0}), KnownSpace::Facing::kUnknown);
}

}  // namespace
}  // namespace oort
