// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstddef>

namespace oort {

/// Constants of storage that were chosen, not derived.
struct StorageTuning {
  /// Of 8 bytes, that a map file unpacks to: 4 GiB, what one segment of a Cap'n Proto message can hold. The limits of
  /// MapTuning keep every map below.
  static constexpr std::size_t kMaxWords = std::size_t{1} << 29U;

  /// What unpacks to so many times its size is made to fill memory: maps unpack to twice or thrice.
  static constexpr std::size_t kMaxPacking = 32;

  /// [bytes] Longer files are not read: packing makes nothing longer than by an eighth and a little.
  static constexpr std::size_t kMaxFileSize = (kMaxWords / 8 + 1) * 73;

  /// How long a save or a load waits for another program that works in the same folder. To write a large map on a slow
  /// card takes seconds; more is a program that hangs, or no program of Oort's.
  static constexpr std::chrono::milliseconds kLockPatience{10'000};
  static constexpr std::chrono::milliseconds kLockLook{20};  ///< between two looks

  /// Calls of the operating system that are interrupted, or write nothing, so often in a row are not tried again.
  static constexpr int kMaxRetries = 1000;
};

}  // namespace oort
