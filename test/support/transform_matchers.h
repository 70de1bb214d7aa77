#pragma once

#include <gtest/gtest.h>

#include "object_modelling/geometry/transform.h"

namespace object_modelling::test_support
{
/// Passes if the transforms' origins and rotations differ by no more than the tolerances; a failure prints by how much.
inline ::testing::AssertionResult transformsAreNear(const char* text_a, const char* text_b, const char*, const char*,
                                                    const Eigen::Isometry3d& T_x_a, const Eigen::Isometry3d& T_x_b,
                                                    double meters, double radians)
{
  const double distance_m = (T_x_a.translation() - T_x_b.translation()).norm();
  const double angle_rad = geometry::rotationAngle_rad(T_x_a.inverse(Eigen::Isometry) * T_x_b);
  if (distance_m <= meters && angle_rad <= radians)
    return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << text_a << " and " << text_b << " differ by " << distance_m << " m (allowed "
                                       << meters << ") and " << angle_rad << " rad (allowed " << radians << ")\n"
                                       << T_x_a.matrix() << "\n\n"
                                       << T_x_b.matrix();
}

}  // namespace object_modelling::test_support

#define EXPECT_TRANSFORM_NEAR(T_x_a, T_x_b, meters, radians) \
  EXPECT_PRED_FORMAT4(::object_modelling::test_support::transformsAreNear, T_x_a, T_x_b, meters, radians)
#define ASSERT_TRANSFORM_NEAR(T_x_a, T_x_b, meters, radians) \
  ASSERT_PRED_FORMAT4(::object_modelling::test_support::transformsAreNear, T_x_a, T_x_b, meters, radians)
