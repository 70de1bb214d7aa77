#pragma once

#include <vector>

#include "support/synthetic_scene.h"

namespace object_modelling::test_support
{
/// First surface that a viewing ray meets. The ray is (x, y, 1) in the camera frame, so its parameter is the depth.
struct Hit
{
  float depth_m = 0;       ///< 0: nothing
  int instance = 0;        ///< 0 table, i + 1 object i
  int face = 0;            ///< for the texture
  float a_m = 0, b_m = 0;  ///< place on the face
  Eigen::Vector3f n_camera = Eigen::Vector3f::Zero();
};

/// A scene seen from one place, prepared for many rays.
class SceneView
{
public:
  SceneView(const SyntheticScene& scene, const Eigen::Isometry3d& T_world_camera);
  Hit cast(const Eigen::Vector3f& ray_camera) const;

private:
  struct Body
  {
    Shape shape;
    Eigen::Vector3f half_size;
    Eigen::Matrix3f R_object_camera;
    Eigen::Vector3f t_object_camera;
    int instance;
    Eigen::Vector3f center_camera;
    float radius_squared;  ///< of the sphere round the body
  };

  void castTable(const Eigen::Vector3f& ray_camera, Hit* hit) const;
  static void castBox(const Body& body, const Eigen::Vector3f& ray_object, Hit* hit);
  static void castCylinder(const Body& body, const Eigen::Vector3f& ray_object, Hit* hit);
  static void castSphere(const Body& body, const Eigen::Vector3f& ray_object, Hit* hit);

  bool has_table_;
  float table_half_size_;
  Eigen::Matrix3f R_world_camera_;
  Eigen::Vector3f t_world_camera_;
  std::vector<Body> bodies_;
};

}  // namespace object_modelling::test_support
