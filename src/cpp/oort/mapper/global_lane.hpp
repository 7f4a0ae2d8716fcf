// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "oort/geometry/work_meter.hpp"
#include "oort/map/node_addition.hpp"
#include "oort/mapper/global_slam.hpp"

namespace oort {

/// Runs global SLAM beside local SLAM, with the same result wherever and however fast each of them runs.
///
/// Time in this lane is counted work. With each scan the local lane grants some (advance()); a piece of work begins
/// only while what was granted lasts, takes the nodes that had come by then, and its result is stamped with the work
/// that was counted when it ended. Before a scan the local lane takes the results whose stamps lie within what was
/// granted up to two scans before (take_due()): the work of one scan has the time of the next one to be done. Who gets
/// there first waits for the other. So which nodes a piece of work knows, and at which scan its result takes effect,
/// follow from counts alone. Work that is charged beforehand delays nobody while it is done: a long job takes effect
/// later instead.
///
/// Without a thread the same pieces run in take_due(), in the same order and with the same stamps.
class GlobalLane {
 public:
  GlobalLane(const Parameters& parameters, bool threaded);
  ~GlobalLane();
  GlobalLane(const GlobalLane&) = delete;
  GlobalLane& operator=(const GlobalLane&) = delete;

  /// After a scan: hands over the nodes that it made and, if they changed, the named places, and grants work.
  void advance(std::vector<NodeAddition> nodes, std::optional<std::vector<Location>> locations, std::uint64_t units);

  /// Between scans: hands over the node that a call made, if it made one, and asks for the newest node to be linked to
  /// the dock. The work begins with the next scan's grant.
  void request_dock(std::vector<NodeAddition> nodes, const std::vector<Location>& locations);

  /// Before a scan: the corrections that take effect now, in their order. Rethrows what global SLAM threw.
  std::vector<Correction> take_due();

  /// Waits until no piece of work is under way and returns all corrections that were not taken yet. Global SLAM may be
  /// called until the next take_due() or advance().
  std::vector<Correction> settle();
  GlobalSlam& slam() { return slam_; }

  /// Waits until no piece of work is under way and none can begin: slam() may be read until the next advance().
  void wait_for_piece();

  WorkSeconds work_seconds() const;

 private:
  class Meter : public WorkMeter {
   public:
    explicit Meter(GlobalLane& lane) : lane_(lane) {}
    void charge(std::uint64_t units) override;

   private:
    GlobalLane& lane_;
  };
  struct Handover {
    std::uint64_t at;  // work counted when the nodes came
    std::vector<NodeAddition> nodes;
    std::optional<std::vector<Location>> locations;
    bool requests_dock;        // after the nodes
    std::uint64_t reductions;  // that the local lane knew of: it numbers nodes by the last one
  };
  struct Result {
    std::uint64_t at;
    Correction correction;
  };

  // All with the mutex held.
  bool can_begin() const;
  void work_one_piece(std::unique_lock<std::mutex>& lock);
  void wait_until(std::unique_lock<std::mutex>& lock, std::uint64_t work);
  std::vector<Correction> take_before(std::uint64_t work);
  void rethrow();

  void hand_over(const Handover& handover);
  void run();

  GlobalSlam slam_;  // of whoever holds the mutex or does a piece of work
  const bool threaded_;
  std::thread thread_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Meter meter_{*this};
  std::atomic<std::uint64_t> done_{0};  // work counted so far
  std::atomic<std::uint64_t> awaited_{std::numeric_limits<std::uint64_t>::max()};
  std::uint64_t granted_ = 0;
  std::uint64_t granted_before_ = 0;  // with the scan before the last one
  std::deque<Handover> handovers_;
  std::deque<Result> results_;
  std::exception_ptr error_;
  WorkSeconds work_seconds_;  // up to the last piece
  std::uint64_t reductions_made_ = 0, reductions_taken_ = 0;
  Renumbering reduced_;  // by the last one that was made
  bool busy_ = false;
  bool settled_ = false;  // whoever settled may call slam_
  std::atomic<bool> ending_{false};
};

}  // namespace oort
