// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "oort/geometry/errors.hpp"
#include "oort/mapping/map.hpp"
#include "oort/storage/codec.hpp"
#include "oort/storage/map_file.hpp"

/// What the tests of map files share: a made-up map, a folder of their own, and whole-file reading and writing.
namespace oort::testing {

namespace fs = std::filesystem;

inline std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_file(const fs::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

/// A folder that is deleted with its content in the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "oort-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

inline Constraint make_constraint(std::uint64_t id, double scale) {
  Constraint constraint;
  constraint.time = 1500000000.0 + scale;
  constraint.id = id;
  constraint.T_i_j = {0.2 * scale, -0.01, 0.125};
  constraint.covariance << 0.02, 0.001, 0.0, 0.001, 0.03, 0.0, 0.0, 0.0, 0.025 * scale;
  return constraint;
}

/// A small map in which every field has a value of its own. `variant` tells maps apart.
inline Map make_map(int node_count = 4, double variant = 0.0) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Map map;
  for (int k = 0; k < node_count; ++k) {
    const auto id = static_cast<std::uint64_t>(k);
    map.graph.nodes.push_back({id, {0.25 * k + variant, 0.5, 0.1 * k}});
    const auto scale = static_cast<float>(1.0 + k);
    map.clouds.push_back({id,
                          1500000000.5 + k,
                          {{1.5 * scale, -0.25, 1.0},
                           {std::numeric_limits<double>::infinity(), 0.5, kNan},
                           {kNan, 0.75, kNan},
                           {0.01, 0.02, kNan}}});
    IncrementalResult result;
    result.id = id;
    result.target = k == 0 ? 0 : id - 1;
    result.T_local_id = {0.3 * k, 0.2, 0.1};
    result.covariance = make_constraint(id, 2.0).covariance;
    result.T_target_id = {0.3, 0.0, 0.05};
    result.hit_fraction = 0.5 + 0.01 * k;
    map.incremental_results.push_back(result);
    if (k > 0) map.graph.edges.push_back({id - 1, id - 1, id, make_constraint(id, k)});
  }
  if (node_count > 1) {
    const auto last = static_cast<std::uint64_t>(node_count - 1);
    map.graph.edges.back().constraint.type = ConstraintType::kOdometry;
    map.graph.switchable_edges.push_back({last, 0, last, make_constraint(0, 7.0), 0.75});
    LoopResult loop;
    loop.target = last;
    loop.T_id_target = {0.01, 0.02, 0.03};
    loop.covariance = make_constraint(0, 1.0).covariance;
    loop.hit_fraction = 0.875;
    map.loop_results.push_back(loop);
    map.locations.push_back({"dock", "dock", 0, {0.0, 0.0, 0.0}});
    map.locations.push_back({"waypoints", "K\u00fcche", last, {1.0, 2.0, -0.5}});
  }
  return map;
}

/// A folder to save a map into.
class StorageTest : public ::testing::Test {
 protected:
  /// The message of the MapFileError that loading ends with.
  std::string load_error(const std::string& path, const LoadOptions& options = {}) const {
    try {
      load_map(path, options);
    } catch (const MapFileError& error) {
      return error.what();
    }
    return "no error";
  }

  std::vector<std::string> names() const {
    std::vector<std::string> list;
    for (const auto& entry : fs::directory_iterator(folder_.path())) list.push_back(entry.path().filename().string());
    std::sort(list.begin(), list.end());
    return list;
  }

  TemporaryFolder folder_;
  const std::string base_ = folder_ / "home";
  const std::vector<std::string> whole_set_ = {"home.map_capnp", "home.map_meta_capnp", "home.md5"};
};

/// Whether two maps are the same in every bit.
inline bool same(const Map& a, const Map& b) {
  return encode_map(a) == encode_map(b) && encode_metadata(a.locations) == encode_metadata(b.locations);
}

}  // namespace oort::testing
