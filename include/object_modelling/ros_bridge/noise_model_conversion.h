#pragma once

#include <object_modelling/SensorCalibration.h>
#include <object_modelling/SensorNoiseModel.h>

#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::ros_bridge
{
object_modelling::SensorNoiseModel toMessage(const rgbd::SensorNoiseModel& model);
object_modelling::SensorCalibration toMessage(const rgbd::SensorCalibration& calibration);

/// Throw base::Error (INVALID_ARGUMENT) naming every coefficient that is out of its bound.
rgbd::SensorNoiseModel fromMessage(const object_modelling::SensorNoiseModel& message);
rgbd::SensorCalibration fromMessage(const object_modelling::SensorCalibration& message);

}  // namespace object_modelling::ros_bridge
