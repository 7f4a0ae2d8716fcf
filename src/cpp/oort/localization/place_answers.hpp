// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "oort/localization/place_finder.hpp"
#include "oort/map/map.hpp"

namespace oort {

/// Answers of a search that agree with each other: each is where the trajectory leads from the others.
class PlaceAnswers {
 public:
  /// Adds an answer and drops those that disagree with it. A weak one does not speak against others, and one from where
  /// the last came from tells nothing new.
  void add(const FoundPlace& answer, const Map& map);
  void clear() { answers_.clear(); }

  bool empty() const { return answers_.empty(); }
  const std::vector<FoundPlace>& all() const { return answers_; }
  const FoundPlace& newest() const { return answers_.back(); }

  double weight() const;
  /// Whether they are so many, from so far apart [m] that they are no repetitions of each other.
  bool are_enough(const Map& map, double weight, double apart) const;

 private:
  std::vector<FoundPlace> answers_;  // the oldest first
};

}  // namespace oort
