// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <frsm/matcher.hpp>

#include "oort/matching/frsm_adapter.hpp"
#include "oort/matching/rejection.hpp"

namespace oort {
namespace {

TEST(RejectionTest, CountsAreToldInTheOrderOfTheirTexts) {
  RejectionCounts counts;
  EXPECT_EQ(counts.total(), 0u);
  EXPECT_TRUE(counts.by_text().empty());
  counts[Rejection::kRoughHits] += 3;
  ++counts[Rejection::kAngle];
  ++counts[Rejection::kUnconfirmed];
  --counts[Rejection::kUnconfirmed];  // accepted after all
  EXPECT_EQ(counts.total(), 4u);
  const auto told = counts.by_text();
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0], std::pair(Rejection::kAngle, std::uint64_t{1}));
  EXPECT_EQ(told[1], std::pair(Rejection::kRoughHits, std::uint64_t{3}));
}

TEST(RejectionTest, StatusesOfFrsmKeepTheirTexts) {
  EXPECT_EQ(rejection_of(frsm::Status::kOk), Rejection::kNone);
  for (const frsm::Status status : {frsm::Status::kEmptyScan, frsm::Status::kTooFewPoints, frsm::Status::kNoOverlap,
                                    frsm::Status::kSaturated, frsm::Status::kDegenerate, frsm::Status::kLowHits}) {
    EXPECT_EQ(to_string(rejection_of(status)), frsm::to_string(status));
  }
}

}  // namespace
}  // namespace oort
