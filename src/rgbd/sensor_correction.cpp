#include "object_modelling/rgbd/sensor_correction.h"

namespace object_modelling::rgbd
{
bool SensorCorrection::isIdentity() const
{
  return focal_ratio == Eigen::Vector2d::Ones() && principal_shift_px.isZero(0) && depth_ratio == 1 &&
         depth_offset_m == 0;
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
