#include "object_modelling/rgbd/noise_model_file.h"

#include <yaml-cpp/yaml.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "noise_model_fields.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/options.h"
#include "object_modelling/base/yaml_number.h"

namespace object_modelling::rgbd
{
namespace
{
using base::Error;
using base::StatusCode;

constexpr char DISTORTION[] = "depth_distortion_ratio";
constexpr char NOISE_MODEL[] = "noise_model";
constexpr char COLOR_OFFSET[] = "color_offset_px";
constexpr char CORRECTION[] = "correction";

void emitDistortion(YAML::Emitter& out, const DistortionGrid::Ratios& ratios)
{
  if (ratios == DistortionGrid::Ratios{})
    return;
  out << YAML::Key << DISTORTION << YAML::Value << YAML::BeginSeq;
  for (int row = 0; row < DistortionGrid::ROWS; ++row)
  {
    out << YAML::Flow << YAML::BeginSeq;
    for (int column = 0; column < DistortionGrid::COLUMNS; ++column)
      out << base::yamlNumber(ratios[row * DistortionGrid::COLUMNS + column]);
    out << YAML::EndSeq;
  }
  out << YAML::EndSeq;
}

void emit(YAML::Emitter& out, const SensorNoiseModel& model)
{
  out << YAML::BeginMap;
  for (const NoiseModelField& field : NOISE_MODEL_FIELDS)
    out << YAML::Key << field.key << YAML::Value << base::yamlNumber(model.*field.value);
  emitDistortion(out, model.depth_distortion_ratio);
  out << YAML::EndMap;
}

[[noreturn]] void refuse(const std::string& what, const std::string& reason)
{
  throw Error(StatusCode::BAD_INPUT, what + ": " + reason);
}

std::string knownKeys()
{
  std::string keys;
  for (const NoiseModelField& field : NOISE_MODEL_FIELDS)
    keys += std::string(field.key) + ", ";
  return keys + DISTORTION;
}

DistortionGrid::Ratios distortionFrom(const YAML::Node& node, const std::string& what)
{
  DistortionGrid::Ratios distortion{};
  bool fits = node.IsSequence() && node.size() == DistortionGrid::ROWS;
  for (std::size_t row = 0; fits && row < node.size(); ++row)
  {
    fits = node[row].IsSequence() && node[row].size() == DistortionGrid::COLUMNS;
    for (std::size_t column = 0; fits && column < node[row].size(); ++column)
    {
      const auto ratio = node[row][column].as<double>();
      fits = fits && std::isfinite(ratio);
      distortion[row * DistortionGrid::COLUMNS + column] = ratio;
    }
  }
  if (!fits)
    refuse(what, std::string(DISTORTION) + " must be " + std::to_string(DistortionGrid::ROWS) + " rows of " +
                     std::to_string(DistortionGrid::COLUMNS) + " finite numbers");
  return distortion;
}

SensorNoiseModel modelFrom(const YAML::Node& node, const std::string& what)
{
  if (!node.IsMap())
    refuse(what, "must be a map of coefficients; known are " + knownKeys());
  SensorNoiseModel model;
  for (const auto& entry : node)
  {
    const auto key = entry.first.as<std::string>();
    const auto* field = std::find_if(std::begin(NOISE_MODEL_FIELDS), std::end(NOISE_MODEL_FIELDS),
                                     [&](const NoiseModelField& known) { return key == known.key; });
    if (field != std::end(NOISE_MODEL_FIELDS))
      model.*field->value = entry.second.as<double>();
    else if (key == DISTORTION)
      model.depth_distortion_ratio = distortionFrom(entry.second, what);
    else
      refuse(what, "'" + key + "' is no coefficient of the noise model; known are " + knownKeys());
  }
  try
  {
    return base::checked(model);
  }
  catch (const Error& error)
  {
    refuse(what, error.what());
  }
}

/// All numbers in a row, as they stand in the struct.
void emit(YAML::Emitter& out, const SensorCorrection& correction)
{
  out << YAML::Key << CORRECTION << YAML::Value << YAML::Flow << YAML::BeginMap;
  const auto number = [&](const char* key, double value)
  { out << YAML::Key << key << YAML::Value << base::yamlNumber(value); };
  number("focal_ratio_x", correction.focal_ratio.x());
  number("focal_ratio_y", correction.focal_ratio.y());
  number("principal_shift_x_px", correction.principal_shift_px.x());
  number("principal_shift_y_px", correction.principal_shift_px.y());
  number("depth_ratio", correction.depth_ratio);
  number("depth_offset_m", correction.depth_offset_m);
  emitDistortion(out, correction.depth_distortion_ratio);
  out << YAML::EndMap;
}

SensorCorrection correctionFrom(const YAML::Node& node, const std::string& what)
{
  const auto number = [&](const char* key)
  {
    if (!node.IsMap() || !node[key])
      refuse(what, std::string(CORRECTION) + " has no " + key);
    const auto value = node[key].as<double>();
    if (!std::isfinite(value))
      refuse(what, std::string(CORRECTION) + ": " + key + " is not finite");
    return value;
  };
  SensorCorrection correction;
  correction.focal_ratio = { number("focal_ratio_x"), number("focal_ratio_y") };
  correction.principal_shift_px = { number("principal_shift_x_px"), number("principal_shift_y_px") };
  correction.depth_ratio = number("depth_ratio");
  correction.depth_offset_m = number("depth_offset_m");
  if (node[DISTORTION])
    correction.depth_distortion_ratio = distortionFrom(node[DISTORTION], what);
  if (!(correction.focal_ratio.minCoeff() > 0 && correction.depth_ratio > 0))
    refuse(what, std::string(CORRECTION) + ": ratios must be positive");
  return correction;
}

/// Calls `read` with the parsed text; what yaml-cpp throws becomes BAD_INPUT.
template <typename Read>
auto parsed(const std::string& text, const std::string& what, const Read& read)
{
  try
  {
    return read(YAML::Load(text));
  }
  catch (const YAML::Exception& error)
  {
    refuse(what, error.what());
  }
}

}  // namespace

SensorNoiseModel loadNoiseModel(const std::string& path)
{
  return parsed(base::readTextFile(path), path, [&](const YAML::Node& node) { return modelFrom(node, path); });
}

void saveNoiseModel(const std::string& path, const SensorNoiseModel& model, const std::string& comment)
{
  std::string text;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);)
    text += line.empty() ? "#\n" : "# " + line + "\n";
  YAML::Emitter out;
  emit(out, model);
  base::writeTextFile(path, text + out.c_str() + "\n");
}

std::string calibrationText(const SensorCalibration& calibration)
{
  YAML::Emitter out;
  out << YAML::BeginMap << YAML::Key << NOISE_MODEL << YAML::Value;
  emit(out, calibration.noise_model);
  out << YAML::Key << COLOR_OFFSET << YAML::Value << YAML::Flow << YAML::BeginSeq
      << base::yamlNumber(calibration.color_offset_px.x()) << base::yamlNumber(calibration.color_offset_px.y())
      << YAML::EndSeq;
  if (!(calibration.correction == SensorCorrection()))
    emit(out, calibration.correction);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

SensorCalibration calibrationFromText(const std::string& text, const std::string& what)
{
  return parsed(text, what,
                [&](const YAML::Node& node)
                {
                  if (!node.IsMap())
                    refuse(what, "must be a map of noise_model and color_offset_px");
                  SensorCalibration calibration;
                  for (const auto& entry : node)
                  {
                    const auto key = entry.first.as<std::string>();
                    if (key == NOISE_MODEL)
                      calibration.noise_model = modelFrom(entry.second, what);
                    else if (key == COLOR_OFFSET && entry.second.IsSequence() && entry.second.size() == 2)
                      calibration.color_offset_px = { entry.second[0].as<double>(), entry.second[1].as<double>() };
                    else if (key == CORRECTION)
                      calibration.correction = correctionFrom(entry.second, what);
                    else
                      refuse(what, "'" + key + "' is not known or not of the form it must have");
                  }
                  if (!calibration.color_offset_px.allFinite())
                    refuse(what, "color_offset_px is not finite");
                  return calibration;
                });
}

}  // namespace object_modelling::rgbd
