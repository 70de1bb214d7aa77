#include "recognition_fixture.h"

#include <cmath>

#include "object_modelling/fusion/cloud_fusion.h"

namespace object_modelling::recognition
{
namespace
{
mesh::TriangleMesh boxMesh()
{
  mesh::TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d sign((corner & 1) - 0.5, ((corner >> 1) & 1) - 0.5, ((corner >> 2) & 1) - 0.5);
    mesh.vertices.push_back(sign.cwiseProduct(SIZE_M).cast<float>());
    mesh.colors.emplace_back(std::uint8_t{ 120 }, std::uint8_t{ 120 }, std::uint8_t{ 120 });
  }
  mesh.triangles = { { 0, 2, 1 }, { 1, 2, 3 }, { 4, 5, 6 }, { 5, 7, 6 }, { 0, 1, 4 }, { 1, 5, 4 },
                     { 2, 6, 3 }, { 3, 6, 7 }, { 0, 4, 2 }, { 2, 4, 6 }, { 1, 3, 5 }, { 3, 7, 5 } };
  mesh::computeNormals(&mesh);
  return mesh;
}
}  // namespace

Eigen::Isometry3d lookingAtTable(double angle_rad, double height_m)
{
  const Eigen::Vector3d eye(0.65 * std::cos(angle_rad), 0.65 * std::sin(angle_rad), height_m);
  const Eigen::Vector3d z = (Eigen::Vector3d(0, 0, 0.08) - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = eye;
  return T;
}

database::ObjectModel boxModel()
{
  test_support::SyntheticScene scene;
  scene.objects = { test_support::standingBox(SIZE_M, 0, 0, 0, TEXTURE_SEED) };
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 10; ++i)
    poses.push_back(lookingAtTable(2 * M_PI * i / 10, i % 2 == 0 ? 0.35 : 0.55));
  database::ObjectModel model;
  model.id = "box";
  model.views = test_support::renderViews(scene, test_support::vgaCamera(), poses);
  const Eigen::Isometry3d T_model_world = scene.objects[0].T_world_object.inverse();
  for (rgbd::View& view : model.views)
    rgbd::transform(T_model_world, &view);
  base::JobControl control;
  model.cloud = fusion::fuse(model.views, {}, control).cloud;
  model.mesh = boxMesh();
  model.box_model.size_m = SIZE_M;
  model.diameter_m = SIZE_M.norm();
  return model;
}

test_support::SyntheticScene boxBesideAnother(double yaw_rad)
{
  test_support::SyntheticScene scene;
  const test_support::SceneObject unknown = test_support::standingBox({ 0.1, 0.07, 0.05 }, -0.15, 0.1, 1, 9);
  scene.objects = { test_support::standingBox(SIZE_M, 0.05, -0.04, yaw_rad, TEXTURE_SEED), unknown };
  return scene;
}

rgbd::Frame noisyFrame(const test_support::SyntheticScene& scene, const Eigen::Isometry3d& T_world_camera)
{
  test_support::SensorNoise noise;
  noise.depth_sigma_scale = 1;
  noise.depth_quantum_m = 0.001;
  noise.color_sigma = 2;
  rgbd::Frame frame = test_support::renderFrame(scene, test_support::vgaCamera(), T_world_camera, noise);
  frame.object_mask = cv::Mat();  // a recogniser is given none
  return frame;
}

}  // namespace object_modelling::recognition
