#include "object_modelling/mesh/mesh_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "object_modelling/base/status.h"
#include "sides_picture.h"

namespace object_modelling::mesh
{
namespace
{
constexpr double NEAR_M = 0.001;
constexpr float AMBIENT = 0.5f, BACK_SIDE = 0.5f;
const Eigen::Vector3f UNCOLORED_RGB(190, 190, 190);

struct Corner
{
  Eigen::Vector3d p_camera;
  Eigen::Vector3f rgb, n_camera;
};

Corner between(const Corner& a, const Corner& b, double share)
{
  const auto s = static_cast<float>(share);
  return { a.p_camera + share * (b.p_camera - a.p_camera), a.rgb + s * (b.rgb - a.rgb),
           a.n_camera + s * (b.n_camera - a.n_camera) };
}

/// Corners of the part of a triangle before the near plane: 0, 3 or 4.
int clipNear(const std::array<Corner, 3>& triangle, std::array<Corner, 4>* polygon)
{
  int count = 0;
  for (int i = 0; i < 3; ++i)
  {
    const Corner &a = triangle[i], &b = triangle[(i + 1) % 3];
    const bool a_inside = a.p_camera.z() >= NEAR_M, b_inside = b.p_camera.z() >= NEAR_M;
    if (a_inside)
      (*polygon)[count++] = a;
    if (a_inside != b_inside)
      (*polygon)[count++] = between(a, b, (NEAR_M - a.p_camera.z()) / (b.p_camera.z() - a.p_camera.z()));
  }
  return count;
}

double edge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p)
{
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

class Rasteriser
{
public:
  Rasteriser(const geometry::PinholeCamera& camera, MeshView* view) : camera_(camera), view_(view) {}

  /// Depth and colour are linear in the plane of the triangle, so 1/z and colour/z are linear in the image.
  void draw(const Corner& a, const Corner& b, const Corner& c, int triangle_id)
  {
    const std::array<const Corner*, 3> corners{ &a, &b, &c };
    std::array<Eigen::Vector2d, 3> pixels;
    for (int i = 0; i < 3; ++i)
      pixels[i] = camera_.project(corners[i]->p_camera);
    const double area = edge(pixels[0], pixels[1], pixels[2]);
    if (!(std::abs(area) > 0))
      return;
    const Eigen::Vector3d n_face = (b.p_camera - a.p_camera).cross(c.p_camera - a.p_camera);
    const bool back_side = n_face.dot(a.p_camera) > 0;

    const auto [u_min, u_max] = range(pixels[0].x(), pixels[1].x(), pixels[2].x(), camera_.width);
    const auto [v_min, v_max] = range(pixels[0].y(), pixels[1].y(), pixels[2].y(), camera_.height);
    for (int v = v_min; v <= v_max; ++v)
    {
      auto* depths_m = view_->depth_m.ptr<float>(v);
      for (int u = u_min; u <= u_max; ++u)
      {
        const Eigen::Vector2d p(u, v);
        std::array<double, 3> share;  // over z
        bool inside = true;
        for (int i = 0; i < 3 && inside; ++i)
        {
          share[i] = edge(pixels[(i + 1) % 3], pixels[(i + 2) % 3], p) / area;
          inside = share[i] >= 0;
          share[i] /= corners[i]->p_camera.z();
        }
        if (!inside)
          continue;
        const double z_m = 1 / (share[0] + share[1] + share[2]);
        if (depths_m[u] <= z_m)  // false for NaN
          continue;
        depths_m[u] = static_cast<float>(z_m);
        view_->triangle_id.at<int>(v, u) = triangle_id;
        Eigen::Vector3f rgb = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
        for (int i = 0; i < 3; ++i)
        {
          rgb += static_cast<float>(share[i] * z_m) * corners[i]->rgb;
          normal += static_cast<float>(share[i] * z_m) * corners[i]->n_camera;
        }
        view_->color_bgr.at<cv::Vec3b>(v, u) = shade(rgb, normal, camera_.unproject(u, v, 1), back_side);
      }
    }
  }

private:
  static std::pair<int, int> range(double a, double b, double c, int size)
  {
    const double low = std::clamp(std::min({ a, b, c }), 0.0, static_cast<double>(size));
    const double high = std::clamp(std::max({ a, b, c }), -1.0, static_cast<double>(size - 1));
    return { static_cast<int>(std::ceil(low)), static_cast<int>(std::floor(high)) };
  }

  static cv::Vec3b shade(const Eigen::Vector3f& rgb, const Eigen::Vector3f& normal, const Eigen::Vector3d& ray,
                         bool back_side)
  {
    const float cosine = std::abs(normal.normalized().dot(ray.cast<float>().normalized()));
    const float light = (AMBIENT + (1 - AMBIENT) * cosine) * (back_side ? BACK_SIDE : 1.f);
    const auto byte = [&](int channel)
    { return static_cast<unsigned char>(std::clamp(light * rgb[channel] + 0.5f, 0.f, 255.f)); };
    return { byte(2), byte(1), byte(0) };
  }

  const geometry::PinholeCamera& camera_;
  MeshView* view_;
};

}  // namespace

MeshView renderMesh(const TriangleMesh& mesh, const geometry::PinholeCamera& camera,
                    const Eigen::Isometry3d& T_camera_model, const cv::Scalar& background)
{
  const std::vector<std::string> violations = camera.violations();
  if (!violations.empty())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "cannot render: " + violations.front());
  MeshView view;
  const cv::Size size(camera.width, camera.height);
  view.color_bgr = cv::Mat(size, CV_8UC3, background);
  view.depth_m = cv::Mat(size, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  view.triangle_id = cv::Mat(size, CV_32SC1, cv::Scalar(-1));

  const Eigen::Matrix3f R_camera_model = T_camera_model.linear().cast<float>();
  const auto corner_at = [&](std::uint32_t vertex)
  {
    Corner corner;
    corner.p_camera = T_camera_model * mesh.vertices[vertex].cast<double>();
    corner.rgb = mesh.colors.empty() ? UNCOLORED_RGB : Eigen::Vector3f(mesh.colors[vertex].cast<float>());
    corner.n_camera = mesh.normals.empty() ? Eigen::Vector3f(Eigen::Vector3f::Zero())
                                           : Eigen::Vector3f(R_camera_model * mesh.normals[vertex]);
    return corner;
  };
  Rasteriser rasteriser(camera, &view);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    const auto& triangle = mesh.triangles[t];
    std::array<Corner, 3> corners{ corner_at(triangle[0]), corner_at(triangle[1]), corner_at(triangle[2]) };
    if (mesh.normals.empty())
    {
      const Eigen::Vector3d n =
          (corners[1].p_camera - corners[0].p_camera).cross(corners[2].p_camera - corners[0].p_camera);
      for (Corner& corner : corners)
        corner.n_camera = n.normalized().cast<float>();
    }
    std::array<Corner, 4> polygon;
    const int count = clipNear(corners, &polygon);
    for (int k = 2; k < count; ++k)
      rasteriser.draw(polygon[0], polygon[k - 1], polygon[k], static_cast<int>(t));
  }
  return view;
}

namespace
{
cv::Mat renderSides(const TriangleMesh& mesh, int count, int columns, int tile_size_px)
{
  return drawSides(mesh, count, columns, tile_size_px,
                   [&](const geometry::PinholeCamera& camera, const Eigen::Isometry3d& T_camera_model)
                   { return renderMesh(mesh, camera, T_camera_model).color_bgr; });
}
}  // namespace

cv::Mat renderFourSides(const TriangleMesh& mesh, int tile_size_px)
{
  return renderSides(mesh, 4, 2, tile_size_px);
}

cv::Mat renderTurntable(const TriangleMesh& mesh, int count, int tile_size_px)
{
  return renderSides(mesh, count, count, tile_size_px);
}

}  // namespace object_modelling::mesh
