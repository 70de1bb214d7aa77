#pragma once

#include <memory>
#include <string>
#include <vector>

#include "object_modelling/source/frame_source.h"

namespace object_modelling::source
{
/// A scene of a data set of the BOP benchmark (Hodan et al., BOP: Benchmark for 6D Object Pose Estimation, ECCV 2018):
/// rgb/ or gray/, depth/, and scene_camera.json with cam_K and depth_scale (mm per unit) of every image.
bool isBopScene(const std::string& folder);

/// Numbers of its images, ascending: those of scene_camera.json. Throws base::Error (NOT_FOUND, BAD_INPUT).
std::vector<int> bopImageNumbers(const std::string& folder);

/// Its images in the order of their numbers, as a recording at 30 Hz: BOP keeps no stamps. Throws base::Error:
/// NOT_FOUND for missing files, BAD_INPUT naming file and reason for malformed ones.
std::unique_ptr<FrameSource> openBopScene(const std::string& folder);

}  // namespace object_modelling::source
