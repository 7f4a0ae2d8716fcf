// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// How a map's path may be written, and where links lead.
#include <gtest/gtest.h>

#include "oort/storage/internal/file_set.hpp"
#include "oort/storage/map_file.hpp"
#include "oort/storage/paths.hpp"
#include "storage_fixtures.hpp"

namespace oort {
namespace {

using testing::make_map;
using testing::same;
using testing::write_file;
namespace fs = std::filesystem;

using StoragePaths = testing::StorageTest;

TEST_F(StoragePaths, KnowsAPathInEachForm) {
  for (const std::string form : {"home", "home.map_capnp", "home.map_meta_capnp", "home.capnp"}) {
    EXPECT_EQ(normalise_map_path(folder_ / form), base_) << form;
  }
  save_map(folder_ / "home.capnp", make_map());
  EXPECT_EQ(names(), whole_set_);
  EXPECT_TRUE(same(load_map(folder_ / "home.capnp"), make_map()));
}

TEST_F(StoragePaths, AMapNamedLikeTheManualsPathsIsFound) {
  FileSet(folder_ / "home.capnp").write(encode_map(make_map()), encode_metadata({}));
  EXPECT_EQ(load_map(folder_ / "home.capnp").graph.nodes.size(), 4U);
  save_map(folder_ / "home.capnp", make_map(6));
  EXPECT_EQ(load_map(folder_ / "home.capnp").graph.nodes.size(), 6U) << "what was saved is what is loaded";
}

TEST_F(StoragePaths, ASingleFileIsLoadedOnRequest) {
  write_file(folder_ / "home.capnp", encode_map(make_map()));
  EXPECT_NE(load_error(folder_ / "home.capnp").find("ignore_checksum"), std::string::npos);
  EXPECT_EQ(load_map(folder_ / "home.capnp", {true}).graph.nodes.size(), 4U);
}

TEST_F(StoragePaths, FollowsLinks) {
  fs::create_directory(folder_ / "maps");
  const std::string real = folder_ / "maps/home";
  save_map(real, make_map());
  fs::create_symlink("maps/home.map_capnp", folder_ / "current.map_capnp");
  fs::create_symlink("maps/home", folder_ / "last");
  fs::create_directory_symlink("maps", folder_ / "folder");
  fs::create_symlink("last", folder_ / "again");
  for (const std::string link : {"current", "current.map_capnp", "last", "folder/home", "again.map_capnp"}) {
    EXPECT_EQ(normalise_map_path(folder_ / link), real) << link;
  }
  save_map(folder_ / "current", make_map(6));
  EXPECT_EQ(load_map(real).graph.nodes.size(), 6U);
  EXPECT_TRUE(fs::is_symlink(folder_ / "current.map_capnp"));
}

TEST_F(StoragePaths, LinksInACircleEnd) {
  fs::create_symlink("b", folder_ / "a");
  fs::create_symlink("a", folder_ / "b");
  EXPECT_NE(load_error(folder_ / "a"), "no error");
}

TEST_F(StoragePaths, RelativePathsBecomeAbsolute) {
  EXPECT_EQ(normalise_map_path("home"), (fs::canonical(fs::current_path()) / "home").string());
}

}  // namespace
}  // namespace oort
