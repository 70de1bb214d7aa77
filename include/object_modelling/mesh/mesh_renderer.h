#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "object_modelling/geometry/pinhole_camera.h"
#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::mesh
{
struct MeshView
{
  cv::Mat color_bgr;    ///< CV_8UC3; vertex colours lit by a lamp at the camera, `background` elsewhere
  cv::Mat depth_m;      ///< CV_32FC1, NaN where nothing is
  cv::Mat triangle_id;  ///< CV_32SC1, -1 where nothing is
};

/// Z-buffer rendering on the CPU, no display needed. Pixel centres as in PinholeCamera.
MeshView renderMesh(const TriangleMesh& mesh, const geometry::PinholeCamera& camera,
                    const Eigen::Isometry3d& T_camera_model, const cv::Scalar& background = { 255, 255, 255 });

/// One picture of four sides (0, 90, 180, 270 deg about z, seen from 25 deg above), z of the mesh up.
cv::Mat renderFourSides(const TriangleMesh& mesh, int tile_size_px = 480);

/// The mesh turned about z in `count` equal steps, seen from 25 deg above, side by side.
cv::Mat renderTurntable(const TriangleMesh& mesh, int count, int tile_size_px = 320);

}  // namespace object_modelling::mesh
