// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/loop_closure/closure_confirmation.hpp"

#include <gtest/gtest.h>

namespace oort {
namespace {

/// A drive along x, once as it was and, 100 nodes later, once more with all poses off by the same error.
class ConfirmationTest : public ::testing::Test {
 protected:
  ConfirmationTest() {
    for (std::uint64_t k = 0; k < 200; ++k) {
      const Pose2 truth{0.25 * static_cast<double>(k % 100), 0.0, 0.0};
      map.graph.nodes.push_back({k, k < 100 ? truth : error * truth});
    }
  }

  /// Says truly, give or take `off`, where the node of the first round is from the one of the second.
  Closure closure(std::uint64_t from, std::uint64_t to, const Pose2& off = {}) const {
    const Pose2 T_from_to = between(map.graph.nodes[from - 100].pose, map.graph.nodes[to].pose) * off;
    return {from, to, T_from_to, Eigen::Matrix3d::Identity(), 0.9};
  }

  const Pose2 error{2.0, 1.0, 0.3};
  Map map;
  ClosureConfirmation confirmation;
};

TEST_F(ConfirmationTest, OneAloneWaits) {
  EXPECT_TRUE(confirmation.add(map, closure(120, 20)).empty());
}

TEST_F(ConfirmationTest, ASecondFromElsewhereConfirmsBoth) {
  EXPECT_TRUE(confirmation.add(map, closure(120, 20)).empty());
  const auto confirmed = confirmation.add(map, closure(128, 26, {0.05, -0.05, 0.03}));
  ASSERT_EQ(confirmed.size(), 2U);
  EXPECT_EQ(confirmed[0].from, 120U);
  EXPECT_EQ(confirmed[1].from, 128U);
  EXPECT_EQ(confirmation.add(map, closure(136, 36)).size(), 0U) << "the two that were confirmed do not wait any more";
}

TEST_F(ConfirmationTest, ASecondFromTheSamePlaceDoesNot) {
  EXPECT_TRUE(confirmation.add(map, closure(120, 20)).empty());
  EXPECT_TRUE(confirmation.add(map, closure(122, 20)).empty()) << "half a metre on the same error would be made again";
  EXPECT_EQ(confirmation.add(map, closure(127, 27)).size(), 3U);
}

TEST_F(ConfirmationTest, OnesThatContradictDoNot) {
  EXPECT_TRUE(confirmation.add(map, closure(120, 20)).empty());
  EXPECT_TRUE(confirmation.add(map, closure(130, 30, {0.4, 0.0, 0.0})).empty());
  EXPECT_TRUE(confirmation.add(map, closure(132, 32, {0.0, 0.0, 0.2})).empty());
  EXPECT_EQ(confirmation.add(map, closure(134, 34)).size(), 2U) << "with the first";
}

TEST_F(ConfirmationTest, OldOnesAreForgotten) {
  EXPECT_TRUE(confirmation.add(map, closure(110, 10)).empty());
  EXPECT_TRUE(confirmation.add(map, closure(190, 90)).empty());
  EXPECT_TRUE(confirmation.add(map, closure(110, 10)).empty()) << "nor do those of nodes far after it count";
}

}  // namespace
}  // namespace oort
