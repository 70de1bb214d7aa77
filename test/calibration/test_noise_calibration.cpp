#include "object_modelling/calibration/noise_calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "support/temp_dir.h"
#include "support/violations.h"
#include "synthetic_wall.h"

namespace object_modelling::calibration
{
namespace
{
constexpr double DEG = M_PI / 180;

NoiseCalibration calibrate(const SyntheticWall& wall, const std::vector<MeasuredDistance>& distances = {})
{
  SyntheticWallSource source(wall);
  base::JobControl control;
  return calibrateNoise(source, distances, {}, control);
}

bool fitted(const NoiseCalibration& result, const std::string& name)
{
  for (const CoefficientReport& report : result.coefficients)
    if (report.name == name)
    {
      EXPECT_FALSE(report.reason.empty()) << name;
      return report.fitted;
    }
  ADD_FAILURE() << "nothing is said of " << name;
  return false;
}

SyntheticWall roughSensor()
{
  SyntheticWall wall;
  wall.sensor.axial_constant_m = 0.002;
  wall.sensor.axial_quadratic_per_m = 0.004;
  wall.sensor.axial_grazing_m_sqrt_m = 0.0003;
  wall.sensor.lateral_constant_px = 1.3;
  wall.poses = walk(0.7, 2.2, 72 * DEG, 24);
  return wall;
}

TEST(NoiseCalibration, RecoversTheSensor)
{
  const SyntheticWall wall = roughSensor();
  const NoiseCalibration result = calibrate(wall);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_GE(result.used_count, 20);
  EXPECT_TRUE(fitted(result, "axial_constant_m") && fitted(result, "axial_quadratic_per_m"));
  EXPECT_TRUE(fitted(result, "axial_grazing_m_sqrt_m") && fitted(result, "lateral_constant_px"));
  EXPECT_FALSE(fitted(result, "depth_distortion_ratio") || fitted(result, "depth_bias_linear_ratio"));
  for (const NoiseBin& bin : result.bins)
  {
    const double truth_m = wall.sensor.axialSigma_m(bin.z_m, bin.theta_rad);
    EXPECT_NEAR(bin.sigma_m, truth_m, 0.12 * truth_m) << bin.z_m << " m, " << bin.theta_rad / DEG << " deg";
    EXPECT_NEAR(bin.fitted_sigma_m, truth_m, 0.1 * truth_m) << bin.z_m << " m, " << bin.theta_rad / DEG << " deg";
  }
  for (const double z_m : { 0.7, 1.0, 1.5, 2.2 })
    EXPECT_NEAR(result.model.axialSigma_m(z_m, 0), wall.sensor.axialSigma_m(z_m, 0),
                0.03 * wall.sensor.axialSigma_m(z_m, 0));
  EXPECT_NEAR(result.model.lateral_constant_px, 1.3, 0.1);
  EXPECT_EQ(result.model.depth_bias_linear_ratio, 0);
}

TEST(NoiseCalibration, TellsDistortionFromNoise)
{
  SyntheticWall wall = roughSensor();
  for (int row = 0; row < rgbd::DistortionGrid::ROWS; ++row)
    for (int column = 0; column < rgbd::DistortionGrid::COLUMNS; ++column)
      wall.sensor.depth_distortion_ratio[row * rgbd::DistortionGrid::COLUMNS + column] =
          0.004 * std::sin(1.3 * column) * std::cos(1.1 * row);
  const NoiseCalibration result = calibrate(wall);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  ASSERT_TRUE(fitted(result, "depth_distortion_ratio"));
  EXPECT_GT(result.flatness_before_ratio, 0.001);
  EXPECT_LT(result.flatness_after_ratio, 0.4 * result.flatness_before_ratio);
  EXPECT_NEAR(result.model.axialSigma_m(1.5, 0), wall.sensor.axialSigma_m(1.5, 0), 0.0004);
  // Up to what a wall cannot show (a plane), inside the image, where blocks lie.
  double difference = 0, size = 0;
  for (double v = 60; v < 420; v += 20)
    for (double u = 80; u < 560; u += 20)
    {
      const double truth = rgbd::DistortionGrid::ratioAt(wall.sensor.depth_distortion_ratio, u, v, 640, 480);
      difference +=
          std::pow(rgbd::DistortionGrid::ratioAt(result.model.depth_distortion_ratio, u, v, 640, 480) - truth, 2);
      size += truth * truth;
    }
  EXPECT_LT(difference, 0.25 * size);
}

TEST(NoiseCalibration, MeasuredDistancesTellTheBias)
{
  SyntheticWall wall = roughSensor();
  wall.sensor.depth_bias_constant_m = 0.003;
  wall.sensor.depth_bias_linear_ratio = -0.004;
  wall.sensor.depth_bias_quadratic_per_m = 0.005;
  wall.poses = walk(0.7, 2.2, 12 * DEG, 10);
  std::vector<MeasuredDistance> distances;
  for (std::size_t i = 0; i < wall.poses.size(); ++i)
    distances.push_back(
        { 100.0 + static_cast<double>(i), wall.poses[i].distance_m * std::cos(wall.poses[i].tilt_rad) });
  const NoiseCalibration result = calibrate(wall, distances);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(fitted(result, "depth_bias_quadratic_per_m"));
  for (const double z_m : { 0.8, 1.5, 2.1 })
    EXPECT_NEAR(result.model.depthBias_m(z_m), wall.sensor.depthBias_m(z_m), 0.0015) << z_m;

  distances.resize(1);
  const NoiseCalibration one = calibrate(wall, distances);
  EXPECT_TRUE(fitted(one, "depth_bias_constant_m"));
  EXPECT_FALSE(fitted(one, "depth_bias_linear_ratio"));
  EXPECT_THROW(calibrate(wall, { { 7, 1.0 } }), base::Error);
}

TEST(NoiseCalibration, BearsHolesAndOutliers)
{
  SyntheticWall wall = roughSensor();
  wall.poses = walk(0.8, 2.0, 30 * DEG, 16);
  wall.missing_ratio = 0.15;
  wall.outlier_ratio = 0.02;
  const NoiseCalibration result = calibrate(wall);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  for (const double z_m : { 0.8, 1.4, 2.0 })
    EXPECT_NEAR(result.model.axialSigma_m(z_m, 0), wall.sensor.axialSigma_m(z_m, 0),
                0.08 * wall.sensor.axialSigma_m(z_m, 0));
}

TEST(NoiseCalibration, WhatWasNotSeenKeepsItsDefault)
{
  SyntheticWall wall = roughSensor();
  wall.poses = walk(0.6, 0.65, 10 * DEG, 12);  // no rim in view either
  const NoiseCalibration result = calibrate(wall);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(fitted(result, "axial_constant_m"));
  for (const char* name : { "axial_quadratic_per_m", "axial_grazing_m_sqrt_m", "lateral_constant_px",
                            "lateral_grazing_px", "depth_bias_constant_m" })
    EXPECT_FALSE(fitted(result, name)) << name;
  const rgbd::SensorNoiseModel model;
  EXPECT_EQ(result.model.axial_quadratic_per_m, model.axial_quadratic_per_m);
  EXPECT_EQ(result.model.lateral_constant_px, model.lateral_constant_px);
  EXPECT_NEAR(result.model.axialSigma_m(0.62, 0), wall.sensor.axialSigma_m(0.62, 0), 0.0002);
}

TEST(NoiseCalibration, RefusesWhatShowsNoWall)
{
  SyntheticWall wall = roughSensor();
  wall.poses = walk(0.8, 1.5, 0.3, 4);
  NoiseCalibration result = calibrate(wall);
  EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(result.status.message.find("4 of 4 frames show a wall, 10 are needed"), std::string::npos)
      << result.status.message;
  wall.clutter_ratio = 1;
  result = calibrate(wall);
  EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
  EXPECT_EQ(result.used_count, 0);
  EXPECT_EQ(result.unused.size(), 1u) << result.status.message;
  wall.clutter_ratio = 0;
  wall.missing_ratio = 1;
  EXPECT_EQ(calibrate(wall).status.code, base::StatusCode::NO_RESULT);
}

TEST(NoiseCalibration, SameInputSameBits)
{
  SyntheticWall wall = roughSensor();
  wall.poses = walk(0.7, 1.6, 40 * DEG, 12);
  const NoiseCalibration a = calibrate(wall), b = calibrate(wall);
  EXPECT_TRUE(a.model == b.model);
  ASSERT_EQ(a.bins.size(), b.bins.size());
  for (std::size_t i = 0; i < a.bins.size(); ++i)
    EXPECT_EQ(a.bins[i].sigma_m, b.bins[i].sigma_m);
}

TEST(NoiseCalibration, CanBeCancelled)
{
  SyntheticWallSource source(roughSensor());
  base::JobControl control;
  control.cancel();
  EXPECT_THROW(calibrateNoise(source, {}, {}, control), base::Cancelled);
}

TEST(NoiseCalibration, RefusesBadOptions)
{
  SyntheticWallSource source(roughSensor());
  base::JobControl control;
  NoiseCalibrationOptions options;
  options.min_wall_ratio = 0;
  options.min_frames = 0;
  EXPECT_EQ(test_support::namesOf(options.violations()), (std::vector<std::string>{ "min_frames", "min_wall_ratio" }));
  EXPECT_THROW(calibrateNoise(source, {}, options, control), base::Error);
}

TEST(MeasuredDistances, AreReadOrRefusedWithTheLine)
{
  const test_support::TempDir folder;
  const std::string path = folder.path("distances.txt");
  std::ofstream(path) << "# tape\n100.5 1.25\n\n101 2 # far\n";
  const std::vector<MeasuredDistance> distances = readMeasuredDistances(path);
  ASSERT_EQ(distances.size(), 2u);
  EXPECT_EQ(distances[1].distance_m, 2);
  for (const char* text : { "100\n", "100 x\n", "100 -1\n", "100 1 2\n", "# nothing\n" })
  {
    std::ofstream(path, std::ios::trunc) << text;
    EXPECT_THROW(readMeasuredDistances(path), base::Error) << text;
  }
}

}  // namespace
}  // namespace object_modelling::calibration
