#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "object_modelling/registration/image_pyramid.h"
#include "object_modelling/registration/patch_refinement.h"

namespace object_modelling::registration
{
namespace
{
constexpr int SIDE_PX = 160;
const Eigen::Vector2f CENTER(80, 80);

/// Smooth texture that can be evaluated anywhere, so that warps are exact.
double texture(double u, double v)
{
  return 120 + 40 * std::sin(0.31 * u + 0.13 * v) + 35 * std::sin(0.17 * u - 0.37 * v + 1) +
         20 * std::sin(0.53 * u + 0.41 * v + 2);
}

/// Image whose pixel x shows the texture at H_texture_image x, with gain and bias.
std::vector<cv::Mat> image(const Eigen::Matrix3d& H_texture_image, double gain = 1, double bias = 0)
{
  cv::Mat gray(SIDE_PX, SIDE_PX, CV_8UC1);
  for (int v = 0; v < SIDE_PX; ++v)
    for (int u = 0; u < SIDE_PX; ++u)
    {
      const Eigen::Vector2d at = (H_texture_image * Eigen::Vector3d(u, v, 1)).hnormalized();
      gray.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(gain * texture(at.x(), at.y()) + bias);
    }
  return ImagePyramid(gray).copyLevels();
}

Eigen::Matrix3d shift(double u, double v)
{
  Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
  H(0, 2) = u;
  H(1, 2) = v;
  return H;
}

Eigen::Vector2f truth(const Eigen::Matrix3d& H_current_reference)
{
  return (H_current_reference * CENTER.cast<double>().homogeneous()).hnormalized().cast<float>();
}
}  // namespace

TEST(PatchRefinement, FindsSubPixelShiftsInBothDirections)
{
  for (const Eigen::Vector2d& offset :
       { Eigen::Vector2d(0.37, -0.61), Eigen::Vector2d(-1.25, 0.8), Eigen::Vector2d(1.7, 1.4) })
  {
    const std::vector<cv::Mat> a = image(shift(0, 0));
    const std::vector<cv::Mat> b = image(shift(-offset.x(), -offset.y()));
    const PatchRefinement forward = refinePatch(a, b, shift(0, 0), CENTER, CENTER, 2);
    ASSERT_TRUE(forward.accepted);
    EXPECT_LT((forward.pixel - CENTER - offset.cast<float>()).norm(), 0.03F);
    const PatchRefinement backward = refinePatch(b, a, shift(0, 0), CENTER, CENTER, 2);
    ASSERT_TRUE(backward.accepted);
    EXPECT_LT((backward.pixel - CENTER + offset.cast<float>()).norm(), 0.03F);
  }
}

TEST(PatchRefinement, FollowsAProjectiveWarpBothWays)
{
  Eigen::Matrix3d H_current_reference;
  H_current_reference << 1.12, 0.15, -14.3, -0.08, 0.93, 9.4, 0.0004, -0.0003, 1;
  const std::vector<cv::Mat> reference = image(Eigen::Matrix3d::Identity());
  const std::vector<cv::Mat> current = image(H_current_reference.inverse());
  const Eigen::Vector2f expected = truth(H_current_reference);
  const PatchRefinement forward =
      refinePatch(reference, current, H_current_reference, CENTER, expected + Eigen::Vector2f(0.9F, -0.7F), 1.5);
  ASSERT_TRUE(forward.accepted);
  EXPECT_LT((forward.pixel - expected).norm(), 0.04F);
  const PatchRefinement backward = refinePatch(current, reference, H_current_reference.inverse(), expected,
                                               CENTER + Eigen::Vector2f(-0.8F, 0.6F), 1.5);
  ASSERT_TRUE(backward.accepted);
  EXPECT_LT((backward.pixel - CENTER).norm(), 0.04F);
}

TEST(PatchRefinement, EstimatesGainAndBias)
{
  const std::vector<cv::Mat> reference = image(shift(0, 0));
  for (const auto& [gain, bias] : { std::pair(0.6, 30.0), std::pair(1.25, -35.0) })
  {
    const PatchRefinement found =
        refinePatch(reference, image(shift(-0.6, 0.4), gain, bias), shift(0, 0), CENTER, CENTER, 1);
    ASSERT_TRUE(found.accepted);
    EXPECT_LT((found.pixel - CENTER - Eigen::Vector2f(0.6F, -0.4F)).norm(), 0.05F);
    EXPECT_GT(found.correlation, 0.98F);
  }
}

TEST(PatchRefinement, CoarseLevelReachesFurther)
{
  const std::vector<cv::Mat> reference = image(shift(0, 0));
  const std::vector<cv::Mat> current = image(shift(-2.6, 1.9));
  const PatchRefinement found = refinePatch(reference, current, shift(0, 0), CENTER, CENTER, 5);
  ASSERT_TRUE(found.accepted);
  EXPECT_LT((found.pixel - CENTER - Eigen::Vector2f(2.6F, -1.9F)).norm(), 0.05F);
}

TEST(PatchRefinement, DoesNotCallNonConvergenceASuccess)
{
  const std::vector<cv::Mat> reference = image(shift(0, 0));
  PatchRefinementOptions options;
  options.max_iterations = 1;
  EXPECT_FALSE(refinePatch(reference, image(shift(-1.4, 0.9)), shift(0, 0), CENTER, CENTER, 1, options).accepted);
}

TEST(PatchRefinement, RefusesOtherTexturePlainPatchesAndEdges)
{
  const std::vector<cv::Mat> reference = image(shift(0, 0));
  Eigen::Matrix3d other = shift(431, 977);
  other.topLeftCorner<2, 2>() << 0, 1.3, -1.3, 0;
  EXPECT_FALSE(refinePatch(reference, image(other), shift(0, 0), CENTER, CENTER, 1).accepted);

  const std::vector<cv::Mat> plain = ImagePyramid(cv::Mat(SIDE_PX, SIDE_PX, CV_8UC1, cv::Scalar(90))).copyLevels();
  EXPECT_FALSE(refinePatch(reference, plain, shift(0, 0), CENTER, CENTER, 1).accepted);
  EXPECT_FALSE(refinePatch(plain, plain, shift(0, 0), CENTER, CENTER, 1).accepted);

  cv::Mat edge(SIDE_PX, SIDE_PX, CV_8UC1, cv::Scalar(40));
  edge.colRange(0, 80).setTo(200);
  const std::vector<cv::Mat> edges = ImagePyramid(edge).copyLevels();
  EXPECT_FALSE(refinePatch(edges, edges, shift(0, 0), CENTER, CENTER, 1).accepted);
}

TEST(PatchRefinement, RefusesPatchesOutsideTheImageAndMeaninglessWarps)
{
  const std::vector<cv::Mat> pyramid = image(shift(0, 0));
  for (const Eigen::Vector2f& pixel : { Eigen::Vector2f(3, 80), Eigen::Vector2f(80, 158), Eigen::Vector2f(-500, 1e6F) })
    EXPECT_FALSE(refinePatch(pyramid, pyramid, shift(0, 0), pixel, pixel, 1).accepted);
  EXPECT_FALSE(refinePatch(pyramid, pyramid, Eigen::Matrix3d::Zero(), CENTER, CENTER, 1).accepted);
  EXPECT_FALSE(refinePatch(pyramid, pyramid, Eigen::Matrix3d::Constant(std::nan("")), CENTER, CENTER, 1).accepted);
}

TEST(PatchHomography, MapsThePlaneExactly)
{
  Eigen::Matrix3d K;
  K << 525, 0, 319.5, 0, 520, 239.5, 0, 0, 1;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const Eigen::Vector3d t(0.1, -0.05, 0.08), p(0.1, 0.05, 0.9), n = Eigen::Vector3d(0.3, -0.4, -1).normalized();
  const Eigen::Matrix3d H = patchHomography(K, R, t, n, p);
  // Another point of the same plane.
  const Eigen::Vector3d q = p + 0.07 * n.cross(Eigen::Vector3d::UnitX());
  const Eigen::Vector2d mapped = (H * (K * q)).hnormalized();
  EXPECT_LT((mapped - (K * (R * q + t)).hnormalized()).norm(), 1e-9);
}
}  // namespace object_modelling::registration
