#include "object_modelling/rgbd/surface_fit.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/synthetic_scene.h"

namespace object_modelling::rgbd
{
namespace
{
/// The plane n . X = d as an exact depth image.
Frame planeFrame(const Eigen::Vector3d& n, double d_m)
{
  Frame frame;
  frame.camera = test_support::vgaCamera();
  frame.depth_m = cv::Mat(frame.camera.height, frame.camera.width, CV_32FC1);
  for (int v = 0; v < frame.depth_m.rows; ++v)
    for (int u = 0; u < frame.depth_m.cols; ++u)
      frame.depth_m.at<float>(v, u) = static_cast<float>(d_m / n.dot(frame.camera.unproject(u, v, 1)));
  return frame;
}
}  // namespace

TEST(SurfaceFit, ExactOnAPlaneBetweenPixels)
{
  const Eigen::Vector3d n = Eigen::Vector3d(0.3, 0.5, -1).normalized();
  const Frame frame = planeFrame(n, -0.7);
  for (const Eigen::Vector2d& pixel : { Eigen::Vector2d(320.3, 200.8), Eigen::Vector2d(17.5, 440.1) })
  {
    const std::optional<SurfacePoint> surface = fitSurface(frame, pixel);
    ASSERT_TRUE(surface);
    EXPECT_NEAR(surface->p.dot(n), -0.7, 1e-6);
    EXPECT_LT((surface->n - n).norm(), 1e-4);
    EXPECT_LT((frame.camera.project(surface->p) - pixel).norm(), 1e-9);
  }
}

TEST(SurfaceFit, TakesTheSurfaceOfItsPixelAtAnEdge)
{
  Frame frame = planeFrame({ 0, 0, -1 }, -1.0);
  frame.depth_m.colRange(320, 640).setTo(1.5);
  const std::optional<SurfacePoint> near = fitSurface(frame, { 319, 240 });
  const std::optional<SurfacePoint> far = fitSurface(frame, { 320, 240 });
  ASSERT_TRUE(near && far);
  EXPECT_NEAR(near->p.z(), 1.0, 1e-6);
  EXPECT_NEAR(far->p.z(), 1.5, 1e-6);
}

TEST(SurfaceFit, NothingWithoutASurface)
{
  Frame frame = planeFrame({ 0, 0, -1 }, -1.0);
  EXPECT_FALSE(fitSurface(frame, { 2, 240 })) << "at the rim";
  EXPECT_FALSE(fitSurface(frame, { 320, 900 })) << "outside";
  frame.depth_m.at<float>(240, 320) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(fitSurface(frame, { 320, 240 })) << "no depth";
  frame.depth_m.setTo(std::numeric_limits<float>::quiet_NaN());
  frame.depth_m.row(100).setTo(1.0);
  EXPECT_FALSE(fitSurface(frame, { 320, 100 })) << "a line holds no plane";
}

}  // namespace object_modelling::rgbd
