#pragma once

#include <string>

#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::rgbd
{
/// Noise model as a YAML map from the names of its coefficients (docs/noise_model.md) to numbers. A coefficient that is
/// not there has its default. Throws base::Error: NOT_FOUND (no file), BAD_INPUT (not YAML, a key that is none, a value
/// out of its bound; all of them named).
SensorNoiseModel loadNoiseModel(const std::string& path);
/// `comment` goes before it, every line marked as a comment. Throws base::Error (STORAGE).
void saveNoiseModel(const std::string& path, const SensorNoiseModel& model, const std::string& comment);

/// A calibration as YAML: noise_model (as above) and color_offset_px. `what` names the text in messages; throws as
/// loadNoiseModel does. Text to calibration and back gives the same numbers.
std::string calibrationText(const SensorCalibration& calibration);
SensorCalibration calibrationFromText(const std::string& text, const std::string& what);

}  // namespace object_modelling::rgbd
