// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <capnp/any.h>
#include <capnp/message.h>
#include <capnp/serialize-packed.h>
#include <kj/io.h>

#include "oort/geometry/errors.hpp"
#include "oort/storage/internal/codec.hpp"
#include "oort_map.capnp.h"

// The order in which the parts of a message are made decides where they lie in it. It is the original's order here, so
// that rewriting one of its maps gives its bytes.

namespace oort {
namespace {

void write(const Pose2& pose, capnp::Pose2d::Builder out) {
  out.setX(pose.x);
  out.setY(pose.y);
  out.setT(pose.theta);
}

void write(const Pose2& pose, const Eigen::Matrix3d& covariance, capnp::Pose2dCov::Builder out) {
  write(pose, out.initPose());
  auto values = out.initCov().initV(9);
  for (unsigned k = 0; k < 9; ++k) values.set(k, covariance(k / 3, k % 3));
}

/// Of an edge of either kind.
template <typename AnyEdge, typename Builder>
void write_edge(const AnyEdge& edge, Builder out) {
  out.setId(edge.id);
  out.setI(edge.i);
  out.setJ(edge.j);
  auto props = out.initProps();
  props.setTime(edge.constraint.time);
  props.setId(edge.constraint.id);
  write(edge.constraint.T_i_j, edge.constraint.covariance, props.initPose());
  using Type = capnp::Sensor2dConstraint::Type;
  props.setType(edge.constraint.type == ConstraintType::kLaser ? Type::LASER : Type::ODOM);
}

void write(const Graph& graph, capnp::Graph2d::Builder out) {
  auto nodes = out.initNodes(static_cast<unsigned>(graph.nodes.size()));
  for (unsigned k = 0; k < nodes.size(); ++k) {
    nodes[k].setId(graph.nodes[k].id);
    write(graph.nodes[k].pose, nodes[k].initPose());
  }
  auto edges = out.initEdges(static_cast<unsigned>(graph.edges.size()));
  for (unsigned k = 0; k < edges.size(); ++k) write_edge(graph.edges[k], edges[k]);
  auto switchable = out.initEdgesSwitch(static_cast<unsigned>(graph.switchable_edges.size()));
  for (unsigned k = 0; k < switchable.size(); ++k) {
    write_edge(graph.switchable_edges[k], switchable[k]);
    switchable[k].setSwitch(graph.switchable_edges[k].switch_value);
  }
}

void write(const PointCloud& cloud, capnp::PointCloud2d::Builder out) {
  out.setId(cloud.id);
  auto points = out.initPoints(static_cast<unsigned>(cloud.points.size()));
  for (unsigned k = 0; k < points.size(); ++k) {
    auto point = points[k];
    point.setX(cloud.points[k].x);
    point.setY(cloud.points[k].y);
    point.setZ(cloud.points[k].z);
  }
  out.setTime(cloud.time);
}

void write_sidecar(const Map& map, capnp::SidecarDb::Builder out) {
  auto clouds = out.initClouds(static_cast<unsigned>(map.clouds.size()));
  for (unsigned k = 0; k < clouds.size(); ++k) write(map.clouds[k], clouds[k]);
  auto incrs = out.initIncrs(static_cast<unsigned>(map.incremental_results.size()));
  for (unsigned k = 0; k < incrs.size(); ++k) {
    const IncrementalResult& result = map.incremental_results[k];
    incrs[k].setId(result.id);
    incrs[k].setTarget(result.target);
    write(result.T_local_id, result.covariance, incrs[k].initSmTid());
    write(result.T_target_id, incrs[k].initTargetTid());
    incrs[k].setHitPct(result.inlier_ratio);
  }
  auto loops = out.initLoops(static_cast<unsigned>(map.loop_results.size()));
  for (unsigned k = 0; k < loops.size(); ++k) {
    const LoopResult& result = map.loop_results[k];
    loops[k].setId(result.id);
    loops[k].setTarget(result.target);
    write(result.T_id_target, result.covariance, loops[k].initIdTtarget());
    loops[k].setHitPct(result.inlier_ratio);
  }
}

/// The root of a message that is as large as the published schema has it: without room for what was added since. Of
/// the added fields none may then be set.
template <typename Root>
typename Root::Builder init_original_root(::capnp::MessageBuilder& message, std::uint16_t pointers) {
  return message.getRoot<::capnp::AnyPointer>().initAsAnyStruct(0, pointers).as<Root>();
}

/// Runs `fill` on a new message and packs it.
template <typename Fill>
std::string packed(Fill&& fill) {
  try {
    ::capnp::MallocMessageBuilder message;
    fill(message);
    kj::VectorOutputStream stream;
    ::capnp::writePackedMessage(stream, message);
    const auto bytes = stream.getArray();
    return {reinterpret_cast<const char*>(bytes.begin()), bytes.size()};
  } catch (const kj::Exception& error) {
    throw MapFileError(std::string("the map cannot be put into the file format: ") + error.getDescription().cStr());
  }
}

}  // namespace

std::string encode_map(const Map& map, bool as_original) {
  return packed([&](::capnp::MessageBuilder& message) {
    auto root = as_original ? init_original_root<capnp::Map2d>(message, 2) : message.initRoot<capnp::Map2d>();
    write(map.graph, root.initGraph());
    write_sidecar(map, root.initSidecardb());
    if (as_original) return;
    root.setFormatVersion(kFormatVersion);
    root.setWrittenBy(writer_name());
  });
}

std::string encode_metadata(const std::vector<Location>& locations, bool as_original) {
  return packed([&](::capnp::MessageBuilder& message) {
    auto root =
        as_original ? init_original_root<capnp::Map2dMetadata>(message, 1) : message.initRoot<capnp::Map2dMetadata>();
    if (!as_original) root.setFormatVersion(kFormatVersion);
    auto list = root.initLocations(static_cast<unsigned>(locations.size()));
    for (unsigned k = 0; k < list.size(); ++k) {
      list[k].setNamespace(locations[k].name_space);
      list[k].setNodeid(locations[k].node_id);
      write(locations[k].T_node_location, list[k].initNTsensor());
      list[k].setUuid(locations[k].id);
    }
  });
}

}  // namespace oort
