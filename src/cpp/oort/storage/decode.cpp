// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <capnp/any.h>
#include <capnp/message.h>
#include <capnp/serialize-packed.h>
#include <kj/io.h>

#include <cmath>
#include <limits>
#include <new>

#include "oort/geometry/errors.hpp"
#include "oort/geometry/tuning.hpp"
#include "oort/storage/internal/codec.hpp"
#include "oort/storage/tuning.hpp"
#include "oort_map.capnp.h"

namespace oort {
namespace {

Pose2 read(capnp::Pose2d::Reader in) {
  return {in.getX(), in.getY(), in.getT()};
}

void read(capnp::Pose2dCov::Reader in, Pose2& pose, Eigen::Matrix3d& covariance) {
  pose = read(in.getPose());
  const auto values = in.getCov().getV();
  if (values.size() != 9) {
    throw MapFileError("a covariance has " + std::to_string(values.size()) + " numbers instead of 9");
  }
  for (unsigned k = 0; k < 9; ++k) covariance(k / 3, k % 3) = values[k];
}

/// Of an edge of either kind.
template <typename AnyEdge, typename Reader>
AnyEdge read_edge(Reader in) {
  AnyEdge edge;
  edge.id = in.getId();
  edge.i = in.getI();
  edge.j = in.getJ();
  const auto props = in.getProps();
  edge.constraint.time = props.getTime();
  edge.constraint.id = props.getId();
  read(props.getPose(), edge.constraint.T_i_j, edge.constraint.covariance);
  switch (props.getType()) {
    case capnp::Sensor2dConstraint::Type::LASER:
      edge.constraint.type = ConstraintType::kLaser;
      return edge;
    case capnp::Sensor2dConstraint::Type::ODOM:
      edge.constraint.type = ConstraintType::kOdometry;
      return edge;
  }
  throw MapFileError("edge " + std::to_string(edge.id) + " is of an unknown type");
}

Graph read(capnp::Graph2d::Reader in) {
  Graph graph;
  for (const auto node : in.getNodes()) graph.nodes.push_back({node.getId(), read(node.getPose())});
  for (const auto edge : in.getEdges()) graph.edges.push_back(read_edge<Edge>(edge));
  for (const auto edge : in.getEdgesSwitch()) {
    graph.switchable_edges.push_back(read_edge<SwitchableEdge>(edge));
    graph.switchable_edges.back().switch_value = edge.getSwitch();
  }
  return graph;
}

/// Maps of before readings had a limit may hold returns that no laser can see: as to_point_cloud() has them now.
Point2 within_reach(const Point2& point) {
  const bool is_far = std::hypot(point.x, point.y) > GeometryTuning::kMaxRange;
  if (!point.is_return() || !std::isfinite(point.x) || !std::isfinite(point.y) || !is_far) return point;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  return {std::numeric_limits<double>::infinity(), std::atan2(point.y, point.x), kNan};
}

PointCloud read(capnp::PointCloud2d::Reader in) {
  PointCloud cloud;
  cloud.id = in.getId();
  cloud.time = in.getTime();
  const auto points = in.getPoints();
  cloud.points.reserve(points.size());
  for (const auto point : points) cloud.points.push_back(within_reach({point.getX(), point.getY(), point.getZ()}));
  return cloud;
}

void read_sidecar(capnp::SidecarDb::Reader in, Map& map) {
  for (const auto cloud : in.getClouds()) map.clouds.push_back(read(cloud));
  for (const auto incr : in.getIncrs()) {
    IncrementalResult& result = map.incremental_results.emplace_back();
    result.id = incr.getId();
    result.target = incr.getTarget();
    read(incr.getSmTid(), result.T_local_id, result.covariance);
    result.T_target_id = read(incr.getTargetTid());
    result.inlier_ratio = incr.getHitPct();
  }
  for (const auto loop : in.getLoops()) {
    LoopResult& result = map.loop_results.emplace_back();
    result.id = loop.getId();
    result.target = loop.getTarget();
    read(loop.getIdTtarget(), result.T_id_target, result.covariance);
    result.inlier_ratio = loop.getHitPct();
  }
}

/// How many words a packed file unpacks to. It can hold a thousand times its size in zeros: what no map is, is refused.
std::size_t unpacked_words(kj::ArrayPtr<const kj::byte> input) {
  const std::size_t count = ::capnp::computeUnpackedSizeInWords(input);
  const std::size_t plausible = StorageTuning::kMaxPacking * input.size() / sizeof(::capnp::word) + 4096;
  if (count == 0 || count > StorageTuning::kMaxWords || count > plausible) {
    throw MapFileError("it unpacks to " + std::to_string(count) + " words, which is no map's size");
  }
  return count;
}

/// Unpacks a message and runs `read_root` on its root, which has at least `root_pointers` pointers.
template <typename Root, typename ReadRoot>
void read_message(const std::string& bytes, unsigned root_pointers, ReadRoot&& read_root) {
  const kj::ArrayPtr<const kj::byte> input(reinterpret_cast<const kj::byte*>(bytes.data()), bytes.size());
  ::capnp::ReaderOptions limits;
  // Everything is read once. More is a message whose parts overlap, made to look larger than it is.
  limits.traversalLimitInWords = 2 * unpacked_words(input) + 64;
  kj::ArrayInputStream stream(input);
  {
    ::capnp::PackedMessageReader message(stream, limits);
    if (message.getRoot<::capnp::AnyStruct>().getPointerSection().size() < root_pointers) {
      throw MapFileError("its root is not the expected one; are the map and the metadata file mixed up?");
    }
    read_root(message.getRoot<Root>());
  }
  if (stream.tryGetReadBuffer().size() != 0) throw MapFileError("there are bytes after the end of the message");
}

/// A message of a version that is not known yet is whole: what keeps it from being read is no damage.
struct UnknownFormat : MapFileError {
  using MapFileError::MapFileError;
};

MapFormat format_of(capnp::Map2d::Reader root) {
  return {root.getFormatVersion(), root.getWrittenBy()};
}

void check_format(const MapFormat& format, const std::string& file) {
  try {
    require_known_format(format, file);
  } catch (const MapFileError& error) {
    throw UnknownFormat(error.what());
  }
}

/// read_message(), in which whatever goes wrong becomes a MapFileError that names the file.
template <typename Root, typename ReadRoot>
void decode(const std::string& bytes, const std::string& file, unsigned root_pointers, ReadRoot&& read_root) {
  const auto failed = [&file](const std::string& why) {
    return MapFileError(file + " is damaged or no map file: " + why +
                        "; restore it from a copy (an unpacked file must be packed first)");
  };
  try {
    read_message<Root>(bytes, root_pointers, read_root);
  } catch (const kj::Exception& error) {
    throw failed(error.getDescription().cStr());
  } catch (const UnknownFormat&) {
    throw;
  } catch (const MapFileError& error) {
    throw failed(error.what());
  } catch (const std::bad_alloc&) {
    throw failed("it needs more memory than there is");
  }
}

}  // namespace

Map decode_map(const std::string& bytes, const std::string& file) {
  Map map;
  decode<capnp::Map2d>(bytes, file, 2, [&](capnp::Map2d::Reader root) {
    check_format(format_of(root), file);
    map.graph = read(root.getGraph());
    read_sidecar(root.getSidecardb(), map);
  });
  return map;
}

std::vector<Location> decode_metadata(const std::string& bytes, const std::string& file) {
  std::vector<Location> locations;
  decode<capnp::Map2dMetadata>(bytes, file, 1, [&](capnp::Map2dMetadata::Reader root) {
    check_format({root.getFormatVersion(), ""}, file);
    for (const auto location : root.getLocations()) {
      locations.push_back(
          {location.getNamespace(), location.getUuid(), location.getNodeid(), read(location.getNTsensor())});
    }
  });
  return locations;
}

MapFormat decode_format(const std::string& bytes, const std::string& file) {
  MapFormat format;
  decode<capnp::Map2d>(bytes, file, 2, [&](capnp::Map2d::Reader root) { format = format_of(root); });
  return format;
}

}  // namespace oort
