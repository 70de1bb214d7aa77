#pragma once

#include "support/synthetic_scene.h"

namespace object_modelling::test_support
{
/// Turns the true colour and depth of `image` (already in its frame) into what a sensor reads.
void addSensorNoise(const SensorNoise& noise, SceneImage* image);

}  // namespace object_modelling::test_support
