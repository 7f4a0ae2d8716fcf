// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
// Map files. An input is an unpacked message, which is packed before it is read, so that changed numbers and pointers
// get in; one that begins with 0xFF is taken as packed already. Whatever loads is used in every way that a map can be.
#include <capnp/serialize-packed.h>
#include <kj/io.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include "oort/geometry/errors.hpp"
#include "oort/localization/localizer.hpp"
#include "oort/map/map_check.hpp"
#include "oort/mapper/mapper.hpp"
#include "oort/merging/merge.hpp"
#include "oort/render/render.hpp"
#include "oort/storage/internal/codec.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace oort {
namespace {

std::string packed(const std::uint8_t* data, std::size_t size) {
  kj::VectorOutputStream stream;
  {
    kj::BufferedOutputStreamWrapper buffer(stream);
    ::capnp::_::PackedOutputStream packing(buffer);
    packing.write(data, size);
  }
  const auto bytes = stream.getArray();
  return {reinterpret_cast<const char*>(bytes.begin()), bytes.size()};
}

/// What a robot sees in a room of 4 m by 3 m.
LaserScan scan(int k) {
  LaserScan scan{10.0 + k, -1.5, 0.1, 0.05, 10.0, {}};
  for (int i = 0; i < 30; ++i) {
    const double bearing = -1.5 + 0.1 * i;
    const double to_x = 2.0 / std::max(std::cos(bearing), 1e-3);
    const double to_y = 1.5 / std::max(std::abs(std::sin(bearing)), 1e-3);
    scan.ranges.push_back(static_cast<float>(std::min(to_x, to_y)));
  }
  return scan;
}

template <typename Work>
void refusing_is_allowed(Work&& work) {
  try {
    work();
  } catch (const InputError&) {
  } catch (const StateError&) {
  }
}

void go_on(const Map& map, const Parameters& parameters) {
  Mapper mapper(parameters);
  mapper.set_map(map);
  mapper.begin_session({0.0, 0.0, 0.0});
  for (int k = 0; k < 4; ++k) mapper.add_scan(scan(k), {0.3 * k, 0.0, 0.2 * k});
  mapper.notify_docked();
  mapper.finish();
  if (const auto defect = find_defect(mapper.map())) {
    std::fprintf(stderr, "what comes of a sound map is not: %s\n", defect->c_str());
    std::abort();
  }
}

void use(const Map& map) {
  Parameters parameters;
  parameters.global_slam_thread = false;
  parameters.min_pointcloud_size = 5;
  refusing_is_allowed([&] { render(map, parameters); });
  if (map.graph.nodes.empty()) return;
  refusing_is_allowed([&] { go_on(map, parameters); });
  refusing_is_allowed([&] {
    Localizer localizer(std::make_shared<ReferenceMap>(map, parameters), parameters, {});
    for (int k = 0; k < 4; ++k) localizer.add_scan(scan(k), {0.3 * k, 0.0, 0.2 * k});
  });
  if (map.graph.nodes.size() <= 6) refusing_is_allowed([&] { merge_maps(map, map, parameters); });
}

void try_one(const std::uint8_t* data, std::size_t size) {
  const bool is_packed = size > 0 && data[0] == 0xFF;
  const std::string bytes =
      is_packed ? std::string(reinterpret_cast<const char*>(data) + 1, size - 1) : packed(data, size / 8 * 8);
  Map map;
  try {
    map = decode_map(bytes, "map");
    map.locations = decode_metadata(encode_metadata(map.locations), "metadata");
  } catch (const MapFileError&) {
    return;
  }
  if (map.graph.nodes.size() > 40 || find_defect(map)) return;
  const std::string saved = encode_map(map);
  if (encode_map(decode_map(saved, "map")) != saved) std::abort();  // saved, loaded and migrated
  use(map);
}

const double kOdd[] = {0.0,
                       -0.0,
                       1.0,
                       -1.0,
                       1e-313,
                       5e-324,
                       1e-9,
                       1e-3,
                       3.2,
                       -3.2,
                       149.0,
                       151.0,
                       410.0,
                       1e5,
                       1e6,
                       1e9,
                       1e17,
                       1e154,
                       1e300,
                       -1e300,
                       1.7e308,
                       std::numeric_limits<double>::infinity(),
                       -std::numeric_limits<double>::infinity(),
                       std::numeric_limits<double>::quiet_NaN()};

}  // namespace
}  // namespace oort

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  oort::try_one(data, size);
  return 0;
}

/// Half of the mutations put an odd number in the place of a word: by chance alone that is seldom found.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  if (size < 16 || seed % 2 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::size_t words = size / 8;
  for (unsigned n = 0; n <= seed % 3; ++n) {
    const std::size_t word = (seed / 7 + n * 2654435761U) % words;
    const double odd = oort::kOdd[(seed / 64 + n) % (sizeof(oort::kOdd) / sizeof(double))];
    const std::size_t from = (seed / 5 + n * 40503U) % words;
    if (seed % 5 == 0) {
      std::memmove(data + 8 * word, data + 8 * from, 8);
    } else {
      std::memcpy(data + 8 * word, &odd, 8);
    }
  }
  return size;
}
