#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "recording.h"

namespace object_modelling::nodes
{
/// Picture of one frame for people: a border in the colour of the state, the newest keyframe's landmarks where the
/// estimated pose puts them (they sit on their corners as long as the pose is right), the outline of what is tracked in
/// object mode, figures. Not thread safe.
class DebugImage
{
public:
  void setKeyframe(const rgbd::Keyframe& keyframe);
  cv::Mat draw(const TrackedFrame& tracked) const;

private:
  std::vector<Eigen::Vector3d> landmarks_session_;
};

}  // namespace object_modelling::nodes
