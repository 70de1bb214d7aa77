#pragma once

#include <filesystem>
#include <string>

#include "object_modelling/keyframes/session_store.h"
#include "support/temp_dir.h"
#include "support/thrown_status.h"

namespace object_modelling::keyframes
{
/// A temporary folder in which other users may write too: a server, or one who may not write elsewhere.
class TemporaryFolder : public test_support::TempDir
{
public:
  TemporaryFolder() { std::filesystem::permissions(path(), std::filesystem::perms::all); }
};

/// A keyframe with a textured image, slanted depth with holes, masks and observations; another for every id.
rgbd::Keyframe makeKeyframe(int id, int width = 64, int height = 48);
Session makeSession(const std::string& id);
/// No two coefficients alike, none the default.
rgbd::SensorCalibration makeCalibration();

/// Largest difference of depth in m; infinite where only one of them is missing.
double depthDifference_m(const cv::Mat& a, const cv::Mat& b);
/// Everything but the depth image, exactly.
void expectSame(const rgbd::Keyframe& actual, const rgbd::Keyframe& expected);

using test_support::statusOf;

}  // namespace object_modelling::keyframes
