#pragma once

#include "object_modelling/rgbd/keyframe.h"
#include "object_modelling/rgbd/sensor_correction.h"

namespace object_modelling::rgbd
{
/// The frame as a right sensor had given it. Shares the images that stay as they are.
Frame corrected(const Frame& frame, const SensorCorrection& correction);
/// The same with the depths of its observations.
Keyframe corrected(const Keyframe& keyframe, const SensorCorrection& correction);

}  // namespace object_modelling::rgbd
