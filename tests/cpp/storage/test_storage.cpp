// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "cloud_edits.hpp"
#include "datasets.hpp"
#include "oort/geometry/errors.hpp"
#include "oort/storage/internal/codec.hpp"
#include "oort/storage/internal/file_set.hpp"
#include "oort/storage/internal/md5.hpp"
#include "oort/storage/map_file.hpp"
#include "oort/storage/paths.hpp"
#include "storage_fixtures.hpp"

namespace oort {
namespace {

using testing::make_map;
using testing::read_file;
using testing::same;
using testing::write_file;
namespace fs = std::filesystem;

using Storage = testing::StorageTest;

const std::vector<std::string> kSuffixes = {kMapSuffix, kMetadataSuffix, kChecksumSuffix};

// ---- saving and loading ----

TEST_F(Storage, SavesThreeFilesAndLoadsThemAgain) {
  save_map(base_, make_map());
  EXPECT_EQ(names(), whole_set_);
  EXPECT_TRUE(same(load_map(base_), make_map()));
}

TEST_F(Storage, WritesTheChecksumsAsMd5sumPrintsThem) {
  save_map(base_, make_map());
  EXPECT_EQ(read_file(base_ + ".md5"), md5_hex(read_file(base_ + ".map_capnp")) + "  home.map_capnp\n" +
                                           md5_hex(read_file(base_ + ".map_meta_capnp")) + "  home.map_meta_capnp\n");
}

TEST_F(Storage, SavesTheSameBytesEachTime) {
  save_map(base_, make_map());
  save_map(folder_ / "copy", make_map());
  EXPECT_EQ(read_file(base_ + ".map_capnp"), read_file((folder_ / "copy") + ".map_capnp"));
}

TEST_F(Storage, AnEmptyMapIsAMap) {
  save_map(base_, {});
  EXPECT_TRUE(load_map(base_).graph.nodes.empty());
}

TEST_F(Storage, SaysThatThereIsNoMap) {
  EXPECT_NE(load_error(base_).find("home.map_capnp does not exist"), std::string::npos) << load_error(base_);
  EXPECT_NE(load_error("/no/such/folder/home").find("/no/such/folder"), std::string::npos);
  EXPECT_NE(load_error("").find("empty"), std::string::npos);
  EXPECT_NE(load_error(folder_.path().string()).find("directory"), std::string::npos);
}

TEST_F(Storage, DoesNotSaveADefectiveMap) {
  save_map(base_, make_map());
  Map broken = make_map(5);
  broken.graph.edges[0].i = 77;
  EXPECT_THROW(save_map(base_, broken), MapFileError);
  EXPECT_TRUE(same(load_map(base_), make_map()));
}

TEST_F(Storage, DoesNotLoadADefectiveMap) {
  Map broken = make_map();
  testing::drop_last(broken.clouds);
  FileSet(base_).write(encode_map(broken), encode_metadata({}));
  EXPECT_NE(load_error(base_).find("4 nodes but 3 clouds"), std::string::npos) << load_error(base_);
}

TEST_F(Storage, NamesTheFileThatDoesNotFitItsChecksum) {
  for (const std::string suffix : {kMapSuffix, kMetadataSuffix}) {
    save_map(base_, make_map());
    std::string bytes = read_file(base_ + suffix);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    write_file(base_ + suffix, bytes);
    EXPECT_NE(load_error(base_).find(suffix + " does not fit its checksum"), std::string::npos) << load_error(base_);
  }
  write_file(base_ + ".md5", "nonsense\n");
  EXPECT_NE(load_error(base_).find("does not hold the checksums"), std::string::npos) << load_error(base_);
}

TEST_F(Storage, LoadsWithoutChecksumsOnlyOnRequest) {
  save_map(base_, make_map());
  fs::remove(base_ + ".md5");
  EXPECT_NE(load_error(base_).find("ignore_checksum"), std::string::npos) << load_error(base_);
  EXPECT_TRUE(same(load_map(base_, {true}), make_map()));
  write_file(base_ + ".md5", "nonsense\n");
  EXPECT_TRUE(same(load_map(base_, {true}), make_map()));
  fs::remove(base_ + ".map_meta_capnp");
  EXPECT_TRUE(load_map(base_, {true}).locations.empty());
  fs::remove(base_ + ".map_capnp");
  EXPECT_NE(load_error(base_, {true}).find("home.map_capnp does not exist"), std::string::npos);
}

TEST_F(Storage, AMapWhoseFilesWereRenamedStaysReadable) {
  save_map(base_, make_map());
  for (const std::string& suffix : kSuffixes) fs::rename(base_ + suffix, (folder_ / "flat") + suffix);
  EXPECT_TRUE(same(load_map(folder_ / "flat"), make_map()));
}

TEST_F(Storage, AFolderInPlaceOfAFileIsAnError) {
  save_map(base_, make_map());
  fs::remove(base_ + ".map_capnp");
  fs::create_directory(base_ + ".map_capnp");
  EXPECT_NE(load_error(base_).find("is not a file"), std::string::npos) << load_error(base_);
}

// ---- metadata alone ----

TEST_F(Storage, SavesMetadataAlone) {
  save_map(base_, make_map());
  const auto before = fs::last_write_time(base_ + ".map_capnp");
  Map map = make_map(4, 0.125);  // the poses moved since
  map.locations.push_back({"waypoints", "bed", 2, {}});
  EXPECT_EQ(save_metadata(base_, map), Saved::kMetadata);
  EXPECT_EQ(fs::last_write_time(base_ + ".map_capnp"), before);
  EXPECT_EQ(names(), whole_set_);
  const Map loaded = load_map(base_);
  EXPECT_EQ(loaded.locations.size(), 3U);
  EXPECT_EQ(loaded.graph.nodes[0].pose.x, 0.0);
}

TEST_F(Storage, SavesTheWholeMapWhereMetadataAloneWouldNotFit) {
  const auto saves_all = [&](const Map& map) {
    EXPECT_EQ(save_metadata(base_, map), Saved::kMap);
    EXPECT_TRUE(same(load_map(base_), map));
  };
  saves_all(make_map());   // nothing is there
  saves_all(make_map(6));  // a location at a node that the file does not have
  Map other = make_map(6);
  for (std::uint64_t node = 0; node < other.clouds.size(); ++node) {
    PointCloud cloud = other.clouds[node];
    cloud.time += 1.0;
    other.clouds.set(node, std::move(cloud));
  }
  saves_all(other);  // its nodes have the same ids, but are others
  write_file(base_ + ".map_capnp", "damaged");
  saves_all(make_map(6));
}

// ---- interruptions ----

/// Starts to write a set in a process of its own, which dies without warning after `steps` changes on the disk.
/// Says whether the process got to the end before that.
bool write_and_die(const std::string& base, const Map& map, int steps, bool metadata_only = false) {
  const pid_t child = ::fork();
  if (child == 0) {
    int left = steps;
    FileSet files(base, Directory::Use::kWrite, [&] {
      if (--left == 0) ::_exit(1);
    });
    files.write(metadata_only ? std::nullopt : std::optional(encode_map(map)), encode_metadata(map.locations));
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST_F(Storage, ASetIsWholeWhereverSavingIsCutOff) {
  const Map old_map = make_map(4);
  const Map new_map = make_map(6);
  int old_seen = 0;
  int new_seen = 0;
  for (int steps = 1;; ++steps) {
    save_map(base_, old_map);
    const bool finished = write_and_die(base_, new_map, steps);
    const Map loaded = load_map(base_);
    const bool is_new = same(loaded, new_map);
    ASSERT_TRUE(is_new || same(loaded, old_map)) << "after step " << steps;
    ASSERT_TRUE(is_new || new_seen == 0) << "once the new map is whole it must not be lost again";
    (is_new ? new_seen : old_seen) += 1;
    ASSERT_TRUE(!is_new || names() == whole_set_) << "loading completes the renaming";
    save_map(base_, old_map);
    ASSERT_TRUE(same(load_map(base_), old_map)) << "saving over the remains of step " << steps;
    ASSERT_EQ(names(), whole_set_);
    if (finished) break;
  }
  EXPECT_EQ(old_seen, 5);  // three files are each made and filled; with the last one filled the new set is whole
  EXPECT_EQ(new_seen, 5);
}

TEST_F(Storage, MetadataIsWholeWhereverSavingIsCutOff) {
  Map new_map = make_map(4);
  new_map.locations.pop_back();
  for (int steps = 1;; ++steps) {
    save_map(base_, make_map(4));
    const bool finished = write_and_die(base_, new_map, steps, true);
    const Map loaded = load_map(base_);
    ASSERT_TRUE(same(loaded, steps < 4 ? make_map(4) : new_map)) << "after step " << steps;
    if (finished) break;
  }
}

TEST_F(Storage, TheFirstSaveMayBeCutOffToo) {
  ASSERT_FALSE(write_and_die(base_, make_map(), 5));
  EXPECT_NE(load_error(base_).find("does not exist"), std::string::npos);
  save_map(base_, make_map());
  EXPECT_EQ(names(), whole_set_);
  testing::TemporaryFolder other;
  ASSERT_FALSE(write_and_die(other / "home", make_map(), 6));
  EXPECT_TRUE(same(load_map(other / "home"), make_map()));
}

TEST_F(Storage, ASaveCutOffWhileRenamingIsNotLostToTheNextOneCutOff) {
  save_map(base_, make_map(4));
  ASSERT_FALSE(write_and_die(base_, make_map(6), 7));  // the map file is renamed, the others are not
  ASSERT_FALSE(write_and_die(base_, make_map(8), 3));  // two renamings complete the former; then one file is made
  EXPECT_TRUE(same(load_map(base_), make_map(6)));
}

TEST_F(Storage, RenamingsMayReachTheDiskInAnyOrder) {
  const std::string new_base = folder_ / "new";
  for (int done = 0; done < 8; ++done) {
    save_map(base_, make_map(4));
    save_map(new_base, make_map(6));
    for (std::size_t k = 0; k < kSuffixes.size(); ++k) {
      const bool is_renamed = (done >> k & 1) != 0;
      fs::rename(new_base + kSuffixes[k], base_ + kSuffixes[k] + (is_renamed ? "" : kNewSuffix));
    }
    EXPECT_TRUE(same(load_map(base_), make_map(6))) << done;
    EXPECT_EQ(names(), whole_set_) << done;
  }
}

TEST_F(Storage, ANewSetThatIsDamagedIsNotTaken) {
  save_map(base_, make_map(4));
  write_and_die(base_, make_map(6), 6);
  std::string bytes = read_file(base_ + ".map_capnp.new");
  bytes.resize(bytes.size() / 2);
  write_file(base_ + ".map_capnp.new", bytes);
  EXPECT_TRUE(same(load_map(base_), make_map(4)));
}

// ---- failures ----

TEST_F(Storage, AFullDiskLeavesTheOldMapAndNothingElse) {
  save_map(base_, make_map(4));
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);  // then writing beyond the limit fails as it does on a full disk
    const rlimit limit{4096, 4096};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      save_map(base_, make_map(200));
    } catch (const MapFileError&) {
      ::_exit(7);
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_EQ(names(), whole_set_);
  EXPECT_TRUE(same(load_map(base_), make_map(4)));
}

TEST_F(Storage, AFolderThatCannotBeWrittenIsAnError) {
  if (::geteuid() == 0) {  // root may write anywhere; a folder that does not exist fails for everyone
    EXPECT_THROW(save_map(folder_ / "none/home", make_map()), MapFileError);
    return;
  }
  save_map(base_, make_map(4));
  fs::permissions(folder_.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THROW(save_map(base_, make_map(6)), MapFileError);
  EXPECT_TRUE(same(load_map(base_), make_map(4)));
  fs::permissions(folder_.path(), fs::perms::owner_all);
}

TEST_F(Storage, AnErrorWhileWritingLeavesTheOldMapAndNothingElse) {
  save_map(base_, make_map(4));
  for (const std::string& suffix : kSuffixes) {
    fs::create_directory(base_ + suffix + ".new");  // a file cannot be made in its place
    EXPECT_THROW(save_map(base_, make_map(6)), MapFileError);
    EXPECT_TRUE(same(load_map(base_), make_map(4)));
    fs::remove(base_ + suffix + ".new");
    EXPECT_EQ(names(), whole_set_);
  }
}

TEST_F(Storage, SavingAndLoadingTakeTurns) {
  save_map(base_, make_map(4));
  const auto save_often = [&](int nodes) {
    for (int i = 0; i < 15; ++i) save_map(base_, make_map(nodes));
  };
  std::thread first(save_often, 4);
  std::thread second(save_often, 6);
  for (int i = 0; i < 40; ++i) {
    const Map map = load_map(base_);
    EXPECT_TRUE(same(map, make_map(4)) || same(map, make_map(6)));
  }
  first.join();
  second.join();
  EXPECT_EQ(names(), whole_set_);
}

TEST_F(Storage, AFolderThatAnotherProgramHoldsIsToldOf) {
  save_map(base_, make_map(4));
  const int folder = ::open(folder_.path().c_str(), O_RDONLY | O_DIRECTORY);
  const auto open_set = [&](Directory::Use use) { FileSet(base_, use, {}, std::chrono::milliseconds(30)).read(); };
  ASSERT_EQ(::flock(folder, LOCK_SH), 0);
  open_set(Directory::Use::kRead);
  EXPECT_THROW(open_set(Directory::Use::kWrite), MapFileError);
  ASSERT_EQ(::flock(folder, LOCK_EX), 0);
  EXPECT_THROW(open_set(Directory::Use::kRead), MapFileError);
  ::close(folder);
  open_set(Directory::Use::kWrite);
}

TEST_F(Storage, WhoReadsBesideAnotherReaderTakesANewSetAsItLies) {
  save_map(base_, make_map(4));
  ASSERT_FALSE(write_and_die(base_, make_map(6), 7));  // in the middle of renaming
  const int folder = ::open(folder_.path().c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(::flock(folder, LOCK_SH), 0);
  const std::vector<std::string> before = names();
  EXPECT_TRUE(same(load_map(base_), make_map(6)));
  EXPECT_EQ(names(), before);
  ::close(folder);
  EXPECT_TRUE(same(load_map(base_), make_map(6)));
  EXPECT_EQ(names(), whole_set_);
}

TEST_F(Storage, NoPathHoldsANul) {
  const std::string precious = folder_ / "precious.txt";
  testing::write_file(precious, "precious");
  EXPECT_THROW(save_map(precious + std::string("\0", 1), make_map(4)), MapFileError);
  EXPECT_THROW(load_map(precious + std::string("\0x", 2)), MapFileError);
  EXPECT_EQ(testing::read_file(precious), "precious");
}

// ---- the map that Mayfield's Oort wrote ----

TEST_F(Storage, TheGenuineMapComesBackByteForByte) {
  const fs::path genuine = testing::datasets() / "kuri_oort_map";
  if (!fs::exists(genuine)) GTEST_SKIP() << testing::not_found(genuine);
  for (const std::string& suffix : kSuffixes) fs::copy(genuine / ("map" + suffix), folder_ / ("map" + suffix));
  const Map map = load_map(folder_ / "map");
  EXPECT_EQ(map.graph.nodes.size(), 9U);
  EXPECT_EQ(map.graph.edges.size(), 8U);
  EXPECT_EQ(map.graph.switchable_edges.size(), 1U);
  EXPECT_EQ(map.clouds[8].points.size(), 180U);
  EXPECT_EQ(map.locations.at(0).name_space, "dock");
  SaveOptions as_original;
  as_original.as_original = true;
  save_map(folder_ / "map", map, as_original);
  for (const std::string& suffix : kSuffixes) {
    EXPECT_EQ(read_file(folder_ / ("map" + suffix)), read_file(genuine / ("map" + suffix))) << suffix;
  }
}

}  // namespace
}  // namespace oort
