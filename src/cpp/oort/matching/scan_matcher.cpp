// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/matching/scan_matcher.hpp"

namespace oort {

std::string_view to_string(MatchStatus status) {
  switch (status) {
    case MatchStatus::kOk:
      return "ok";
    case MatchStatus::kEmptyScan:
      return "empty_scan";
    case MatchStatus::kLowScore:
      return "low_score";
  }
  return "";
}

}  // namespace oort
