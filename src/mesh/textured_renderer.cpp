#include "object_modelling/mesh/textured_renderer.h"

#include <string>

#include <opencv2/imgproc.hpp>

#include "object_modelling/base/status.h"
#include "object_modelling/geometry/image_sampling.h"
#include "sides_picture.h"

namespace object_modelling::mesh
{
namespace
{
/// Place on the triangle's texture where a viewing ray (camera frame) meets its plane.
Eigen::Vector2f texelOnRay(const TexturedMesh& textured, int triangle, const Eigen::Isometry3d& T_camera_model,
                           const Eigen::Vector3d& ray)
{
  const auto& [ia, ib, ic] = textured.mesh.triangles[triangle];
  const Eigen::Vector3d a = T_camera_model * textured.mesh.vertices[ia].cast<double>();
  const Eigen::Vector3d b = T_camera_model * textured.mesh.vertices[ib].cast<double>();
  const Eigen::Vector3d c = T_camera_model * textured.mesh.vertices[ic].cast<double>();
  // Volumes of the tetrahedra between ray and edges are in the ratio of the shares.
  Eigen::Vector3d shares(ray.dot(b.cross(c)), ray.dot(c.cross(a)), ray.dot(a.cross(b)));
  shares /= shares.sum();
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  for (int k = 0; k < 3; ++k)
    uv += static_cast<float>(shares[k]) * textured.uvs[triangle][k];
  return textured.texel(uv);
}
}  // namespace

MeshView renderTexturedMesh(const TexturedMesh& textured, const geometry::PinholeCamera& camera,
                            const Eigen::Isometry3d& T_camera_model, int samples_per_side, const cv::Scalar& background)
{
  if (samples_per_side < 1)
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "samples_per_side = " + std::to_string(samples_per_side) + ": must be at least 1");
  MeshView view = renderMesh(textured.mesh, camera, T_camera_model, background);
  const geometry::PinholeCamera fine_camera = camera.scaled(samples_per_side);
  const MeshView fine = samples_per_side == 1 ? view : renderMesh(textured.mesh, fine_camera, T_camera_model);
  cv::Mat color(fine.triangle_id.size(), CV_8UC3, background);
#pragma omp parallel for schedule(dynamic, 16)
  for (int v = 0; v < color.rows; ++v)
    for (int u = 0; u < color.cols; ++u)
    {
      const int triangle = fine.triangle_id.at<int>(v, u);
      if (triangle < 0)
        continue;
      const Eigen::Vector3f bgr = geometry::colorAt(
          textured.texture_bgr, texelOnRay(textured, triangle, T_camera_model, fine_camera.unproject(u, v, 1)));
      for (int c = 0; c < 3; ++c)
        color.at<cv::Vec3b>(v, u)[c] = cv::saturate_cast<std::uint8_t>(bgr[c]);
    }
  cv::resize(color, view.color_bgr, view.color_bgr.size(), 0, 0, cv::INTER_AREA);
  return view;
}

namespace
{
cv::Mat renderSides(const TexturedMesh& textured, int count, int columns, int tile_size_px)
{
  return drawSides(textured.mesh, count, columns, tile_size_px,
                   [&](const geometry::PinholeCamera& camera, const Eigen::Isometry3d& T_camera_model)
                   { return renderTexturedMesh(textured, camera, T_camera_model).color_bgr; });
}
}  // namespace

cv::Mat renderFourSides(const TexturedMesh& textured, int tile_size_px)
{
  return renderSides(textured, 4, 2, tile_size_px);
}

cv::Mat renderTurntable(const TexturedMesh& textured, int count, int tile_size_px)
{
  return renderSides(textured, count, count, tile_size_px);
}

}  // namespace object_modelling::mesh
