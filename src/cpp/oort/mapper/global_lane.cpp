// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include "oort/mapper/global_lane.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace oort {
namespace {

/// Nobody waits for the piece of work any more.
struct Ended {};

}  // namespace

GlobalLane::GlobalLane(const Parameters& parameters, bool threaded) : slam_(parameters), threaded_(threaded) {}

GlobalLane::~GlobalLane() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void GlobalLane::Meter::charge(std::uint64_t units) {
  if (lane_.ending_) throw Ended();
  const std::uint64_t done = lane_.done_.fetch_add(units) + units;
  if (done < lane_.awaited_) return;
  { const std::lock_guard<std::mutex> lock(lane_.mutex_); }  // who waits is waiting, not about to
  lane_.changed_.notify_all();
}

void GlobalLane::advance(std::vector<NodeAddition> nodes, std::optional<std::vector<Location>> locations,
                         std::uint64_t units) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    settled_ = false;
    if (!nodes.empty() || locations) {
      handovers_.push_back({granted_, std::move(nodes), std::move(locations), false, reductions_taken_});
    }
    granted_before_ = granted_;
    granted_ += units;
  }
  if (!threaded_) return;
  if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  changed_.notify_all();
}

void GlobalLane::request_dock(std::vector<NodeAddition> nodes, const std::vector<Location>& locations) {
  const std::lock_guard<std::mutex> lock(mutex_);
  handovers_.push_back({granted_, std::move(nodes), locations, true, reductions_taken_});
}

std::vector<Correction> GlobalLane::take_due() {
  std::unique_lock<std::mutex> lock(mutex_);
  const std::uint64_t due = granted_before_;
  settled_ = false;
  if (threaded_) {
    wait_until(lock, due);
  } else {
    while (done_ < due && can_begin()) work_one_piece(lock);
  }
  rethrow();
  return take_before(due);
}

std::vector<Correction> GlobalLane::settle() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (threaded_) {
    wait_until(lock, std::numeric_limits<std::uint64_t>::max());
  } else {
    while (can_begin()) work_one_piece(lock);
  }
  rethrow();
  std::vector<Correction> rest = take_before(std::numeric_limits<std::uint64_t>::max());
  for (const Handover& handover : handovers_) hand_over(handover);
  handovers_.clear();
  done_ = std::max<std::uint64_t>(done_, granted_);  // idle time is no credit
  settled_ = true;
  return rest;
}

void GlobalLane::wait_for_piece() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (threaded_) wait_until(lock, std::numeric_limits<std::uint64_t>::max());
}

WorkSeconds GlobalLane::work_seconds() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return busy_ ? work_seconds_ : slam_.work_seconds();
}

// A piece begins while granted work is left: by then all nodes that it may know have come.
bool GlobalLane::can_begin() const {
  if (busy_ || settled_ || ending_ || error_) return false;
  if (slam_.has_work()) return done_ < granted_;
  return !handovers_.empty() && std::max<std::uint64_t>(done_, handovers_.front().at) < granted_;
}

void GlobalLane::work_one_piece(std::unique_lock<std::mutex>& lock) {
  if (!slam_.has_work()) done_ = std::max<std::uint64_t>(done_, handovers_.front().at);
  std::vector<Handover> handovers;
  while (!handovers_.empty() && handovers_.front().at <= done_) {
    handovers.push_back(std::move(handovers_.front()));
    handovers_.pop_front();
  }
  busy_ = true;
  lock.unlock();
  std::optional<Correction> correction;
  std::exception_ptr error;
  try {
    for (const Handover& handover : handovers) hand_over(handover);
    if (slam_.has_work()) correction = slam_.work(meter_);
  } catch (...) {
    error = std::current_exception();
  }
  lock.lock();
  if (correction && correction->reduced) {
    ++reductions_made_;
    reduced_ = correction->reduced->nodes;
  }
  if (correction) results_.push_back({done_, std::move(*correction)});
  work_seconds_ = slam_.work_seconds();
  error_ = error;
  busy_ = false;
}

/// Of whoever may call slam_.
void GlobalLane::hand_over(const Handover& handover) {
  // One reduction at a time is under way: what comes is numbered by the last one or by the one before.
  const bool is_of_before = handover.reductions < reductions_made_;
  if (!is_of_before) slam_.reduction_was_taken();
  for (const NodeAddition& node : handover.nodes) slam_.add(is_of_before ? renumbered(node, reduced_) : node);
  if (handover.locations) {
    std::vector<Location> locations = *handover.locations;
    if (is_of_before) {
      for (Location& location : locations) location = renumbered(location, reduced_);
    }
    slam_.set_locations(std::move(locations));
  }
  if (handover.requests_dock) slam_.request_dock();
}

/// Until no result with less counted work can come any more.
void GlobalLane::wait_until(std::unique_lock<std::mutex>& lock, std::uint64_t work) {
  awaited_ = work;
  changed_.notify_all();
  changed_.wait(lock, [&] { return done_ >= work || (!busy_ && !can_begin()); });
  awaited_ = std::numeric_limits<std::uint64_t>::max();
}

std::vector<Correction> GlobalLane::take_before(std::uint64_t work) {
  std::vector<Correction> corrections;
  while (!results_.empty() && results_.front().at < work) {
    if (results_.front().correction.reduced) ++reductions_taken_;
    corrections.push_back(std::move(results_.front().correction));
    results_.pop_front();
  }
  return corrections;
}

void GlobalLane::rethrow() {
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void GlobalLane::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ending_) {
    if (can_begin()) {
      work_one_piece(lock);
      changed_.notify_all();
    } else {
      changed_.wait(lock, [this] { return ending_ || can_begin(); });
    }
  }
}

}  // namespace oort
