#include "object_modelling/rgbd/sensor_noise_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "object_modelling/base/status.h"
#include "object_modelling/rgbd/depth_edges.h"
#include "object_modelling/rgbd/normals.h"
#include "object_modelling/rgbd/observation_weight.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"
#include "support/violations.h"

namespace object_modelling::rgbd
{
namespace
{
constexpr double DEG = M_PI / 180;

TEST(AxialSigma, FrontalKnownAnswers)
{
  // 1.2 mm + 1.9 mm (z - 0.4)^2, worked out by hand
  EXPECT_NEAR(SensorNoiseModel().axialSigma_m(0.5, 0), 0.001219, 1e-12);
  EXPECT_NEAR(SensorNoiseModel().axialSigma_m(1.0, 0), 0.001884, 1e-12);
  EXPECT_NEAR(SensorNoiseModel().axialSigma_m(2.0, 0), 0.006064, 1e-12);
  EXPECT_NEAR(SensorNoiseModel().axialSigma_m(0.4, 0), 0.0012, 1e-12);
}

TEST(AxialSigma, IsFlatUpTo60DegAndGrowsBeyond)
{
  EXPECT_DOUBLE_EQ(SensorNoiseModel().axialSigma_m(1, 60 * DEG), SensorNoiseModel().axialSigma_m(1, 0));
  // 75 deg: 0.1 mm theta^2 / (pi/2 - theta)^2 = 0.1 mm * 25, divided by sqrt(z)
  EXPECT_NEAR(SensorNoiseModel().axialSigma_m(0.5, 75 * DEG), 0.001219 + 0.0025 / std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(SensorNoiseModel().axialSigma_m(1.0, 75 * DEG), 0.001884 + 0.0025, 1e-9);
  EXPECT_NEAR(SensorNoiseModel().axialSigma_m(2.0, 75 * DEG), 0.006064 + 0.0025 / std::sqrt(2.0), 1e-9);
}

TEST(LateralSigma, KnownAnswers)
{
  EXPECT_DOUBLE_EQ(SensorNoiseModel().lateralSigma_px(0), 0.8);
  EXPECT_NEAR(SensorNoiseModel().lateralSigma_px(45 * DEG), 0.835, 1e-12);
  EXPECT_NEAR(SensorNoiseModel().lateralSigma_px(60 * DEG), 0.87, 1e-12);
}

TEST(LateralSigma, DepthComesInOnce)
{
  // 0.8 px at f = 500 px: 1.6 mm per metre of depth; proportional, not quadratic
  EXPECT_NEAR(SensorNoiseModel().lateralSigma_m(0.5, 0, 500), 0.0008, 1e-12);
  EXPECT_NEAR(SensorNoiseModel().lateralSigma_m(1.0, 0, 500), 0.0016, 1e-12);
  EXPECT_NEAR(SensorNoiseModel().lateralSigma_m(2.0, 0, 500), 0.0032, 1e-12);
}

TEST(Sigmas, UnboundedFromARightAngleOn)
{
  for (const double theta : { M_PI / 2, 2.0, M_PI })
  {
    EXPECT_TRUE(std::isinf(SensorNoiseModel().axialSigma_m(1, theta)));
    EXPECT_TRUE(std::isinf(SensorNoiseModel().lateralSigma_px(theta)));
  }
}

TEST(DepthDistortion, IsBilinearBetweenItsKnots)
{
  SensorNoiseModel model;
  EXPECT_FALSE(model.correctsDepth());
  model.depth_distortion_ratio[1] = 0.008;                        // top row, second column
  model.depth_distortion_ratio[DistortionGrid::COLUMNS] = 0.004;  // second row, first column
  EXPECT_TRUE(model.correctsDepth());
  EXPECT_NEAR(DistortionGrid::ratioAt(model.depth_distortion_ratio, 80, 0, 641, 481), 0.008, 1e-12);
  EXPECT_NEAR(DistortionGrid::ratioAt(model.depth_distortion_ratio, 0, 80, 641, 481), 0.004, 1e-12);
  EXPECT_NEAR(DistortionGrid::ratioAt(model.depth_distortion_ratio, 40, 40, 641, 481), 0.003, 1e-12);
  EXPECT_EQ(DistortionGrid::ratioAt(model.depth_distortion_ratio, 640, 480, 641, 481), 0);
  EXPECT_NE(model, SensorNoiseModel());
  const cv::Mat image = DistortionGrid::image(model.depth_distortion_ratio, { 641, 481 });
  for (const cv::Point& pixel : { cv::Point(80, 0), cv::Point(33, 71), cv::Point(100, 20), cv::Point(640, 480) })
    EXPECT_NEAR(image.at<float>(pixel),
                DistortionGrid::ratioAt(model.depth_distortion_ratio, pixel.x, pixel.y, 641, 481), 1e-9);
  EXPECT_EQ(DistortionGrid::ratioAt(model.depth_distortion_ratio, 0, 0, 1, 1), 0);
}

TEST(NoiseModel, NamesEveryBrokenBound)
{
  SensorNoiseModel model;
  EXPECT_TRUE(model.violations().empty());
  model.axial_constant_m = 0;
  model.lateral_constant_px = -1;
  model.depth_bias_linear_ratio = 3;
  model.depth_distortion_ratio[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(test_support::namesOf(model.violations()),
            (std::vector<std::string>{ "axial_constant_m", "depth_bias_linear_ratio", "depth_distortion_ratio[3]",
                                       "lateral_constant_px" }));
}

TEST(NguyenWeight, IsTheInverseVariance)
{
  const SensorNoiseModel model;
  EXPECT_DOUBLE_EQ(nguyenWeight(model, 0.4, 0), 1);
  EXPECT_NEAR(nguyenWeight(model, 1, 0), std::pow(0.0012 / 0.001884, 2), 1e-12);
  EXPECT_EQ(nguyenWeight(model, 1, 90 * DEG), 0);
}

TEST(ObservationWeight, AsPrintedItLeavesOnlyTheFringe)
{
  ObservationWeightOptions printed;
  printed.model = WeightModel::PAPER_PRINTED;
  EXPECT_DOUBLE_EQ(paperWeight(0, 0, printed), 0.5);
  EXPECT_NEAR(paperWeight(0, 0.001, printed), 1 - 0.5 * std::exp(0.25), 1e-12);
  EXPECT_GT(paperWeight(0, 0.002 * std::sqrt(std::log(2.0)) - 1e-6, printed), 0);
  EXPECT_EQ(paperWeight(0, 0.002 * std::sqrt(std::log(2.0)) + 1e-6, printed), 0);
  EXPECT_EQ(paperWeight(0, 1, printed), 0);
}

TEST(ObservationWeight, AngleFactor)
{
  const double far = 1;
  EXPECT_DOUBLE_EQ(paperWeight(0, far), 1);
  EXPECT_DOUBLE_EQ(paperWeight(59.9 * DEG, far), 1);
  EXPECT_NEAR(paperWeight(60 * DEG, far), 1, 1e-9);
  EXPECT_NEAR(paperWeight(75 * DEG, far), 0.5, 1e-9);
  EXPECT_NEAR(paperWeight(89.999 * DEG, far), 0, 1e-4);
  EXPECT_EQ(paperWeight(90 * DEG, far), 0);
  EXPECT_EQ(paperWeight(120 * DEG, far), 0);
}

TEST(ObservationWeight, EdgeFactor)
{
  EXPECT_DOUBLE_EQ(paperWeight(0, 0), 0.5);
  EXPECT_NEAR(paperWeight(0, 0.002), 1 - 0.5 * std::exp(-1.0), 1e-12);
  EXPECT_NEAR(paperWeight(0, 0.004), 1 - 0.5 * std::exp(-4.0), 1e-12);
  EXPECT_NEAR(paperWeight(75 * DEG, 0), 0.25, 1e-9);
  EXPECT_EQ(paperWeight(0, std::numeric_limits<double>::infinity()), 1);
}

TEST(ObservationWeight, StaysWithinItsRangeAndNeverFallsAwayFromAnEdge)
{
  for (double theta = 0; theta < M_PI; theta += 0.05)
  {
    double previous = 0;
    for (double distance_m = 0; distance_m < 0.03; distance_m += 0.0005)
    {
      const double weight = paperWeight(theta, distance_m);
      EXPECT_GE(weight, previous);
      EXPECT_LE(weight, 1);
      previous = weight;
    }
  }
}

TEST(ObservationWeights, ImageAgreesWithTheFormulaAtSeveralDepths)
{
  test_support::SyntheticScene scene = test_support::boxOnTable();
  const geometry::PinholeCamera camera = test_support::vgaCamera();
  for (const double distance_m : { 0.5, 1.0, 2.0 })
  {
    const test_support::SceneImage image =
        test_support::renderScene(scene, camera, test_support::orbitPose({ 0, 0, 0.1 }, distance_m, 0.5, 0.3));
    const cv::Mat distance_px = distanceToEdges_px(findDepthEdges(image.frame));
    const cv::Mat weights = observationWeights(image.frame, image.normals, distance_px);
    for (int v = 0; v < 480; v += 3)
      for (int u = 0; u < 640; u += 3)
      {
        const cv::Vec3f& n = image.normals.at<cv::Vec3f>(v, u);
        const float z = image.frame.depthAt_m(u, v);
        const float weight = weights.at<float>(v, u);
        if (!(z > 0))
        {
          EXPECT_EQ(weight, 0);
          continue;
        }
        const Eigen::Vector3d ray = camera.unproject(u, v, 1).normalized();
        const double theta = std::acos(-ray.dot(Eigen::Vector3d(n[0], n[1], n[2])));
        EXPECT_NEAR(weight, paperWeight(theta, distance_px.at<float>(v, u) * z / 525.0), 2e-4);
      }
  }
}

TEST(ObservationWeights, NguyenGoesByTheFramesModel)
{
  Frame frame;
  frame.camera = test_support::vgaCamera();
  frame.noise_model.axial_constant_m = 0.002;
  frame.depth_m = (cv::Mat_<float>(1, 3) << 0.4f, 2.0f, std::numeric_limits<float>::quiet_NaN());
  frame.camera.cx = frame.camera.cy = 0;
  ObservationWeightOptions options;
  options.model = WeightModel::NGUYEN;
  const cv::Mat normals(1, 3, CV_32FC3, cv::Scalar(0, 0, -1));
  const cv::Mat weights = observationWeights(frame, normals, cv::Mat::zeros(1, 3, CV_32FC1), options);
  EXPECT_NEAR(weights.at<float>(0, 0), 1, 1e-6);
  EXPECT_NEAR(weights.at<float>(0, 1), std::pow(0.002 / (0.002 + 0.0019 * 1.6 * 1.6), 2), 1e-6);
  EXPECT_EQ(weights.at<float>(0, 2), 0);
}

TEST(ObservationWeights, NothingWithoutNormalOrDepth)
{
  Frame frame;
  frame.camera = test_support::vgaCamera();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  frame.depth_m = (cv::Mat_<float>(1, 3) << 1.0f, nan, 1.0f);
  cv::Mat normals(1, 3, CV_32FC3, cv::Scalar(0, 0, -1));
  normals.at<cv::Vec3f>(0, 0) = { nan, nan, nan };
  normals.at<cv::Vec3f>(0, 2) = { 0, 0, 1 };  // turned away
  const cv::Mat weights = observationWeights(frame, normals, cv::Mat::ones(1, 3, CV_32FC1) * 100);
  EXPECT_EQ(cv::countNonZero(weights), 0);
}

TEST(ObservationWeights, RefusesBadOptions)
{
  Frame frame;
  frame.depth_m = cv::Mat::ones(1, 1, CV_32FC1);
  ObservationWeightOptions options;
  options.sigma_lateral_m = 0;
  options.theta_max_rad = M_PI;
  EXPECT_EQ(test_support::namesOf(options.violations()),
            (std::vector<std::string>{ "sigma_lateral_m", "theta_max_rad" }));
  EXPECT_THROW(observationWeights(frame, cv::Mat::zeros(1, 1, CV_32FC3), frame.depth_m, options), base::Error);
}

}  // namespace
}  // namespace object_modelling::rgbd
