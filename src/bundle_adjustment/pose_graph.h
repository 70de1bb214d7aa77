#pragma once

#include <array>
#include <vector>

#include "object_modelling/geometry/transform.h"

namespace object_modelling::bundle_adjustment
{
/// Relative pose of two keyframes, by index, with four points of the surface that both see. The error of the edge is
/// how far those points come apart: one unit for rotation and translation, and no lever arm from a far camera.
struct PoseEdge
{
  int a = -1, b = -1;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  std::array<Eigen::Vector3d, 4> points_b;
  double sigma_m = 0;  ///< allowance for the displacement of the points
};

/// Points of a surface patch of the given centre and radius: four corners of a tetrahedron.
std::array<Eigen::Vector3d, 4> patchCorners(const Eigen::Vector3d& center, double radius_m);

/// RMS displacement of the edge's points between its T_a_b and the poses.
double edgeError_m(const PoseEdge& edge, const std::vector<Eigen::Isometry3d>& T_session_camera);

/// Least squares over all edges; `fixed` stays, keyframes without edges too. Spreads the error of a loop over its
/// edges, which brings bundle adjustment within reach of its minimum.
void relaxPoseGraph(const std::vector<PoseEdge>& edges, int fixed, std::vector<Eigen::Isometry3d>* T_session_camera);

}  // namespace object_modelling::bundle_adjustment
