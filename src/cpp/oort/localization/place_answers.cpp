// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/localization/place_answers.hpp"

#include <algorithm>

#include "oort/localization/place_tuning.hpp"

namespace oort {
namespace {

Pose2 driven(const Map& map, const FoundPlace& from, const FoundPlace& to) {
  return between(map.graph.nodes[from.node].pose, map.graph.nodes[to.node].pose);
}

}  // namespace

void PlaceAnswers::add(const FoundPlace& answer, const Map& map) {
  const auto disagrees = [&](const FoundPlace& other) { return !agree(other, answer, driven(map, other, answer)); };
  const auto is_strong = [](const FoundPlace& other) { return !other.is_weak; };
  if (answer.is_weak && std::any_of(answers_.begin(), answers_.end(), is_strong) &&
      std::any_of(answers_.begin(), answers_.end(), disagrees)) {
    return;
  }
  answers_.erase(std::remove_if(answers_.begin(), answers_.end(), disagrees), answers_.end());
  const bool is_new =
      answers_.empty() || driven(map, answers_.back(), answer).translation().norm() >= PlaceTuning::kAnswerTravel;
  if (is_new) answers_.push_back(answer);
}

double PlaceAnswers::weight() const {
  double weight = 0.0;
  for (const FoundPlace& answer : answers_) weight += answer.is_weak ? PlaceTuning::kWeakWeight : 1.0;
  return weight;
}

bool PlaceAnswers::are_enough(const Map& map, double weight, double apart) const {
  return this->weight() >= weight && driven(map, answers_.front(), answers_.back()).translation().norm() >= apart;
}

}  // namespace oort
