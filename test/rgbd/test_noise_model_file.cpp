#include "object_modelling/rgbd/noise_model_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temp_dir.h"
#include "support/thrown_status.h"

namespace object_modelling::rgbd
{
namespace
{
SensorNoiseModel unusual()
{
  SensorNoiseModel model;
  model.axial_constant_m = 0.002 + 1.0 / 3e4;
  model.lateral_grazing_px = 0.05;
  model.depth_bias_quadratic_per_m = -1.0 / 700;
  model.color_offset_y_px = -0.4;
  model.depth_distortion_ratio[10] = 1.0 / 3000;
  return model;
}

base::Status statusOf(const std::string& path)
{
  return test_support::statusOf([&] { loadNoiseModel(path); });
}

class NoiseModelFile : public ::testing::Test
{
protected:
  std::string write(const std::string& text) const
  {
    std::ofstream(path_) << text;
    return path_;
  }
  test_support::TempDir folder_;
  std::string path_ = folder_.path("noise.yaml");
};

TEST_F(NoiseModelFile, RoundTripIsExact)
{
  saveNoiseModel(path_, unusual(), "measured on\n\na wall");
  EXPECT_TRUE(loadNoiseModel(path_) == unusual());
  saveNoiseModel(path_, SensorNoiseModel(), "");
  EXPECT_TRUE(loadNoiseModel(path_) == SensorNoiseModel());
}

TEST_F(NoiseModelFile, WhatIsNotThereHasItsDefault)
{
  const SensorNoiseModel model = loadNoiseModel(write("axial_constant_m: 0.003\n"));
  EXPECT_EQ(model.axial_constant_m, 0.003);
  EXPECT_EQ(model.axial_quadratic_per_m, SensorNoiseModel().axial_quadratic_per_m);
}

TEST_F(NoiseModelFile, RefusesWhatItDoesNotKnow)
{
  base::Status status = statusOf(write("axial_constant: 0.003\n"));
  EXPECT_EQ(status.code, base::StatusCode::BAD_INPUT);
  EXPECT_NE(status.message.find("'axial_constant'"), std::string::npos) << status.message;
  EXPECT_NE(status.message.find("axial_constant_m"), std::string::npos) << status.message;
  status = statusOf(write("axial_constant_m: 0\nlateral_constant_px: -1\n"));
  EXPECT_EQ(status.code, base::StatusCode::BAD_INPUT);
  EXPECT_NE(status.message.find("axial_constant_m = 0"), std::string::npos) << status.message;
  EXPECT_NE(status.message.find("lateral_constant_px = -1"), std::string::npos) << status.message;
  for (const char* text : { "axial_constant_m: many\n", "axial_constant_m: .nan\n", "[1, 2]\n", "a: [\n", "7\n",
                            "depth_distortion_ratio: [1, 2]\n" })
    EXPECT_EQ(statusOf(write(text)).code, base::StatusCode::BAD_INPUT) << text;
  EXPECT_EQ(statusOf(folder_.path("none.yaml")).code, base::StatusCode::NOT_FOUND);
}

TEST(CalibrationText, RoundTripIsExact)
{
  SensorCalibration calibration;
  calibration.noise_model = unusual();
  calibration.color_offset_px = { 1.0 / 3, -0.1 };
  EXPECT_TRUE(calibrationFromText(calibrationText(calibration), "test") == calibration);
  calibration.correction.focal_ratio = { 1.01, 1.0 / 3 };
  calibration.correction.principal_shift_px = { -2.5, 0.1 };
  calibration.correction.depth_ratio = 0.99;
  calibration.correction.depth_offset_m = -0.0021;
  calibration.correction.depth_distortion_ratio[17] = 1e-3 / 3;
  EXPECT_TRUE(calibrationFromText(calibrationText(calibration), "test") == calibration);
  EXPECT_TRUE(calibrationFromText("{}", "test") == SensorCalibration());
}

TEST(CalibrationText, RefusesDamage)
{
  for (const char* text :
       { "", "color_offset_px: 1", "color_offset_px: [.nan, 0]", "gain: 2", "noise_model: 3", "correction: 1",
         "correction: {depth_ratio: 1}", "noise_model: {depth_distortion_ratio: [[0, .nan]]}", "{" })
    EXPECT_THROW(calibrationFromText(text, "test"), base::Error) << text;
}

}  // namespace
}  // namespace object_modelling::rgbd
