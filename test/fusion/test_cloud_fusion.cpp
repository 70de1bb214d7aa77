#include "object_modelling/fusion/cloud_fusion.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>
#include <omp.h>
#include <opencv2/imgproc.hpp>

#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"
#include "support/violations.h"

namespace object_modelling::fusion
{
namespace
{
using test_support::SyntheticScene;

test_support::SensorNoise realNoise()
{
  test_support::SensorNoise noise;
  noise.depth_sigma_scale = 1;
  noise.depth_quantum_m = 0.001;
  noise.missing_edge_px = 1;
  noise.max_theta_rad = 1.35;
  noise.color_sigma = 3;
  return noise;
}

/// Views all round at two heights.
std::vector<Eigen::Isometry3d> allRound(int count, double radius_m = 0.6)
{
  std::vector<Eigen::Isometry3d> poses = test_support::orbitPoses(count - count / 2, { 0, 0, 0.05 }, radius_m, 0.35);
  for (const Eigen::Isometry3d& pose : test_support::orbitPoses(count / 2, { 0, 0, 0.05 }, radius_m, 0.9))
    poses.push_back(pose);
  return poses;
}

std::vector<rgbd::View> viewsOf(const SyntheticScene& scene, int count, const test_support::SensorNoise& noise = {})
{
  return test_support::renderViews(scene, test_support::vgaCamera(), allRound(count), noise);
}

CloudFusionResult fused(const std::vector<rgbd::View>& views, const CloudFusionOptions& options = {})
{
  base::JobControl control;
  return fuse(views, options, control);
}

SyntheticScene sphereOnTable()
{
  SyntheticScene scene;
  scene.objects.push_back(test_support::standingSphere(0.1));
  return scene;
}

/// Images are shared between the copies: replace, do not write.
const std::vector<rgbd::View>& noisySphere()
{
  static const std::vector<rgbd::View> views = viewsOf(sphereOnTable(), 16, realNoise());
  return views;
}

const std::vector<rgbd::View>& noisyBox()
{
  static const std::vector<rgbd::View> views = viewsOf(test_support::boxOnTable(), 12, realNoise());
  return views;
}

struct Deviation
{
  double mean_m = 0, mean_absolute_m = 0, largest_m = 0;
};

Deviation deviation(const FusedCloud& cloud, const test_support::SceneObject& object)
{
  Deviation result;
  for (const Eigen::Vector3f& point : cloud.points)
  {
    const double d = object.signedDistance_m(point.cast<double>());
    result.mean_m += d / static_cast<double>(cloud.size());
    result.mean_absolute_m += std::abs(d) / static_cast<double>(cloud.size());
    result.largest_m = std::max(result.largest_m, std::abs(d));
  }
  return result;
}

class PlaneAt : public testing::TestWithParam<double>
{
};

TEST_P(PlaneAt, StaysWhereItIs)
{
  const double distance_m = GetParam();
  SyntheticScene scene;
  scene.objects.push_back(test_support::standingBox({ 0.3, 0.3, 0.1 }));
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 12; ++i)
    poses.push_back(test_support::orbitPose({ 0.01 * (i % 3), 0.01 * (i / 3), 0.1 }, distance_m, 0.5 * i, 1.2));
  CloudFusionOptions options;
  options.resolution_m = 0.004;
  const CloudFusionResult result =
      fused(test_support::renderViews(scene, test_support::vgaCamera(), poses, realNoise()), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  double sum_m = 0, square_sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < result.cloud.size(); ++i)
  {
    const Eigen::Vector3f& point = result.cloud.points[i];
    if (std::abs(point.x()) > 0.13 || std::abs(point.y()) > 0.13 || point.z() < 0.05)
      continue;
    sum_m += point.z() - 0.1;
    square_sum += std::pow((point.z() - 0.1) / result.cloud.sigmas_m[i], 2);
    ++count;
    EXPECT_GT(result.cloud.normals[i].z(), 0.95);
  }
  ASSERT_GT(count, 1000);
  EXPECT_NEAR(sum_m / count, 0, 1e-4);
  // The reported sigma is that of the position, within a factor.
  EXPECT_GT(std::sqrt(square_sum / count), 0.3);
  EXPECT_LT(std::sqrt(square_sum / count), 3);
}
INSTANTIATE_TEST_SUITE_P(Distances, PlaneAt, testing::Values(0.5, 1.0, 2.0));

TEST(CloudFusion, SphereFromNoisyViews)
{
  const SyntheticScene scene = sphereOnTable();
  const CloudFusionResult result = fused(noisySphere());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const Deviation error = deviation(result.cloud, scene.objects[0]);
  EXPECT_LT(std::abs(error.mean_m), 2e-4);
  EXPECT_LT(error.mean_absolute_m, 4e-4);
  EXPECT_LT(error.largest_m, 0.004);
  const Eigen::Vector3f center(0, 0, 0.05f);
  double cosine_sum = 0;
  for (std::size_t i = 0; i < result.cloud.size(); ++i)
  {
    EXPECT_NEAR(result.cloud.normals[i].norm(), 1, 1e-4);
    cosine_sum += result.cloud.normals[i].dot((result.cloud.points[i] - center).normalized());
  }
  EXPECT_GT(cosine_sum / static_cast<double>(result.cloud.size()), 0.99);
  // 4 pi r^2, less the part under the table's horizon, at a point or less per (2 mm)^2.
  EXPECT_GT(result.cloud.size(), 3000u);
  EXPECT_LT(result.cloud.size(), 10000u);
  EXPECT_EQ(result.cloud.points.size(), result.cloud.normals.size());
  EXPECT_EQ(result.cloud.points.size(), result.cloud.colors.size());
  EXPECT_EQ(result.cloud.points.size(), result.cloud.weights.size());
  EXPECT_EQ(result.cloud.points.size(), result.cloud.sigmas_m.size());
}

TEST(CloudFusion, ExactDepthGivesTheExactSphere)
{
  const SyntheticScene scene = sphereOnTable();
  const CloudFusionResult result = fused(viewsOf(scene, 12));
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const Deviation error = deviation(result.cloud, scene.objects[0]);
  EXPECT_LT(error.mean_absolute_m, 5e-5);
  EXPECT_LT(error.largest_m, 0.001);
}

TEST(CloudFusion, ThinPlateKeepsItsTwoSides)
{
  SyntheticScene scene;
  scene.objects.push_back(test_support::standingBox({ 0.1, 0.003, 0.1 }));
  const CloudFusionResult result = fused(viewsOf(scene, 16, realNoise()));
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  double front_sum_m = 0, back_sum_m = 0;
  int front = 0, back = 0;
  for (std::size_t i = 0; i < result.cloud.size(); ++i)
  {
    const Eigen::Vector3f& point = result.cloud.points[i];
    if (std::abs(point.x()) > 0.04 || point.z() < 0.01 || point.z() > 0.09)
      continue;
    ASSERT_GT(std::abs(result.cloud.normals[i].y()), 0.8) << point.transpose();
    const bool is_front = result.cloud.normals[i].y() > 0;
    (is_front ? front_sum_m : back_sum_m) += point.y();
    ++(is_front ? front : back);
  }
  ASSERT_GT(front, 400);
  ASSERT_GT(back, 400);
  EXPECT_NEAR(front_sum_m / front, 0.0015, 3e-4);
  EXPECT_NEAR(back_sum_m / back, -0.0015, 3e-4);
}

/// A patch of the object in one view, displaced along the rays.
void displacePatch(double offset_m, rgbd::View* view)
{
  view->frame.depth_m = view->frame.depth_m.clone();
  const cv::Mat& mask = view->frame.object_mask;
  for (int v = 200; v < 260; ++v)
  {
    for (int u = 290; u < 350; ++u)
    {
      if (mask.at<unsigned char>(v, u))
        view->frame.depth_m.at<float>(v, u) += static_cast<float>(offset_m);
    }
  }
}

TEST(CloudFusion, DropsWhatFliesInFrontAndWhatLiesInside)
{
  const test_support::SceneObject sphere = sphereOnTable().objects[0];
  for (const double offset_m : { -0.2, -0.02, 0.02, 0.05 })
  {
    std::vector<rgbd::View> views = noisySphere();
    displacePatch(offset_m, &views[0]);
    CloudFusionOptions options;
    options.min_views = offset_m < 0 ? 1 : 2;  // what lies inside contradicts nobody: it takes a second view
    const CloudFusionResult result = fused(views, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_LT(deviation(result.cloud, sphere).largest_m, 0.007) << offset_m;
    if (offset_m < 0)
    {
      EXPECT_GT(result.observations_inconsistent, 1000u) << offset_m;
    }
  }
}

TEST(CloudFusion, OneWrongViewDoesNotCarveTheSurfaceAway)
{
  std::vector<rgbd::View> views = noisySphere();
  const std::size_t whole = fused(views).cloud.size();
  displacePatch(0.5, &views[0]);  // it now sees through the object
  const CloudFusionResult result = fused(views);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_GT(static_cast<double>(result.cloud.size()), 0.94 * static_cast<double>(whole));
}

TEST(CloudFusion, NoTableRimWhereSomeMasksAreTooLarge)
{
  const SyntheticScene scene = test_support::boxOnTable();
  std::vector<rgbd::View> views = noisyBox();
  for (std::size_t i = 0; i < views.size(); i += 3)
  {
    cv::Mat too_large;
    cv::dilate(views[i].frame.object_mask, too_large, cv::Mat::ones(11, 11, CV_8UC1));
    views[i].frame.object_mask = too_large;
  }
  const CloudFusionResult result = fused(views);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_LT(deviation(result.cloud, scene.objects[0]).largest_m, 0.005);
}

TEST(CloudFusion, NothingOutsideTheMasks)
{
  const SyntheticScene scene = test_support::boxOnTable();
  std::vector<rgbd::View> views = viewsOf(scene, 12);
  for (rgbd::View& view : views)
    view.frame.object_mask.rowRange(240, 480).setTo(0);
  const CloudFusionResult result = fused(views);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  for (const Eigen::Vector3f& point : result.cloud.points)
    EXPECT_GT(point.z(), 0.04f);
}

TEST(CloudFusion, ExposureDifferencesDoNotMottleTheColor)
{
  SyntheticScene scene = sphereOnTable();
  scene.objects[0].texture = test_support::plainTexture({ 60, 120, 180 });
  std::vector<rgbd::View> views = viewsOf(scene, 12);
  const FusedCloud even = fused(views).cloud;
  for (std::size_t i = 0; i < views.size(); i += 2)
  {
    cv::Mat darker;
    views[i].frame.color_bgr.convertTo(darker, -1, 0.8);
    views[i].frame.color_bgr = darker;
  }
  const FusedCloud uneven = fused(views).cloud;
  ASSERT_GT(even.size(), 1000u);
  ASSERT_EQ(even.size(), uneven.size());
  double sum = 0, square_sum = 0;
  for (std::size_t i = 0; i < even.size(); ++i)
  {
    EXPECT_NEAR(static_cast<double>(even.colors[i][0]) / even.colors[i][2], 3, 0.3) << "red first, blue last";
    const double ratio = static_cast<double>(uneven.colors[i][0]) / even.colors[i][0];
    sum += ratio;
    square_sum += ratio * ratio;
  }
  const double count = static_cast<double>(even.size()), mean = sum / count;
  EXPECT_NEAR(mean, std::sqrt(0.8), 0.02) << "the common exposure is the mean of all";
  EXPECT_LT(std::sqrt(square_sum / count - mean * mean), 0.02);
}

std::string bytesOf(const CloudFusionResult& result)
{
  std::string bytes;
  const auto append = [&](const auto& values)
  { bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])); };
  append(result.cloud.points);
  append(result.cloud.normals);
  append(result.cloud.colors);
  append(result.cloud.weights);
  append(result.cloud.sigmas_m);
  return bytes;
}

TEST(CloudFusion, SameInputGivesTheSameBytesOnAnyNumberOfThreads)
{
  const std::vector<rgbd::View>& views = noisyBox();
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const std::string on_one = bytesOf(fused(views));
  omp_set_num_threads(3);
  const std::string on_three = bytesOf(fused(views));
  omp_set_num_threads(threads);
  EXPECT_FALSE(on_one.empty());
  EXPECT_EQ(on_one, on_three);
}

void expectNoResult(const std::vector<rgbd::View>& views, const std::string& reason,
                    const CloudFusionOptions& options = {})
{
  const CloudFusionResult result = fused(views, options);
  EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(result.status.message.find(reason), std::string::npos) << result.status.message;
  EXPECT_EQ(result.cloud.size(), 0u);
}

TEST(CloudFusion, NamesTheStepThatLeftNothing)
{
  expectNoResult({}, "mask");

  std::vector<rgbd::View> views = viewsOf(test_support::boxOnTable(), 4);
  CloudFusionOptions many_views;
  many_views.min_views = 5;
  expectNoResult(views, "min_views = 5", many_views);

  std::vector<rgbd::View> without_depth = views, without_masks = views, with_empty_masks = views;
  for (int i = 0; i < 4; ++i)
  {
    without_masks[i].frame.object_mask = cv::Mat();
    with_empty_masks[i].frame.object_mask = cv::Mat(480, 640, CV_8UC1, cv::Scalar(0));
    without_depth[i].frame.depth_m = cv::Mat(480, 640, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  }
  expectNoResult(without_masks, "object mask");
  expectNoResult(with_empty_masks, "object mask");
  expectNoResult(without_depth, "has depth");
}

TEST(CloudFusion, ViewsWithoutMaskAreNoTrouble)
{
  std::vector<rgbd::View> views = noisyBox();
  views[2].frame.object_mask = cv::Mat();
  views[5].frame.object_mask = cv::Mat(480, 640, CV_8UC1, cv::Scalar(0));
  EXPECT_TRUE(fused(views).status.ok());
}

TEST(CloudFusion, StopsWhenCancelled)
{
  const std::vector<rgbd::View>& views = noisyBox();
  for (const std::size_t stage : { 0, 2, 4 })
  {
    base::JobControl* running = nullptr;
    base::JobControl control(
        [&](const base::Progress& progress)
        {
          if (progress.done == stage)
            running->cancel();
        });
    running = &control;
    EXPECT_THROW(fuse(views, {}, control), base::Cancelled) << stage;
  }
}

TEST(CloudFusion, RefusesOptionsOutOfBounds)
{
  CloudFusionOptions options;
  EXPECT_TRUE(options.violations().empty());
  options.resolution_m = 0;
  options.averaging_radius_m = std::numeric_limits<double>::quiet_NaN();
  options.min_views = 0;
  EXPECT_EQ(test_support::namesOf(options.violations()),
            (std::vector<std::string>{ "averaging_radius_m", "min_views", "resolution_m" }));
  EXPECT_THROW(fused({}, options), base::Error);
}

}  // namespace
}  // namespace object_modelling::fusion
