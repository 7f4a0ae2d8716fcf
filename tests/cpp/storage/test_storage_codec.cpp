// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <random>

#include "cloud_edits.hpp"
#include "oort/geometry/errors.hpp"
#include "oort/map/map_check.hpp"
#include "oort/storage/internal/checksum_file.hpp"
#include "oort/storage/internal/codec.hpp"
#include "oort/storage/internal/md5.hpp"
#include "storage_fixtures.hpp"

namespace oort {
namespace {

using testing::make_map;
using Words = std::vector<std::uint64_t>;

/// Undoes Cap'n Proto's packing (its encoding specification): a tag byte says which bytes of a word are not zero.
Words unpack(const std::string& packed) {
  Words words;
  std::size_t i = 0;
  const auto next = [&] { return static_cast<std::uint8_t>(packed.at(i++)); };
  while (i < packed.size()) {
    const std::uint8_t tag = next();
    std::uint64_t word = 0;
    for (int b = 0; b < 8; ++b) {
      if ((tag >> b & 1) != 0) word |= static_cast<std::uint64_t>(next()) << (8 * b);
    }
    words.push_back(word);
    if (tag == 0) words.insert(words.end(), next(), 0);
    if (tag != 0xff) continue;
    for (int count = next(); count > 0; --count) {
      std::uint64_t plain = 0;
      std::memcpy(&plain, packed.substr(i, 8).c_str(), 8);
      words.push_back(plain);
      i += 8;
    }
  }
  return words;
}

std::string pack(const Words& words) {
  std::string packed;
  for (const std::uint64_t word : words) {
    std::string bytes;
    int tag = 0;
    for (int b = 0; b < 8; ++b) {
      const auto byte = static_cast<char>(word >> (8 * b) & 0xffU);
      if (byte == 0) continue;
      tag |= 1 << b;
      bytes += byte;
    }
    packed += static_cast<char>(tag);
    packed += bytes;
    if (tag == 0 || tag == 0xff) packed += '\0';  // no further zero or plain words
  }
  return packed;
}

std::string plain_bytes(const Words& words) {
  return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint64_t)};
}

/// The message of the MapFileError that decoding ends with.
std::string decode_error(const std::string& bytes) {
  try {
    decode_map(bytes, "home.map_capnp");
  } catch (const MapFileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Md5, GivesTheDigestsOfTheRfc) {
  EXPECT_EQ(md5_hex(""), "d41d8cd98f00b204e9800998ecf8427e");
  EXPECT_EQ(md5_hex("a"), "0cc175b9c0f1b6a831c399e269772661");
  EXPECT_EQ(md5_hex("abc"), "900150983cd24fb0d6963f7d28e17f72");
  EXPECT_EQ(md5_hex("message digest"), "f96b697d7cb7938d525a2f31aaf161d0");
  EXPECT_EQ(md5_hex("abcdefghijklmnopqrstuvwxyz"), "c3fcd3d76192e4007dfb496cca67e13b");
  EXPECT_EQ(md5_hex("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789"),
            "d174ab98d277d9f5a5611c2c9f419d9f");
  EXPECT_EQ(md5_hex("12345678901234567890123456789012345678901234567890123456789012345678901234567890"),
            "57edf4a22be3c955ac49da2e2107b67a");
}

TEST(ChecksumFile, EscapesNamesAsMd5sumDoes) {
  const Checksums checksums{std::string(32, 'a'), std::string(32, 'b')};
  const std::string text = format_checksums(checksums, "a\\b\n.map_capnp", "c.map_meta_capnp");
  EXPECT_EQ(text, "\\" + checksums.map + "  a\\\\b\\n.map_capnp\n" + checksums.metadata + "  c.map_meta_capnp\n");
  EXPECT_EQ(parse_checksums(text)->map, checksums.map);
}

TEST(ChecksumFile, RefusesOtherText) {
  const std::string digest(32, 'a');
  EXPECT_FALSE(parse_checksums(""));
  EXPECT_FALSE(parse_checksums(digest + "  x.map_capnp\n")) << "one is missing";
  EXPECT_FALSE(parse_checksums("zz" + digest.substr(2) + "  x.map_capnp\n" + digest + "  x.map_meta_capnp\n"));
  EXPECT_TRUE(parse_checksums(digest + " *x.map_capnp\n" + digest + " *x.map_meta_capnp")) << "md5sum --binary";
}

TEST(Codec, KeepsEveryField) {
  const Map map = make_map();
  const Map again = decode_map(encode_map(map), "");
  ASSERT_EQ(again.graph.nodes.size(), 4U);
  EXPECT_EQ(again.graph.nodes[3].pose.x, 0.75);
  ASSERT_EQ(again.graph.edges.size(), 3U);
  const Edge& edge = again.graph.edges[2];
  EXPECT_EQ(std::make_tuple(edge.id, edge.i, edge.j, edge.constraint.id), std::make_tuple(2U, 2U, 3U, 3U));
  EXPECT_EQ(edge.constraint.time, 1500000003.0);
  EXPECT_EQ(edge.constraint.T_i_j.theta, 0.125);
  EXPECT_EQ(edge.constraint.covariance, map.graph.edges[2].constraint.covariance);
  EXPECT_EQ(edge.constraint.type, ConstraintType::kOdometry);
  EXPECT_EQ(again.graph.edges[0].constraint.type, ConstraintType::kLaser);
  EXPECT_EQ(again.graph.switchable_edges.at(0).switch_value, 0.75);
  EXPECT_EQ(again.incremental_results.at(2).target, 1U);
  EXPECT_EQ(again.incremental_results.at(2).T_target_id.x, 0.3);
  EXPECT_EQ(again.loop_results.at(0).inlier_ratio, 0.875);
  EXPECT_EQ(again.loop_results.at(0).target, 3U);
  // Bytes compare nan too, which no number equals.
  EXPECT_EQ(encode_map(again), encode_map(map));
}

TEST(Codec, KeepsLocations) {
  const std::vector<Location> again = decode_metadata(encode_metadata(make_map().locations), "");
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(again[1].name_space, "waypoints");
  EXPECT_EQ(again[1].id, "K\u00fcche");
  EXPECT_EQ(again[1].node_id, 3U);
  EXPECT_EQ(again[1].T_node_location.theta, -0.5);
}

TEST(Codec, KeepsAnEmptyMap) {
  const Map again = decode_map(encode_map({}), "");
  EXPECT_TRUE(again.graph.nodes.empty());
  EXPECT_TRUE(decode_metadata(encode_metadata({}), "").empty());
}

TEST(Codec, ReadsLargeMaps) {
  Map map;
  for (std::uint64_t k = 0; k < 400; ++k) {
    map.graph.nodes.push_back({k, {}});
    map.clouds.push_back({k, 0.0, std::vector<Point2>(2000, {1.25, 2.5, 1.0})});  // 77 MB unpacked
  }
  EXPECT_EQ(decode_map(encode_map(map), "").clouds[399].points.size(), 2000U);
}

TEST(Codec, SaysWhichFileIsTruncated) {
  const std::string bytes = encode_map(make_map());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string error = decode_error(bytes.substr(0, size));
    ASSERT_NE(error.find("home.map_capnp is damaged"), std::string::npos) << size << ": " << error;
  }
}

TEST(Codec, SurvivesChangedBytes) {
  const std::string bytes = encode_map(make_map());
  std::mt19937 engine(3);
  int refused = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::string damaged = bytes;
    for (int change = 0; change <= trial % 3; ++change) damaged[engine() % bytes.size()] = static_cast<char>(engine());
    try {
      const Map map = decode_map(damaged, "");
      if (find_defect(map)) ++refused;  // must not crash on it either
    } catch (const MapFileError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 5000);
}

TEST(Codec, RefusesWhatIsNotPackedOrNoMap) {
  EXPECT_NE(decode_error(plain_bytes(unpack(encode_map(make_map())))).find("unpacked"), std::string::npos);
  EXPECT_NE(decode_error("P5 this is a picture").find("damaged"), std::string::npos);
  EXPECT_NE(decode_error(encode_map(make_map()) + pack({1})).find("after the end"), std::string::npos);
}

TEST(Codec, RefusesTheOtherFilesRoot) {
  EXPECT_NE(decode_error(encode_metadata(make_map().locations)).find("mixed up"), std::string::npos);
  EXPECT_THROW(decode_metadata(encode_map(make_map()), ""), MapFileError);
}

TEST(Codec, SignsMaps) {
  const MapFormat format = decode_format(encode_map(make_map()), "");
  EXPECT_EQ(format.version, kFormatVersion);
  EXPECT_EQ(format.written_by.rfind("Oort ", 0), 0U);
  const MapFormat original = decode_format(encode_map(make_map(), true), "");
  EXPECT_EQ(original.version, kOriginalFormat);
  EXPECT_EQ(original.written_by, "");
}

TEST(Codec, TheFormatDoesNotChangeTheContent) {
  const Map again = decode_map(encode_map(make_map(), true), "");
  EXPECT_EQ(encode_map(again), encode_map(make_map()));
  EXPECT_LT(encode_map(again, true).size(), encode_map(again).size());
  EXPECT_EQ(decode_metadata(encode_metadata(make_map().locations, true), "").size(), 2U);
}

TEST(Codec, RefusesANewerFormatAsSuch) {
  Words words = unpack(encode_map(make_map()));
  ASSERT_EQ(words.at(2), kFormatVersion) << "the root's data follow the root pointer";
  words[2] = kFormatVersion + 1;
  const std::string bytes = pack(words), error = decode_error(bytes);
  EXPECT_EQ(decode_format(bytes, "").version, kFormatVersion + 1);
  const std::string words_of_it = "home.map_capnp has the map format " + std::to_string(kFormatVersion + 1);
  EXPECT_NE(error.find(words_of_it + ", written by Oort "), std::string::npos) << error;
  EXPECT_EQ(error.find("damaged"), std::string::npos) << error;
}

TEST(Codec, RefusesACovarianceThatIsNot3x3) {
  Words words = unpack(encode_map(make_map()));
  ASSERT_EQ(pack(words).size() > 0, true);
  for (std::uint64_t& word : words) {
    const std::uint64_t nine_doubles = 9U << 3U | 5U;  // the upper half of a pointer to a list of nine 8-byte values
    if (word >> 32U != nine_doubles) continue;
    word -= std::uint64_t{1} << 35U;
    break;
  }
  EXPECT_NE(decode_error(pack(words)).find("8 numbers instead of 9"), std::string::npos);
}

std::uint64_t struct_pointer(std::uint64_t offset, std::uint64_t data, std::uint64_t pointers) {
  return offset << 2U | data << 32U | pointers << 48U;
}
std::uint64_t composite_list_pointer(std::uint64_t offset, std::uint64_t words) {
  return 1U | offset << 2U | std::uint64_t{7} << 32U | words << 35U;
}

/// A map with `clouds` clouds that all refer to the same list of `points` points.
Words overlapping_clouds(std::uint64_t clouds, std::uint64_t points) {
  Words words = {struct_pointer(0, 0, 2),
                 0,
                 struct_pointer(0, 0, 3),  // Map2d, its SidecarDb
                 composite_list_pointer(2, clouds * 3),
                 0,
                 0,
                 struct_pointer(clouds, 2, 1)};
  const std::uint64_t list = words.size() + clouds * 3;
  for (std::uint64_t k = 0; k < clouds; ++k) {
    words.insert(words.end(), {k, 0});
    words.push_back(composite_list_pointer(list - words.size() - 1, points * 3));
  }
  words.push_back(struct_pointer(points, 3, 0));
  words.insert(words.end(), points * 3, 0);
  words.insert(words.begin(), words.size() << 32U);  // one segment
  return words;
}

TEST(Codec, RefusesPartsThatOverlap) {
  EXPECT_EQ(decode_map(pack(overlapping_clouds(1, 10)), "").clouds[0].points.size(), 10U) << "the builder works";
  EXPECT_NE(decode_error(pack(overlapping_clouds(1000, 10000))).find("damaged"), std::string::npos);
}

TEST(Codec, RefusesAFileThatUnpacksToMoreThanAMap) {
  std::string zeros;
  for (int i = 0; i < 600000; ++i) zeros += std::string("\0\xff", 2);  // 256 words of zeros each: 1.2 GB
  EXPECT_NE(decode_error(zeros).find("no map's size"), std::string::npos);
}

TEST(Defect, FindsWhatMakesAMapUnusable) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(find_defect(make_map()));
  EXPECT_FALSE(find_defect({}));
  const auto finds = [](const std::string& words, const std::function<void(Map&)>& change) {
    Map map = make_map();
    change(map);
    EXPECT_NE(find_defect(map).value_or("nothing").find(words), std::string::npos) << find_defect(map).value_or("-");
  };
  finds("node 2 has the id 5", [](Map& m) { m.graph.nodes[2].id = 5; });
  finds("pose of node 1", [](Map& m) { m.graph.nodes[1].pose.y = kNan; });
  finds("edge 1 refers to node 4", [](Map& m) { m.graph.edges[1].j = 4; });
  finds("edge 3 refers to node 9", [](Map& m) { m.graph.switchable_edges[0].i = 9; });
  finds("edge 0 refers to node 9", [](Map& m) { m.graph.edges[0].constraint.id = 9; });
  finds("edge 0 links node 1 to itself", [](Map& m) { m.graph.edges[0].i = 1; });
  finds("pose of edge 0", [](Map& m) { m.graph.edges[0].constraint.T_i_j.x = kNan; });
  finds("time of edge 0", [](Map& m) { m.graph.edges[0].constraint.time = kNan; });
  finds("covariance of edge 0 is not finite", [](Map& m) { m.graph.edges[0].constraint.covariance(0, 2) = kNan; });
  finds("negative variance", [](Map& m) { m.graph.edges[0].constraint.covariance(1, 1) = -1.0; });
  finds("switch of edge 3", [](Map& m) { m.graph.switchable_edges[0].switch_value = 1.5; });
  finds("switch of edge 3", [](Map& m) { m.graph.switchable_edges[0].switch_value = kNan; });
  finds("4 nodes but 3 clouds", [](Map& m) { testing::drop_last(m.clouds); });
  finds("cloud 1 belongs to node 0", [](Map& m) { testing::edit_cloud(m.clouds, 1, [](PointCloud& c) { c.id = 0; }); });
  finds("time of cloud 1", [](Map& m) { testing::edit_cloud(m.clouds, 1, [](PointCloud& c) { c.time = kNan; }); });
  finds("point of cloud 2",
        [](Map& m) { testing::edit_cloud(m.clouds, 2, [](PointCloud& c) { c.points[0].x = kNan; }); });
  finds("point of cloud 2",
        [](Map& m) { testing::edit_cloud(m.clouds, 2, [](PointCloud& c) { c.points[1].y = kNan; }); });
  finds("incremental result 1 refers", [](Map& m) { m.incremental_results[1].target = 4; });
  finds("pose of incremental result 1", [](Map& m) { m.incremental_results[1].T_local_id.theta = kNan; });
  finds("inlier ratio of incremental result 1", [](Map& m) { m.incremental_results[1].inlier_ratio = kNan; });
  finds("loop result 0 refers", [](Map& m) { m.loop_results[0].id = 4; });
  finds("pose of loop result 0", [](Map& m) { m.loop_results[0].T_id_target.x = kNan; });
  finds("'dock/dock' refers to node 4", [](Map& m) { m.locations[0].node_id = 4; });
  finds("location 'dock/dock'", [](Map& m) { m.locations[0].T_node_location.x = kNan; });
  finds("name holds a NUL", [](Map& m) { m.locations[0].id = std::string("do\0ck", 5); });
  finds("name is longer", [](Map& m) { m.locations[0].name_space = std::string(5000, 'x'); });
}

TEST(Defect, FindsCovariancesThatCannotBeUsed) {
  const auto defect_with = [](const std::function<void(Eigen::Matrix3d&)>& change, bool switchable) {
    Map map = make_map();
    change(switchable ? map.graph.switchable_edges[0].constraint.covariance : map.graph.edges[0].constraint.covariance);
    return find_defect(map).value_or("nothing");
  };
  for (const bool switchable : {false, true}) {
    const auto finds = [&](const std::string& words, const std::function<void(Eigen::Matrix3d&)>& change) {
      EXPECT_NE(defect_with(change, switchable).find(words), std::string::npos) << defect_with(change, switchable);
    };
    finds("not symmetric", [](auto& c) { c(0, 1) += 0.01; });
    finds("not positive definite", [](auto& c) { c(0, 1) = c(1, 0) = 1.0; });
    finds("not positive definite", [](auto& c) { c.setZero(); });
    finds("larger than any", [](auto& c) { c(0, 0) = 1e300; });
    finds("smaller than any", [](auto& c) { c = 1e-40 * Eigen::Matrix3d::Identity(); });
  }
}

TEST(Defect, FindsWhatIsOutOfReach) {
  const auto finds = [](const std::string& words, const std::function<void(Map&)>& change) {
    Map map = make_map();
    change(map);
    EXPECT_NE(find_defect(map).value_or("nothing").find(words), std::string::npos) << find_defect(map).value_or("-");
  };
  finds("pose of node 1", [](Map& m) { m.graph.nodes[1].pose.x = 1e17; });
  finds("pose of node 1", [](Map& m) { m.graph.nodes[1].pose.theta = 1e17; });
  finds("pose of edge 0", [](Map& m) { m.graph.edges[0].constraint.T_i_j.x = 1e9; });
  finds("pose of edge 3", [](Map& m) { m.graph.switchable_edges[0].constraint.T_i_j.y = 1e9; });
  finds("pose of incremental result 1", [](Map& m) { m.incremental_results[1].T_target_id.x = 1e9; });
  finds("pose of loop result 0", [](Map& m) { m.loop_results[0].T_id_target.x = 1e9; });
  finds("a return of cloud 2",
        [](Map& m) { testing::edit_cloud(m.clouds, 2, [](PointCloud& c) { c.points[0].x = 1e6; }); });
}

TEST(Codec, AReturnThatNoLaserCanSeeIsNone) {
  Map map = make_map();
  testing::edit_cloud(map.clouds, 2, [](PointCloud& c) { c.points[0] = {3e5, 3e5, 1.0}; });
  const Map read = decode_map(encode_map(map), "map");
  EXPECT_FALSE(read.clouds[2].points[0].is_return());
  EXPECT_TRUE(std::isinf(read.clouds[2].points[0].x));
  EXPECT_NEAR(read.clouds[2].points[0].y, M_PI / 4.0, 1e-12);
  EXPECT_FALSE(find_defect(read));
}

TEST(Error, TellsOfLongAndOddTextsInShort) {
  const std::string text = InputError("a" + std::string(1'000'000, 'b') + "c").what();
  EXPECT_LT(text.size(), 2000U);
  EXPECT_EQ(text.front(), 'a');
  EXPECT_EQ(text.back(), 'c');
  EXPECT_STREQ(InputError(std::string("K\xC3\xBC"
                                      "che\xFF\0!",
                                      9))
                   .what(),
               "K\xC3\xBC"
               "che?"
               "?!");
  EXPECT_STREQ(InputError("\xE2\x82\xAC \xED\xA0\x80 \xC0\x80").what(),
               "\xE2\x82\xAC ?"
               "?"
               "? ?"
               "?");
}

}  // namespace
}  // namespace oort
