#include "object_modelling/rgbd/normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "object_modelling/base/status.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::rgbd
{
namespace
{
using test_support::orbitPose;
using test_support::SceneImage;
using test_support::vgaCamera;

/// Angles (deg) between computed and true normals, of the pixels where both are known, sorted.
std::vector<double> errors_deg(const cv::Mat& normals, const cv::Mat& truth, const cv::Mat& where = cv::Mat())
{
  std::vector<double> errors;
  for (int v = 0; v < normals.rows; ++v)
    for (int u = 0; u < normals.cols; ++u)
    {
      const cv::Vec3f& a = normals.at<cv::Vec3f>(v, u);
      const cv::Vec3f& b = truth.at<cv::Vec3f>(v, u);
      if (a[0] == a[0] && b[0] == b[0] && (where.empty() || where.at<std::uint8_t>(v, u)))
        errors.push_back(std::acos(std::min(1.0, static_cast<double>(a.dot(b)))) * 180 / M_PI);
    }
  std::sort(errors.begin(), errors.end());
  return errors;
}

double quantile(const std::vector<double>& sorted, double share)
{
  return sorted.at(static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1)));
}

SceneImage tableView(double elevation_rad, double radius_m)
{
  test_support::SyntheticScene scene;
  scene.table_half_size_m = 100;
  return test_support::renderScene(scene, vgaCamera(), orbitPose({ 0, 0, 0 }, radius_m, 0.4, elevation_rad));
}

TEST(Normals, ExactOnAPlaneUpToTheRim)
{
  for (const double elevation_rad : { 1.5, 0.8, 0.7 })
  {
    const SceneImage image = tableView(elevation_rad, 0.7);
    const cv::Mat normals = computeNormals(image.frame);
    ASSERT_EQ(normals.type(), CV_32FC3);
    const std::vector<double> errors = errors_deg(normals, image.normals);
    EXPECT_EQ(errors.size(), 640u * 480u) << elevation_rad;
    EXPECT_LT(quantile(errors, 0.99), 0.1) << elevation_rad;
    EXPECT_LT(errors.back(), 1.0) << elevation_rad;
  }
}

TEST(Normals, FaceTheCameraWithUnitLength)
{
  const SceneImage image =
      test_support::renderScene(test_support::boxOnTable(), vgaCamera(), orbitPose({ 0, 0, 0.1 }, 0.6, 0.5, 0.5));
  const cv::Mat normals = computeNormals(image.frame);
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u)
    {
      const cv::Vec3f& n = normals.at<cv::Vec3f>(v, u);
      if (n[0] != n[0])
        continue;
      const Eigen::Vector3f p = image.frame.point(u, v);
      EXPECT_NEAR(cv::norm(n), 1, 1e-5);
      EXPECT_LT(n[0] * p.x() + n[1] * p.y() + n[2] * p.z(), 0);
    }
}

TEST(Normals, BoxFacesDoNotMixWithWhatLiesBehind)
{
  const SceneImage image =
      test_support::renderScene(test_support::boxOnTable(), vgaCamera(), orbitPose({ 0, 0, 0.1 }, 0.6, 0.5, 0.5));
  const std::vector<double> errors = errors_deg(computeNormals(image.frame), image.normals, image.frame.object_mask);
  EXPECT_LT(quantile(errors, 0.5), 0.05);
  EXPECT_LT(quantile(errors, 0.75), 2);  // the rest: within a window of the box's own edges and of its foot
  EXPECT_EQ(static_cast<int>(errors.size()), cv::countNonZero(image.frame.object_mask));
}

TEST(Normals, BothSidesOfAStepKeepTheirOwnPlane)
{
  // Two planes that face the camera, 4 cm apart at 1 m: beyond the gate of 1.5 cm.
  Frame frame;
  frame.camera = vgaCamera();
  frame.depth_m = cv::Mat(480, 640, CV_32FC1, cv::Scalar(1.0f));
  frame.depth_m.colRange(320, 640) = 1.04f;
  const cv::Mat normals = computeNormals(frame);
  const cv::Mat truth(480, 640, CV_32FC3, cv::Scalar(0, 0, -1));
  const std::vector<double> errors = errors_deg(normals, truth);
  EXPECT_EQ(errors.size(), 640u * 480u);
  EXPECT_LT(errors.back(), 0.1);
}

TEST(Normals, SphereAtTwoDistances)
{
  test_support::SyntheticScene scene;
  scene.has_table = false;
  scene.objects.push_back(test_support::standingSphere(0.2));
  for (const double distance_m : { 0.6, 1.2 })
  {
    const SceneImage image =
        test_support::renderScene(scene, vgaCamera(), orbitPose({ 0, 0, 0.1 }, distance_m, 0, 0.4));
    const std::vector<double> errors = errors_deg(computeNormals(image.frame), image.normals);
    EXPECT_GT(errors.size(), 1000u);
    EXPECT_LT(quantile(errors, 0.5), 0.5) << distance_m;
    EXPECT_LT(quantile(errors, 0.9), 4) << distance_m;
  }
}

TEST(Normals, SensorNoiseStaysBelowAFewDegrees)
{
  SceneImage image = tableView(1.0, 0.7);
  test_support::SensorNoise noise;
  noise.depth_sigma_scale = 1;
  noise.depth_quantum_m = 0.001;
  test_support::SyntheticScene scene;
  scene.table_half_size_m = 100;
  image = test_support::renderScene(scene, vgaCamera(), orbitPose({ 0, 0, 0 }, 0.7, 0.4, 1.0), noise);
  EXPECT_LT(quantile(errors_deg(computeNormals(image.frame), image.normals), 0.5), 4);
  NormalOptions wide;
  wide.radius_px = 8;
  EXPECT_LT(quantile(errors_deg(computeNormals(image.frame, wide), image.normals), 0.5), 1.5);
}

TEST(Normals, NoneWhereThereIsTooLittle)
{
  Frame frame;
  frame.camera = vgaCamera();
  frame.depth_m = cv::Mat(480, 640, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  const cv::Mat none = computeNormals(frame);
  EXPECT_EQ(cv::countNonZero(none.reshape(1) == none.reshape(1)), 0);

  frame.depth_m.row(100) = 1.0f;  // one line of pixels has no normal
  frame.depth_m.at<float>(200, 200) = 1.0f;
  const cv::Mat line = computeNormals(frame);
  EXPECT_EQ(cv::countNonZero(line.reshape(1) == line.reshape(1)), 0);
}

TEST(Normals, ImageSmallerThanTheWindow)
{
  Frame frame;
  frame.camera = vgaCamera();
  frame.depth_m = cv::Mat(5, 7, CV_32FC1, cv::Scalar(1.0f));
  const cv::Mat normals = computeNormals(frame);
  EXPECT_NEAR(normals.at<cv::Vec3f>(2, 3)[2], -1, 1e-5);
}

TEST(Normals, SmallestRadius)
{
  NormalOptions options;
  options.radius_px = 1;
  options.min_neighbors = 3;
  const SceneImage image = tableView(0.8, 0.7);
  const std::vector<double> errors = errors_deg(computeNormals(image.frame, options), image.normals);
  EXPECT_EQ(errors.size(), 640u * 480u);
  EXPECT_LT(quantile(errors, 0.95), 0.1);
}

TEST(Normals, RefusesBadOptions)
{
  const SceneImage image = tableView(0.8, 0.7);
  NormalOptions options;
  options.radius_px = 0;
  EXPECT_THROW(computeNormals(image.frame, options), base::Error);
  options = {};
  options.min_neighbors = 2;
  EXPECT_THROW(computeNormals(image.frame, options), base::Error);
}

}  // namespace
}  // namespace object_modelling::rgbd
