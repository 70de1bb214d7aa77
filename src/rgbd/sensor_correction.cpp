#include "object_modelling/rgbd/corrected.h"

namespace object_modelling::rgbd
{
bool SensorCorrection::isIdentity() const
{
  return focal_ratio == Eigen::Vector2d::Ones() && principal_shift_px.isZero(0) && depth_ratio == 1 &&
         depth_offset_m == 0;
}

SensorCorrection SensorCorrection::then(const SensorCorrection& rest) const
{
  SensorCorrection both = rest;
  both.focal_ratio = focal_ratio.cwiseProduct(rest.focal_ratio);
  both.principal_shift_px = principal_shift_px + rest.principal_shift_px;
  both.depth_ratio = depth_ratio * rest.depth_ratio;
  both.depth_offset_m = rest.depth_ratio * depth_offset_m + rest.depth_offset_m;
  return both;
}

bool SensorCorrection::operator==(const SensorCorrection& other) const
{
  return focal_ratio == other.focal_ratio && principal_shift_px == other.principal_shift_px &&
         depth_ratio == other.depth_ratio && depth_offset_m == other.depth_offset_m;
}

Keyframe corrected(const Keyframe& keyframe, const SensorCorrection& correction)
{
  Keyframe result = keyframe;
  result.frame = corrected(keyframe.frame, correction);
  for (Observation& observation : result.observations)
    observation.depth_m = static_cast<float>(correction.depth_ratio * observation.depth_m + correction.depth_offset_m);
  return result;
}

Frame corrected(const Frame& frame, const SensorCorrection& correction)
{
  Frame result = frame;
  result.camera.fx *= correction.focal_ratio.x();
  result.camera.fy *= correction.focal_ratio.y();
  result.camera.cx += correction.principal_shift_px.x();
  result.camera.cy += correction.principal_shift_px.y();
  if (correction.depth_ratio != 1 || correction.depth_offset_m != 0)
  {
    result.depth_m = cv::Mat();  // else the pixels of the frame given would be written to
    frame.depth_m.convertTo(result.depth_m, CV_32F, correction.depth_ratio, correction.depth_offset_m);
  }
  return result;
}

}  // namespace object_modelling::rgbd
