#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "object_modelling/rgbd/keyframe.h"
#include "object_modelling/rgbd/view.h"
#include "support/procedural_texture.h"

namespace object_modelling::test_support
{
/// World frame: table top at z = 0, z up, metres.
enum class Shape
{
  BOX,       ///< size = edges
  CYLINDER,  ///< size = diameter, diameter, height; axis z
  SPHERE     ///< size = diameter, three times
};

struct SceneObject
{
  Shape shape = Shape::BOX;
  Eigen::Vector3d size_m{ 0.1, 0.1, 0.1 };
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();  ///< object frame: centre of the shape
  Texture texture;

  /// Distance from the surface, positive outside.
  double signedDistance_m(const Eigen::Vector3d& p_world) const;
};

/// An object that stands on the table at (x, y), turned by `yaw_rad` about the vertical.
SceneObject standingBox(const Eigen::Vector3d& size_m, double x_m = 0, double y_m = 0, double yaw_rad = 0,
                        std::uint32_t seed = 2);
SceneObject standingCylinder(double diameter_m, double height_m, double x_m = 0, double y_m = 0,
                             std::uint32_t seed = 3);
SceneObject standingSphere(double diameter_m, double x_m = 0, double y_m = 0, std::uint32_t seed = 4);

struct SyntheticScene
{
  bool has_table = true;
  double table_half_size_m = 0.6;  ///< square table; nothing beyond it (no depth)
  Texture table;
  std::vector<SceneObject> objects;
};

/// A textured table with a textured box of 80 x 120 x 200 mm in its middle: enough for most tests.
SyntheticScene boxOnTable();

/// What the sensor adds to the truth; by default nothing.
struct SensorNoise
{
  double depth_sigma_scale = 0;     ///< share of the axial sigma of Nguyen 2012 (1: a real Kinect)
  double depth_quantum_m = 0;       ///< step of the depth readings, e.g. 0.001
  int missing_edge_px = 0;          ///< no depth within this distance of a depth step
  double missing_ratio = 0;         ///< share of pixels without depth, anywhere
  double max_theta_rad = M_PI / 2;  ///< no depth where the surface is seen at a larger angle to its normal
  double color_sigma = 0;           ///< gray levels, of 255
  std::uint64_t seed = 1;           ///< give every frame of a sequence its own
};

/// What is at each pixel. Exact, whatever the noise.
struct SceneImage
{
  rgbd::Frame frame;  ///< object_mask: the first object
  cv::Mat instances;  ///< CV_8UC1: 0 nothing or table, i + 1 object i
  cv::Mat depth_m;    ///< CV_32FC1 without noise, NaN where there is nothing
  cv::Mat normals;    ///< CV_32FC3 in the camera frame, NaN where there is nothing
};

/// Ray-casts one image through the pixel centres.
SceneImage renderScene(const SyntheticScene& scene, const geometry::PinholeCamera& camera,
                       const Eigen::Isometry3d& T_world_camera, const SensorNoise& noise = {}, double stamp_s = 0);

/// The frame alone.
rgbd::Frame renderFrame(const SyntheticScene& scene, const geometry::PinholeCamera& camera,
                        const Eigen::Isometry3d& T_world_camera, const SensorNoise& noise = {}, double stamp_s = 0);

/// One keyframe per pose, with masks of the first object and exact poses; the session frame is the world frame. Noise
/// differs from keyframe to keyframe. No observations.
std::vector<rgbd::Keyframe> renderKeyframes(const SyntheticScene& scene, const geometry::PinholeCamera& camera,
                                            const std::vector<Eigen::Isometry3d>& T_world_cameras,
                                            const SensorNoise& noise = {});

/// The same as views.
std::vector<rgbd::View> renderViews(const SyntheticScene& scene, const geometry::PinholeCamera& camera,
                                    const std::vector<Eigen::Isometry3d>& T_world_cameras,
                                    const SensorNoise& noise = {});

/// 640 x 480, f = 525 px.
geometry::PinholeCamera vgaCamera();
/// The same at half the resolution: enough for most, and quick.
geometry::PinholeCamera smallCamera();

}  // namespace object_modelling::test_support
