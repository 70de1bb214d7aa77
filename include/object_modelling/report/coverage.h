#pragma once

#include <array>
#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::report
{
constexpr int AZIMUTH_BINS = 24, ELEVATION_BINS = 12;  ///< 15 degrees each
constexpr double VIEW_CONE_RAD = 0.5235987755982988;   ///< 30 degrees: a view counts for the directions this near
constexpr int WELL_SEEN_VIEWS = 3;

/// From where the object has been looked at, and how much of its mesh the views saw.
struct Coverage
{
  /// Views per direction from the object's centre, [elevation][azimuth]: row 0 straight down (-90 to -75 deg),
  /// column 0 from the object's x axis to 15 deg.
  std::array<std::array<int, AZIMUTH_BINS>, ELEVATION_BINS> view_counts{};
  double direction_ratio = 0;        ///< share of the sphere of directions with a view, by area
  double upper_direction_ratio = 0;  ///< the same of its upper half
  double seen_ratio = 0;             ///< share of the mesh's vertices that a view saw
  double well_seen_ratio = 0;        ///< ... that WELL_SEEN_VIEWS views saw
};

/// The world of the views is the mesh's frame, with the object's centre at its origin. A vertex counts as seen where
/// a view's depth agrees with it within 5 mm, and at no flatter an angle than 80 degrees.
Coverage coverageOf(const mesh::TriangleMesh& mesh, const std::vector<rgbd::View>& views);

}  // namespace object_modelling::report
