#pragma once

#include <functional>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "object_modelling/geometry/pinhole_camera.h"
#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::mesh
{
/// Picture of the model as one camera sees it.
using DrawView = std::function<cv::Mat(const geometry::PinholeCamera& camera, const Eigen::Isometry3d& T_camera_model)>;

/// `count` sides of the mesh in tiles, `columns` beside each other, each drawn by `draw`; see renderFourSides and
/// renderTurntable.
cv::Mat drawSides(const TriangleMesh& mesh, int count, int columns, int tile_size_px, const DrawView& draw);

}  // namespace object_modelling::mesh
