#pragma once

#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::rgbd
{
/// One coefficient: its key in YAML and the bounds of its value.
struct NoiseModelField
{
  const char* key;
  double SensorNoiseModel::*value;
  double low, high;
};

/// All of them; the distortion's knots apart.
constexpr NoiseModelField NOISE_MODEL_FIELDS[] = {
  { "axial_constant_m", &SensorNoiseModel::axial_constant_m, 1e-6, 0.1 },
  { "axial_quadratic_per_m", &SensorNoiseModel::axial_quadratic_per_m, 0, 1 },
  { "axial_vertex_m", &SensorNoiseModel::axial_vertex_m, 0, 10 },
  { "axial_grazing_m_sqrt_m", &SensorNoiseModel::axial_grazing_m_sqrt_m, 0, 0.1 },
  { "axial_grazing_from_rad", &SensorNoiseModel::axial_grazing_from_rad, 0, 1.57 },
  { "lateral_constant_px", &SensorNoiseModel::lateral_constant_px, 0, 20 },
  { "lateral_grazing_px", &SensorNoiseModel::lateral_grazing_px, 0, 20 },
  { "depth_bias_constant_m", &SensorNoiseModel::depth_bias_constant_m, -0.2, 0.2 },
  { "depth_bias_linear_ratio", &SensorNoiseModel::depth_bias_linear_ratio, -0.2, 0.2 },
  { "depth_bias_quadratic_per_m", &SensorNoiseModel::depth_bias_quadratic_per_m, -0.2, 0.2 },
  { "color_offset_x_px", &SensorNoiseModel::color_offset_x_px, -20, 20 },
  { "color_offset_y_px", &SensorNoiseModel::color_offset_y_px, -20, 20 },
};

}  // namespace object_modelling::rgbd
