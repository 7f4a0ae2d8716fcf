// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// All that a program needs that embeds Oort. What lies in a folder `internal` is not installed and may change at any
/// time; other headers of the rooms are installed because these include them.
#include "oort/geometry/errors.hpp"             // Error and its kinds
#include "oort/geometry/point_cloud.hpp"        // LaserScan
#include "oort/geometry/pose2.hpp"              // Pose2
#include "oort/geometry/sweep.hpp"              // Sweep
#include "oort/localization/localizer.hpp"      // Localizer
#include "oort/localization/reference_map.hpp"  // ReferenceMap
#include "oort/localization/relocalizer.hpp"    // Relocalizer
#include "oort/map/locations.hpp"               // named places of a Map
#include "oort/map/map.hpp"                     // Map
#include "oort/mapper/mapper.hpp"               // Mapper
#include "oort/merging/merge.hpp"               // merge_maps
#include "oort/odometry/gyro_odometry.hpp"      // GyroOdometry
#include "oort/odometry/odometry_buffer.hpp"    // OdometryBuffer
#include "oort/parameters/parameter_file.hpp"   // read_parameters
#include "oort/parameters/table.hpp"            // set_parameter
#include "oort/render/render.hpp"               // render
#include "oort/storage/map_file.hpp"            // save_map, load_map
