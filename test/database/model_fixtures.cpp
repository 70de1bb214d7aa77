#include "model_fixtures.h"

#include <filesystem>

#include "object_modelling/base/atomic_file.h"
#include "support/synthetic_scene.h"

namespace object_modelling::database
{
namespace
{
namespace fs = std::filesystem;

const Eigen::Vector3d SIZE_M(0.08, 0.12, 0.2);

Eigen::Isometry3d lookingAtOrigin(double angle_rad)
{
  const Eigen::Vector3d eye(0.7 * std::cos(angle_rad), 0.7 * std::sin(angle_rad), 0.5);
  const Eigen::Vector3d z = -eye.normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = eye;
  return T;
}

mesh::TriangleMesh boxMesh()
{
  mesh::TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d sign((corner & 1) - 0.5, ((corner >> 1) & 1) - 0.5, ((corner >> 2) & 1) - 0.5);
    mesh.vertices.push_back(sign.cwiseProduct(SIZE_M).cast<float>());
    mesh.colors.emplace_back(static_cast<std::uint8_t>(30 * corner), 100, 200);
  }
  mesh.triangles = { { 0, 2, 1 }, { 1, 2, 3 }, { 4, 5, 6 }, { 5, 7, 6 }, { 0, 1, 4 }, { 1, 5, 4 },
                     { 2, 6, 3 }, { 3, 6, 7 }, { 0, 4, 2 }, { 2, 4, 6 }, { 1, 3, 5 }, { 3, 7, 5 } };
  mesh::computeNormals(&mesh);
  return mesh;
}
}  // namespace

ObjectModel makeModel(const std::string& id, int variant, int view_count)
{
  ObjectModel model;
  model.id = id;
  model.name = "Cereal: \"crunchy\" #" + std::to_string(variant);
  Eigen::Isometry3d T_model_session = Eigen::Isometry3d::Identity();
  T_model_session.rotate(Eigen::AngleAxisd(1.0 / 3, Eigen::Vector3d(1, 2, 3).normalized()))
      .pretranslate(Eigen::Vector3d(0.1, -0.2, 1.0 / 7));
  model.sessions = { { "first", T_model_session, view_count }, { "second", Eigen::Isometry3d::Identity(), 0 } };
  model.box_model.size_m = SIZE_M;
  model.diameter_m = SIZE_M.norm();
  model.T_support_model = { T_model_session };
  model.quality = { { "mean_sigma_m", 0.00041 }, { "residual_px", std::nan("") } };
  model.provenance = { { "recording", "a: b\nc" }, { "version", "1.10" } };
  for (int i = 0; i < 500; ++i)
  {
    model.cloud.points.emplace_back(0.001f * static_cast<float>(i), 0.04f, 0.01f * static_cast<float>(variant));
    model.cloud.normals.emplace_back(0.0f, 1.0f, 0.0f);
    model.cloud.colors.emplace_back(static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(255 - i % 256), 7);
    model.cloud.weights.push_back(0.5f + static_cast<float>(i));
    model.cloud.sigmas_m.push_back(0.0003f);
  }
  model.mesh = boxMesh();
  model.preview_bgr = cv::Mat(40, 60, CV_8UC3, cv::Scalar(10, 200, variant));
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < view_count; ++i)
    poses.push_back(lookingAtOrigin(0.4 * i));
  model.views = test_support::renderViews(test_support::boxOnTable(), test_support::vgaCamera(), poses);
  return model;
}

std::map<std::string, std::string> contentsOf(const std::string& folder)
{
  std::map<std::string, std::string> contents;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      contents[entry.path().lexically_relative(folder).string()] = base::readTextFile(entry.path().string());
  return contents;
}

}  // namespace object_modelling::database
