#include "object_modelling/fusion/cloud_fusion.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"
#include "support/thrown_status.h"

namespace object_modelling::fusion
{
namespace
{
FusedCloud fusedCloud(const std::vector<rgbd::View>& views)
{
  base::JobControl control;
  return fuse(views, {}, control).cloud;
}

/// Mean difference in grey levels; the points are the same.
double colorDifference(const FusedCloud& a, const FusedCloud& b)
{
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (a.colors[i].cast<double>() - b.colors[i].cast<double>()).cwiseAbs().mean();
  return sum / static_cast<double>(a.size());
}
}  // namespace

TEST(CloudFusion, TakesColorsByTheOffsetOfEachView)
{
  const std::vector<rgbd::View> registered = test_support::renderViews(
      test_support::boxOnTable(), test_support::vgaCamera(), test_support::orbitPoses(12, { 0, 0, 0.1 }, 0.6, 0.35));
  std::vector<rgbd::View> own = registered;
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    own[i].color_offset_px = i % 2 == 0 ? Eigen::Vector2d(5, 1) : Eigen::Vector2d(-3, 1);
    const cv::Matx23d shift(1, 0, own[i].color_offset_px.x(), 0, 1, own[i].color_offset_px.y());
    cv::Mat& image = own[i].frame.color_bgr;
    cv::Mat shifted;
    cv::warpAffine(image, shifted, shift, image.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    image = shifted;
  }
  std::vector<rgbd::View> mean = own;
  for (rgbd::View& view : mean)
    view.color_offset_px = { 1, 1 };

  const FusedCloud truth = fusedCloud(registered), by_own = fusedCloud(own), by_mean = fusedCloud(mean);
  ASSERT_GT(truth.size(), 1000u);
  ASSERT_EQ(by_own.points, truth.points);
  ASSERT_EQ(by_mean.points, truth.points);
  EXPECT_LT(colorDifference(by_own, truth), 0.5);
  EXPECT_GT(colorDifference(by_mean, truth), 5);
}

TEST(CloudFusion, RefusesAnOffsetThatIsNotANumber)
{
  std::vector<rgbd::View> views(2);
  views[1].color_offset_px.x() = std::nan("");
  base::JobControl control;
  const base::Status status = test_support::statusOf([&] { fuse(views, {}, control); });
  EXPECT_EQ(status.code, base::StatusCode::INVALID_ARGUMENT);
  EXPECT_TRUE(test_support::mentions(status, "view 1")) << status.message;
}

}  // namespace object_modelling::fusion
