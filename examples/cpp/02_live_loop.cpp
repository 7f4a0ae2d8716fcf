// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// 02: maps while a robot drives: odometry and scans come from another thread, the pose can be asked for at any time.
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <future>
#include <mutex>
#include <oort/oort.hpp>
#include <optional>
#include <string>
#include <thread>

#include "carmen_log.hpp"
#include "example_main.hpp"

namespace {

// A mapper with a queue in front: a scan waits there until the odometry at its stamp is known.
class LiveMapper {
 public:
  explicit LiveMapper(const oort::Pose2& T_base_sensor) : mapper_(oort::Parameters{}, T_base_sensor) {}

  void push_odometry(double time, const oort::Pose2& T_odom_base) {
    const std::lock_guard<std::mutex> lock(mutex_);
    odometry_.add(time, T_odom_base);
    newest_ = T_odom_base;
    changed_.notify_all();
  }

  void push_scan(oort::LaserScan scan) {
    const std::lock_guard<std::mutex> lock(mutex_);
    scans_.push_back(std::move(scan));
    changed_.notify_all();
  }

  std::optional<oort::Pose2> pose() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!T_map_odom_ || !newest_) return std::nullopt;
    return *T_map_odom_ * *newest_;
  }

  // Maps what comes until the robot has stopped and the queue is empty, then finishes the map.
  void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!stopped_ || !scans_.empty()) {
      const auto odometry = scans_.empty() ? std::nullopt : odometry_.lookup(scans_.front().time);
      if (!odometry) {
        if (stopped_) break;  // it will not come any more
        changed_.wait(lock);
        continue;
      }
      const oort::LaserScan scan = std::move(scans_.front());
      scans_.pop_front();
      lock.unlock();  // who pushes or asks for the pose never waits for the mapping
      const oort::ScanResult result = mapper_.add_scan(scan, *odometry);
      lock.lock();
      if (result.node_id) T_map_odom_ = result.T_map_odom;
    }
    mapper_.finish();
  }

  void stop() {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

  const oort::Map& map() const { return mapper_.map(); }  // after run()

 private:
  oort::Mapper mapper_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  oort::OdometryBuffer odometry_{20.0};  // [s]
  std::deque<oort::LaserScan> scans_;
  std::optional<oort::Pose2> newest_, T_map_odom_;
  bool stopped_ = false;
};

// The drivers of a robot, which in this example play a log.
void drive(const CarmenLog& log, LiveMapper& live) {
  for (const LoggedScan& logged : log.scans) {
    live.push_scan(logged.scan);
    live.push_odometry(logged.scan.time, logged.T_odom_base);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  live.stop();
}

void live_loop(const std::string& log_path, const std::string& map_path) {
  const CarmenLog log = read_carmen_log(log_path);
  LiveMapper live(log.T_base_sensor);
  auto mapping = std::async(std::launch::async, [&] { live.run(); });
  auto robot = std::async(std::launch::async, [&] { drive(log, live); });
  robot.get();  // a planner would ask for live.pose() meanwhile
  mapping.get();
  const std::optional<oort::Pose2> pose = live.pose();
  if (!pose) throw oort::InputError(log_path + ": no scan could be mapped");
  std::printf("at the end the base is at %.2f %.2f\n", pose->x, pose->y);
  oort::save_map(map_path, live.map());
  std::printf("%zu nodes\n", live.map().graph.nodes.size());
}

}  // namespace

int main(int argc, char** argv) {
  return example_main(argc, argv, live_loop);
}
