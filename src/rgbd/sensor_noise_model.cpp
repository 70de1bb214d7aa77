#include "object_modelling/rgbd/sensor_noise_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "noise_model_fields.h"
#include "object_modelling/base/options.h"

namespace object_modelling::rgbd
{
namespace
{
constexpr double UNBOUNDED = std::numeric_limits<double>::infinity();
}  // namespace

double SensorNoiseModel::axialSigma_m(double z_m, double theta_rad) const
{
  if (theta_rad >= M_PI_2)
    return UNBOUNDED;
  const double beyond_m = z_m - axial_vertex_m;
  const double sigma = axial_constant_m + axial_quadratic_per_m * beyond_m * beyond_m;
  if (theta_rad <= axial_grazing_from_rad)
    return sigma;
  const double rest = M_PI_2 - theta_rad;
  return sigma + axial_grazing_m_sqrt_m / std::sqrt(z_m) * theta_rad * theta_rad / (rest * rest);
}

double SensorNoiseModel::lateralSigma_px(double theta_rad) const
{
  return theta_rad < M_PI_2 ? lateral_constant_px + lateral_grazing_px * theta_rad / (M_PI_2 - theta_rad) : UNBOUNDED;
}

double SensorNoiseModel::lateralSigma_m(double z_m, double theta_rad, double focal_px) const
{
  return lateralSigma_px(theta_rad) * z_m / focal_px;
}

double SensorNoiseModel::depthBias_m(double z_m) const
{
  return depth_bias_constant_m + z_m * (depth_bias_linear_ratio + z_m * depth_bias_quadratic_per_m);
}

bool SensorNoiseModel::correctsDepth() const
{
  return depth_bias_constant_m != 0 || depth_bias_linear_ratio != 0 || depth_bias_quadratic_per_m != 0 ||
         depth_distortion_ratio != DistortionGrid::Ratios{};
}

bool SensorNoiseModel::operator==(const SensorNoiseModel& other) const
{
  for (const NoiseModelField& field : NOISE_MODEL_FIELDS)
    if (this->*field.value != other.*field.value)
      return false;
  return depth_distortion_ratio == other.depth_distortion_ratio;
}

std::vector<std::string> SensorNoiseModel::violations() const
{
  base::OptionsCheck check("noise_model");
  for (const NoiseModelField& field : NOISE_MODEL_FIELDS)
    check.inRange(field.key, this->*field.value, field.low, field.high);
  for (std::size_t i = 0; i < depth_distortion_ratio.size(); ++i)
    check.inRange("depth_distortion_ratio[" + std::to_string(i) + "]", depth_distortion_ratio[i], -0.2, 0.2);
  return check.violations();
}

}  // namespace object_modelling::rgbd
