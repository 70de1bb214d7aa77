#include "object_modelling/mesh/mesh_renderer.h"

#include <cmath>

#include <gtest/gtest.h>

#include "object_modelling/base/status.h"

namespace object_modelling::mesh
{
namespace
{
geometry::PinholeCamera smallCamera()
{
  geometry::PinholeCamera camera;
  camera.width = 64;
  camera.height = 48;
  camera.fx = camera.fy = 50;
  camera.cx = 31.5;
  camera.cy = 23.5;
  return camera;
}

/// Triangle that faces a camera at the origin, at the depths given for its corners.
TriangleMesh triangle(float z_a, float z_b, float z_c)
{
  TriangleMesh mesh;
  mesh.vertices = { { -0.3f * z_a, -0.2f * z_a, z_a }, { 0, 0.3f * z_b, z_b }, { 0.3f * z_c, -0.2f * z_c, z_c } };
  mesh.triangles = { { 0, 1, 2 } };
  return mesh;
}

MeshView render(const TriangleMesh& mesh)
{
  return renderMesh(mesh, smallCamera(), Eigen::Isometry3d::Identity());
}

TEST(MeshRenderer, DepthOfATiltedTriangleIsThatOfItsPlane)
{
  const TriangleMesh mesh = triangle(1, 2, 1.5f);
  const Eigen::Vector3d a = mesh.vertices[0].cast<double>(), b = mesh.vertices[1].cast<double>(),
                        c = mesh.vertices[2].cast<double>();
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const MeshView view = render(mesh);
  int covered = 0;
  for (int v = 0; v < 48; ++v)
  {
    for (int u = 0; u < 64; ++u)
    {
      const bool inside = view.triangle_id.at<int>(v, u) == 0;
      EXPECT_EQ(inside, std::isfinite(view.depth_m.at<float>(v, u)));
      if (!inside)
        continue;
      ++covered;
      const Eigen::Vector3d ray = smallCamera().unproject(u, v, 1);
      EXPECT_NEAR(view.depth_m.at<float>(v, u), n.dot(a) / n.dot(ray), 1e-5);
    }
  }
  EXPECT_NEAR(covered, 0.5 * 30 * 25, 15);  // half of base times height, in px
}

TEST(MeshRenderer, TheNearerOfTwoIsSeenWhateverTheOrder)
{
  for (const bool near_first : { true, false })
  {
    TriangleMesh mesh = triangle(1, 1, 1);
    const TriangleMesh other = triangle(2, 2, 2);
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    mesh.colors.assign(6, { 255, 0, 0 });
    std::fill(mesh.colors.begin() + 3, mesh.colors.end(), Eigen::Matrix<std::uint8_t, 3, 1>(0, 0, 255));
    mesh.triangles = near_first ? decltype(mesh.triangles){ { 0, 1, 2 }, { 3, 4, 5 } }
                                : decltype(mesh.triangles){ { 3, 4, 5 }, { 0, 1, 2 } };
    const MeshView view = render(mesh);
    EXPECT_FLOAT_EQ(view.depth_m.at<float>(23, 31), 1);
    EXPECT_EQ(view.triangle_id.at<int>(23, 31), near_first ? 0 : 1);
    EXPECT_GT(view.color_bgr.at<cv::Vec3b>(23, 31)[2], 100);
    EXPECT_EQ(view.color_bgr.at<cv::Vec3b>(23, 31)[0], 0);
  }
}

TEST(MeshRenderer, PixelCentersDecideCoverage)
{
  // A square over the centres of the pixels 10..12 x 20..22, a quarter of a pixel beyond them.
  const geometry::PinholeCamera camera = smallCamera();
  TriangleMesh mesh;
  for (const auto& [u, v] : { std::pair{ 9.75, 19.75 }, { 9.75, 22.25 }, { 12.25, 22.25 }, { 12.25, 19.75 } })
    mesh.vertices.push_back(camera.unproject(u, v, 1).cast<float>());
  mesh.triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  const MeshView view = render(mesh);
  for (int v = 0; v < 48; ++v)
  {
    for (int u = 0; u < 64; ++u)
    {
      const bool inside = u >= 10 && u <= 12 && v >= 20 && v <= 22;
      EXPECT_EQ(view.triangle_id.at<int>(v, u) >= 0, inside) << u << " " << v;
    }
  }
}

TEST(MeshRenderer, WhatReachesBehindTheCameraIsClipped)
{
  TriangleMesh floor;
  floor.vertices = { { -5, 0.2f, -1 }, { 5, 0.2f, -1 }, { 0, 0.2f, 10 } };
  floor.triangles = { { 0, 1, 2 } };
  const MeshView view = render(floor);
  EXPECT_NEAR(view.depth_m.at<float>(47, 31), 0.2 * 50 / 23.5, 1e-4);
  EXPECT_EQ(view.triangle_id.at<int>(10, 31), -1) << "above the horizon";
  EXPECT_EQ(cv::countNonZero(render(triangle(-1, -1, -1)).triangle_id + 1), 0) << "behind the camera";
}

TEST(MeshRenderer, EmptyMeshGivesTheBackground)
{
  const MeshView view = renderMesh({}, smallCamera(), Eigen::Isometry3d::Identity(), cv::Scalar(1, 2, 3));
  EXPECT_EQ(view.color_bgr.at<cv::Vec3b>(5, 5), cv::Vec3b(1, 2, 3));
  EXPECT_FALSE(renderFourSides({}, 32).empty());
}

TEST(MeshRenderer, RefusesACameraThatIsNone)
{
  EXPECT_THROW(renderMesh({}, geometry::PinholeCamera(), Eigen::Isometry3d::Identity()), base::Error);
  EXPECT_THROW(renderFourSides({}, 0), base::Error);
}

TEST(MeshRenderer, FourSidesShowEachSideOnceUpright)
{
  // Four upright walls of a box, each with its colour, and a roof.
  TriangleMesh mesh;
  const Eigen::Matrix<std::uint8_t, 3, 1> colors[] = { { 200, 0, 0 }, { 0, 200, 0 }, { 0, 0, 200 }, { 200, 200, 0 } };
  for (int side = 0; side < 4; ++side)
  {
    const Eigen::Matrix3f R(Eigen::AngleAxisf(static_cast<float>(side * M_PI / 2), Eigen::Vector3f::UnitZ()));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3f& p :
         { Eigen::Vector3f(1, -1, 0), Eigen::Vector3f(1, 1, 0), Eigen::Vector3f(1, 1, 2), Eigen::Vector3f(1, -1, 2) })
    {
      mesh.vertices.push_back(R * p);
      mesh.colors.push_back(colors[side]);
    }
    mesh.triangles.push_back({ first, first + 1, first + 2 });
    mesh.triangles.push_back({ first, first + 2, first + 3 });
  }
  const int size = 100;
  const cv::Mat turntable = renderTurntable(mesh, 8, size);
  ASSERT_EQ(turntable.size(), cv::Size(8 * size, size));
  EXPECT_THROW(renderTurntable(mesh, 0, size), base::Error);
  const cv::Mat picture = renderFourSides(mesh, size);
  ASSERT_EQ(picture.size(), cv::Size(2 * size, 2 * size));
  for (int side = 0; side < 4; ++side)
  {
    const cv::Vec3b at = picture.at<cv::Vec3b>(side / 2 * size + size / 2 + 8, side % 2 * size + size / 2);
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(at[c] > 60, colors[side][2 - c] > 0) << side << " " << at;
    EXPECT_EQ(turntable.at<cv::Vec3b>(size / 2 + 8, 2 * side * size + size / 2), at);
  }
}

}  // namespace
}  // namespace object_modelling::mesh
