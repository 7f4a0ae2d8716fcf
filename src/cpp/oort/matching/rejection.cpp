// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/matching/rejection.hpp"

#include <algorithm>
#include <numeric>

namespace oort {
namespace {

struct Row {
  Rejection rejection;
  std::string_view text;
};

// The texts are a part of report.json: matchers that spell one cause in two ways keep their spellings.
constexpr std::array<Row, kRejectionValues> kTexts{{
    {Rejection::kNone, "none"},
    {Rejection::kNotMatched, "not matched"},

    {Rejection::kEmptyScan, "empty scan"},
    {Rejection::kTooFewPoints, "too few points"},
    {Rejection::kNoOverlap, "no overlap"},
    {Rejection::kSaturated, "saturated"},
    {Rejection::kDegenerate, "degenerate"},
    {Rejection::kLowHits, "low hits"},
    {Rejection::kFewHitsAfterGap, "ok"},  // as frsm calls the match itself

    {Rejection::kGridEmptyScan, "empty_scan"},
    {Rejection::kLowScore, "low_score"},
    {Rejection::kNoHits, "no_overlap"},

    {Rejection::kScore, "score"},
    {Rejection::kX, "x"},
    {Rejection::kY, "y"},
    {Rejection::kTheta, "theta"},
    {Rejection::kDistance, "distance"},
    {Rejection::kSecondStageScore, "second_stage_score"},
    {Rejection::kSecondStageDistance, "second_stage_distance"},
    {Rejection::kSecondStageTheta, "second_stage_theta"},
    {Rejection::kRestarted, "restarted"},
    {Rejection::kContradictsOdometry, "contradicts odometry"},

    {Rejection::kSmallSubmap, "small_submap"},
    {Rejection::kRoughHits, "rough_hits"},
    {Rejection::kWindowBorder, "window_border"},
    {Rejection::kAmbiguous, "ambiguous"},
    {Rejection::kFineHits, "fine_hits"},
    {Rejection::kHits, "hits"},
    {Rejection::kCloseDistance, "close_distance"},
    {Rejection::kCloseHits, "close_hits"},
    {Rejection::kAngle, "angle"},
    {Rejection::kOtherSide, "other_side"},
    {Rejection::kUnconfirmed, "unconfirmed"},
    {Rejection::kSameNode, "same_node"},
    {Rejection::kNoReference, "no_reference"},

    {Rejection::kFewSurfaces, "few_surfaces"},
    {Rejection::kFar, "far"},

    {Rejection::kLowSupport, "low support"},
    {Rejection::kUnexpected, "unexpected"},
    {Rejection::kContradictsEarlierViews, "contradicts earlier views"},
    {Rejection::kSearchTooFewPoints, "too_few_points"},
    {Rejection::kNoMatch, "no_match"},
    {Rejection::kSearchLowSupport, "low_support"},
    {Rejection::kImprecise, "imprecise"},
}};

/// Whether the table has a row for each value, in the order of the values, and every text once.
constexpr bool is_whole() {
  for (std::size_t i = 0; i < kTexts.size(); ++i) {
    if (kTexts[i].rejection != static_cast<Rejection>(i) || kTexts[i].text.empty()) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (kTexts[i].text == kTexts[j].text) return false;
    }
  }
  return true;
}
static_assert(is_whole());

}  // namespace

std::string_view to_string(Rejection rejection) {
  return kTexts[static_cast<std::size_t>(rejection)].text;
}

std::uint64_t RejectionCounts::total() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
}

std::vector<std::pair<Rejection, std::uint64_t>> RejectionCounts::by_text() const {
  std::vector<std::pair<Rejection, std::uint64_t>> given;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] > 0) given.emplace_back(static_cast<Rejection>(i), counts_[i]);
  }
  std::sort(given.begin(), given.end(),
            [](const auto& a, const auto& b) { return to_string(a.first) < to_string(b.first); });
  return given;
}

}  // namespace oort
