// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "oort/loop_closure/closure_log.hpp"

namespace oort {
namespace {

TEST(ClosureLogTest, KeepsNothingUnlessGivenRoom) {
  ClosureLog log;
  log.add({1, 0, Rejection::kFineHits, {}, 0.5});
  EXPECT_TRUE(log.attempts().empty());
}

TEST(ClosureLogTest, KeepsTheNewest) {
  ClosureLog log;
  log.set_capacity(3);
  for (std::uint64_t query = 0; query < 10; ++query) log.add({query, 0, Rejection::kNone, {}, 1.0});
  ASSERT_EQ(log.attempts().size(), 3u);
  EXPECT_EQ(log.attempts().front().query, 7u);
  EXPECT_EQ(log.attempts().back().query, 9u);
  log.set_capacity(1);
  ASSERT_EQ(log.attempts().size(), 1u);
  EXPECT_EQ(log.attempts().front().query, 9u);
  EXPECT_EQ(log.forgotten(), 9u);
}

TEST(ClosureLogTest, WhatWaitedMayBeAcceptedLater) {
  ClosureLog log;
  log.set_capacity(10);
  log.add({5, 1, Rejection::kUnconfirmed, {}, 0.9});
  log.add({5, 2, Rejection::kUnconfirmed, {}, 0.9});
  log.accept(5, 1);
  log.accept(4, 1);  // long forgotten
  EXPECT_EQ(log.attempts()[0].rejection, Rejection::kNone);
  EXPECT_EQ(log.attempts()[1].rejection, Rejection::kUnconfirmed);
}

}  // namespace
}  // namespace oort
