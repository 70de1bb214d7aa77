#include "object_modelling/ros_bridge/noise_model_conversion.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/base/options.h"

namespace object_modelling::ros_bridge
{
namespace
{
/// The coefficients of model and message go by the same names; `copy` gets both for each.
template <typename Model, typename Message, typename Copy>
void forEachCoefficient(Model& model, Message& message, const Copy& copy)
{
  copy(model.axial_constant_m, message.axial_constant_m);
  copy(model.axial_quadratic_per_m, message.axial_quadratic_per_m);
  copy(model.axial_vertex_m, message.axial_vertex_m);
  copy(model.axial_grazing_m_sqrt_m, message.axial_grazing_m_sqrt_m);
  copy(model.axial_grazing_from_rad, message.axial_grazing_from_rad);
  copy(model.lateral_constant_px, message.lateral_constant_px);
  copy(model.lateral_grazing_px, message.lateral_grazing_px);
  copy(model.depth_bias_constant_m, message.depth_bias_constant_m);
  copy(model.depth_bias_linear_ratio, message.depth_bias_linear_ratio);
  copy(model.depth_bias_quadratic_per_m, message.depth_bias_quadratic_per_m);
  copy(model.color_offset_x_px, message.color_offset_x_px);
  copy(model.color_offset_y_px, message.color_offset_y_px);
}

std::vector<double> toMessage(const rgbd::DistortionGrid::Ratios& ratios)
{
  if (ratios == rgbd::DistortionGrid::Ratios{})
    return {};
  return { ratios.begin(), ratios.end() };
}

rgbd::DistortionGrid::Ratios distortionFrom(const std::vector<double>& knots, const std::string& what)
{
  rgbd::DistortionGrid::Ratios ratios{};
  if (!knots.empty() && knots.size() != ratios.size())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, what + ": depth_distortion_ratio has " +
                                                              std::to_string(knots.size()) + " knots; it must have " +
                                                              std::to_string(ratios.size()) + " or none");
  if (!std::all_of(knots.begin(), knots.end(), [](double knot) { return std::isfinite(knot); }))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      what + ": depth_distortion_ratio has a knot that is not finite");
  std::copy(knots.begin(), knots.end(), ratios.begin());
  return ratios;
}
}  // namespace

object_modelling::SensorNoiseModel toMessage(const rgbd::SensorNoiseModel& model)
{
  object_modelling::SensorNoiseModel message;
  forEachCoefficient(model, message, [](double from, double& to) { to = from; });
  message.depth_distortion_ratio = toMessage(model.depth_distortion_ratio);
  return message;
}

object_modelling::SensorCalibration toMessage(const rgbd::SensorCalibration& calibration)
{
  object_modelling::SensorCalibration message;
  message.noise_model = toMessage(calibration.noise_model);
  message.color_offset_px[0] = calibration.color_offset_px.x();
  message.color_offset_px[1] = calibration.color_offset_px.y();
  const rgbd::SensorCorrection& correction = calibration.correction;
  message.focal_ratio = { correction.focal_ratio.x(), correction.focal_ratio.y() };
  message.principal_shift_px = { correction.principal_shift_px.x(), correction.principal_shift_px.y() };
  message.depth_ratio = correction.depth_ratio;
  message.depth_offset_m = correction.depth_offset_m;
  message.depth_distortion_ratio = toMessage(correction.depth_distortion_ratio);
  return message;
}

rgbd::SensorNoiseModel fromMessage(const object_modelling::SensorNoiseModel& message)
{
  rgbd::SensorNoiseModel model;
  forEachCoefficient(model, message, [](double& to, double from) { to = from; });
  model.depth_distortion_ratio = distortionFrom(message.depth_distortion_ratio, "noise_model");
  return base::checked(model);
}

rgbd::SensorCalibration fromMessage(const object_modelling::SensorCalibration& message)
{
  rgbd::SensorCorrection correction;
  correction.focal_ratio = { message.focal_ratio[0], message.focal_ratio[1] };
  correction.principal_shift_px = { message.principal_shift_px[0], message.principal_shift_px[1] };
  correction.depth_ratio = message.depth_ratio;
  correction.depth_offset_m = message.depth_offset_m;
  correction.depth_distortion_ratio = distortionFrom(message.depth_distortion_ratio, "calibration");
  if (!(correction.focal_ratio.minCoeff() > 0 && correction.depth_ratio > 0))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "calibration: focal_ratio and depth_ratio must be positive; 1 where nothing is known");
  return { fromMessage(message.noise_model), { message.color_offset_px[0], message.color_offset_px[1] }, correction };
}

}  // namespace object_modelling::ros_bridge
