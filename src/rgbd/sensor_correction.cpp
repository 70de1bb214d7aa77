#include "object_modelling/rgbd/corrected.h"

namespace object_modelling::rgbd
{
bool SensorCorrection::isIdentity() const
{
  return focal_ratio == Eigen::Vector2d::Ones() && principal_shift_px.isZero(0) && depth_ratio == 1 &&
         depth_offset_m == 0 && depth_distortion_ratio == DistortionGrid::Ratios{};
}

SensorCorrection SensorCorrection::then(const SensorCorrection& rest) const
{
  SensorCorrection both = rest;
  both.focal_ratio = focal_ratio.cwiseProduct(rest.focal_ratio);
  both.principal_shift_px = principal_shift_px + rest.principal_shift_px;
  both.depth_ratio = depth_ratio * rest.depth_ratio;
  // What the rest's distortion does to the first offset, micrometres, is left out.
  for (int i = 0; i < DistortionGrid::KNOTS; ++i)
    both.depth_distortion_ratio[i] += depth_distortion_ratio[i] * (1 - rest.depth_distortion_ratio[i]);
  both.depth_offset_m = rest.depth_ratio * depth_offset_m + rest.depth_offset_m;
  return both;
}

bool SensorCorrection::operator==(const SensorCorrection& other) const
{
  return focal_ratio == other.focal_ratio && principal_shift_px == other.principal_shift_px &&
         depth_ratio == other.depth_ratio && depth_offset_m == other.depth_offset_m &&
         depth_distortion_ratio == other.depth_distortion_ratio;
}

Keyframe corrected(const Keyframe& keyframe, const SensorCorrection& correction)
{
  Keyframe result = keyframe;
  result.frame = corrected(keyframe.frame, correction);
  const geometry::PinholeCamera& camera = keyframe.frame.camera;
  for (Observation& observation : result.observations)
  {
    const double distortion = DistortionGrid::ratioAt(correction.depth_distortion_ratio, observation.pixel.x(),
                                                      observation.pixel.y(), camera.width, camera.height);
    observation.depth_m =
        static_cast<float>(correction.depth_ratio * (1 - distortion) * observation.depth_m + correction.depth_offset_m);
  }
  return result;
}

Frame corrected(const Frame& frame, const SensorCorrection& correction)
{
  Frame result = frame;
  result.camera.fx *= correction.focal_ratio.x();
  result.camera.fy *= correction.focal_ratio.y();
  result.camera.cx += correction.principal_shift_px.x();
  result.camera.cy += correction.principal_shift_px.y();
  // The pixels of the frame given are not written to: others share them.
  cv::Mat depth_m = frame.depth_m;
  if (correction.depth_distortion_ratio != DistortionGrid::Ratios{} && !frame.depth_m.empty())
  {
    depth_m = cv::Mat();
    cv::multiply(frame.depth_m, 1 - DistortionGrid::image(correction.depth_distortion_ratio, frame.depth_m.size()),
                 depth_m);
  }
  if (correction.depth_ratio != 1 || correction.depth_offset_m != 0)
  {
    result.depth_m = cv::Mat();
    depth_m.convertTo(result.depth_m, CV_32F, correction.depth_ratio, correction.depth_offset_m);
  }
  else
    result.depth_m = depth_m;
  return result;
}

}  // namespace object_modelling::rgbd
