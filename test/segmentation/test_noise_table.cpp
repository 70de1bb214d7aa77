#include "noise_table.h"

#include <cmath>

#include <gtest/gtest.h>

#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::segmentation
{
TEST(NoiseTable, AgreesWithTheModel)
{
  const NoiseTable table{ rgbd::SensorNoiseModel() };
  for (const double z_m : { 0.5, 0.8, 1.0, 2.0, 4.0 })
    for (const double theta_rad : { 0.0, 0.5, 1.0, 1.2 })
    {
      const double expected_m = rgbd::SensorNoiseModel().axialSigma_m(z_m, theta_rad);
      EXPECT_NEAR(table.sigma_m(static_cast<float>(z_m), static_cast<float>(std::cos(theta_rad))), expected_m,
                  0.05 * expected_m)
          << z_m << " m, " << theta_rad << " rad";
    }
}

TEST(NoiseTable, EveryModelHasItsOwn)
{
  rgbd::SensorNoiseModel rough;
  rough.axial_constant_m *= 2;
  rough.axial_quadratic_per_m *= 2;
  const std::shared_ptr<const NoiseTable> table = NoiseTable::of({}), same = NoiseTable::of({});
  EXPECT_EQ(table, same);
  EXPECT_FLOAT_EQ(NoiseTable::of(rough)->sigma_m(1, 1), 2 * table->sigma_m(1, 1));
  for (int i = 0; i < 10; ++i, rough.axial_constant_m *= 1.1)
    EXPECT_NE(NoiseTable::of(rough), table);
  EXPECT_EQ(NoiseTable::of({})->sigma_m(1, 1), table->sigma_m(1, 1));
}

TEST(NoiseTable, StaysFiniteOutsideItsRange)
{
  const NoiseTable table{ rgbd::SensorNoiseModel() };
  for (const float z_m : { -1.0F, 0.0F, 100.0F })
    for (const float cos_theta : { -1.0F, 0.0F, 1.0F, 2.0F })
      EXPECT_TRUE(std::isfinite(table.sigma_m(z_m, cos_theta)));
}

TEST(NoiseTable, NoiseAlongASlantedNormalIsSmaller)
{
  const NoiseTable table{ rgbd::SensorNoiseModel() };
  const Eigen::Vector3f p(0, 0, 1);
  const float facing_m = table.sigmaAlong_m({ 0, 0, -1 }, p);
  const float slanted_m = table.sigmaAlong_m({ 0, std::sin(1.0F), -std::cos(1.0F) }, p);
  EXPECT_NEAR(slanted_m, facing_m * std::cos(1.0F), 0.02F * facing_m);
}

}  // namespace object_modelling::segmentation
