#include "surface_links.h"

#include <limits>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "object_modelling/bundle_adjustment/bundle_adjustment.h"
#include "support/handheld_trajectory.h"
#include "support/pose_errors.h"
#include "support/synthetic_scene.h"
#include "support/transform_matchers.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
/// Views round the box without any landmark, each off its true pose by up to 1 cm and 0.5 deg.
class SurfaceLinks : public ::testing::Test
{
protected:
  explicit SurfaceLinks(const test_support::SyntheticScene& scene = test_support::boxOnTable())
  {
    for (int k = 0; k < 5; ++k)
    {
      truth_.push_back(test_support::orbitPose({ 0, 0, 0.1 }, 0.7, 0.12 * k, 0.6));
      test_support::SensorNoise noise;
      noise.depth_sigma_scale = 0.5;
      noise.color_sigma = 1.5;
      noise.seed = static_cast<std::uint64_t>(k + 1);
      rgbd::Keyframe keyframe;
      keyframe.id = k;
      keyframe.frame = test_support::renderFrame(scene, test_support::vgaCamera().scaled(0.5), truth_[k], noise, k);
      geometry::Vector6d off = geometry::Vector6d::Zero();
      if (k > 0)
        off << 0.01 * (k % 3 - 1), 0.008, -0.01 * (k % 2), 0.008, -0.008 * (k % 2), 0.004;
      keyframe.T_session_camera = truth_[0].inverse() * truth_[k] * geometry::isometryFromVector(off);
      keyframes_.push_back(keyframe);
    }
  }

  std::vector<Eigen::Isometry3d> truth_;
  std::vector<rgbd::Keyframe> keyframes_;
  base::JobControl control_;
};

class PlainSurfaceLinks : public SurfaceLinks
{
protected:
  PlainSurfaceLinks() : SurfaceLinks(plain()) {}

  static test_support::SyntheticScene plain()
  {
    test_support::SyntheticScene scene = test_support::boxOnTable();
    scene.table = test_support::plainTexture();
    scene.objects[0].texture = test_support::plainTexture({ 90, 120, 200 });
    return scene;
  }
};
}  // namespace

TEST_F(PlainSurfaceLinks, LeaveTheCovarianceThatKeyframesHad)
{
  const geometry::Matrix6d unsure = 1e-6 * geometry::Matrix6d::Identity();
  for (std::size_t k = 1; k < keyframes_.size(); ++k)
    keyframes_[k].covariance = unsure;
  const BundleAdjustmentResult result = adjustBundle(keyframes_, {}, control_);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.left_out.empty());
  // Landmarks alone give covariances here; zero would mean that nothing is unsure.
  for (std::size_t k = 1; k < keyframes_.size(); ++k)
    EXPECT_EQ(result.covariance[k], unsure) << k;
}

TEST_F(SurfaceLinks, MeasureRelativePosesFromWrongOnes)
{
  const std::vector<SurfaceLink> links = linkSurfaces(keyframes_, Eigen::Vector2d::Zero(), false, false, control_);
  ASSERT_GE(links.size(), keyframes_.size() - 1);
  for (const SurfaceLink& link : links)
  {
    EXPECT_LT(link.a, link.b);
    EXPECT_TRANSFORM_NEAR(link.T_a_b, truth_[link.a].inverse() * truth_[link.b], 0.002, 0.003)
        << link.a << " " << link.b;
    EXPECT_GT(link.information.diagonal().minCoeff(), 0);
  }
}

TEST_F(SurfaceLinks, HoldKeyframesTogetherThatShareNoLandmark)
{
  const BundleAdjustmentResult result = adjustBundle(keyframes_, {}, control_);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.left_out.empty());
  for (std::size_t k = 0; k < keyframes_.size(); ++k)
    EXPECT_TRANSFORM_NEAR(result.T_session_camera[k], truth_[0].inverse() * truth_[k], 0.002, 0.003) << k;
}

/// Colour images shifted by `offset_px` against the depth images.
std::vector<rgbd::Keyframe> withColorShifted(std::vector<rgbd::Keyframe> keyframes, const Eigen::Vector2d& offset_px)
{
  const cv::Matx23d shift(1, 0, offset_px.x(), 0, 1, offset_px.y());
  for (rgbd::Keyframe& keyframe : keyframes)
  {
    cv::Mat shifted;
    cv::warpAffine(keyframe.frame.gray, shifted, shift, keyframe.frame.gray.size(), cv::INTER_CUBIC,
                   cv::BORDER_REPLICATE);
    keyframe.frame.gray = shifted;
  }
  return keyframes;
}

TEST_F(SurfaceLinks, AlignShiftedImagesByTheKnownShift)
{
  const Eigen::Vector2d offset_px(2.5, -3);
  const std::vector<SurfaceLink> links =
      linkSurfaces(withColorShifted(keyframes_, offset_px), offset_px, false, false, control_);
  ASSERT_GE(links.size(), keyframes_.size() - 1);
  for (const SurfaceLink& link : links)
    EXPECT_TRANSFORM_NEAR(link.T_a_b, truth_[link.a].inverse() * truth_[link.b], 0.002, 0.003)
        << link.a << " " << link.b;
}

TEST_F(SurfaceLinks, TellWhatAShiftDoesToThem)
{
  const Eigen::Vector2d offset_px(1.6, -1.2);
  const std::vector<rgbd::Keyframe> shifted = withColorShifted(keyframes_, offset_px);
  const std::vector<SurfaceLink> links = linkSurfaces(shifted, Eigen::Vector2d::Zero(), true, false, control_);
  const std::vector<SurfaceLink> right = linkSurfaces(shifted, offset_px, true, false, control_);
  ASSERT_EQ(links.size(), right.size());
  double before = 0, after = 0;
  for (std::size_t i = 0; i < links.size(); ++i)
  {
    EXPECT_TRUE(links[i].color_offset_px.isZero());
    EXPECT_EQ(right[i].color_offset_px, offset_px);
    const geometry::Vector6d off = geometry::vectorFromIsometry(right[i].T_a_b * links[i].T_a_b.inverse());
    before += off.squaredNorm();
    after += (off - links[i].by_color_offset * offset_px).squaredNorm();
  }
  EXPECT_LT(after, 0.2 * before);
}

TEST_F(SurfaceLinks, ShiftOfTheColorImagesIsFound)
{
  for (const Eigen::Vector2d& offset_px : { Eigen::Vector2d(0, 0), Eigen::Vector2d(1.2, -0.8) })
  {
    const BundleAdjustmentResult result = adjustBundle(withColorShifted(keyframes_, offset_px), {}, control_);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_NEAR(result.color_offset_px.x(), offset_px.x(), 0.25);
    EXPECT_NEAR(result.color_offset_px.y(), offset_px.y(), 0.25);
    for (std::size_t k = 0; k < keyframes_.size(); ++k)
      EXPECT_TRANSFORM_NEAR(result.T_session_camera[k], truth_[0].inverse() * truth_[k], 0.002, 0.003) << k;
  }
}

TEST_F(SurfaceLinks, ShiftOfTheColorImagesCountsOnlyIfAskedFor)
{
  const std::vector<rgbd::Keyframe> shifted = withColorShifted(keyframes_, { 1.2, -0.8 });
  std::vector<rgbd::Keyframe> truth = keyframes_;
  for (std::size_t k = 0; k < truth.size(); ++k)
    truth[k].T_session_camera = truth_[0].inverse() * truth_[k];
  BundleAdjustmentOptions options;
  const BundleAdjustmentResult with = adjustBundle(shifted, options, control_);
  options.calibrate_color_offset = false;
  const BundleAdjustmentResult without = adjustBundle(shifted, options, control_);
  EXPECT_TRUE(without.color_offset_px.isZero());
  EXPECT_LT(2 * test_support::largestError(with.T_session_camera, truth).translation_m,
            test_support::largestError(without.T_session_camera, truth).translation_m);
}

TEST_F(SurfaceLinks, NoneWithoutSurfaces)
{
  for (rgbd::Keyframe& keyframe : keyframes_)
    keyframe.frame.depth_m = cv::Mat(keyframe.frame.depth_m.size(), CV_32FC1, cv::Scalar(std::nan("")));
  EXPECT_TRUE(linkSurfaces(keyframes_, Eigen::Vector2d::Zero(), false, false, control_).empty());
  for (rgbd::Keyframe& keyframe : keyframes_)
    keyframe.frame = {};
  EXPECT_TRUE(linkSurfaces(keyframes_, Eigen::Vector2d::Zero(), false, false, control_).empty());
  EXPECT_TRUE(linkSurfaces({}, Eigen::Vector2d::Zero(), false, false, control_).empty());
}

TEST_F(SurfaceLinks, NoneBetweenScenesThatDiffer)
{
  test_support::SyntheticScene other;
  other.objects = { test_support::standingCylinder(0.12, 0.1, 0.05, 0.02, 77) };
  other.table.seed = 99;
  keyframes_.resize(2);
  keyframes_[1].frame = test_support::renderFrame(other, test_support::vgaCamera().scaled(0.5), truth_[1], {}, 1.0);
  EXPECT_TRUE(linkSurfaces(keyframes_, Eigen::Vector2d::Zero(), false, false, control_).empty());
}

}  // namespace object_modelling::bundle_adjustment
