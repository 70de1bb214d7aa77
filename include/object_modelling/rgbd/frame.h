#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "object_modelling/geometry/pinhole_camera.h"
#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::rgbd
{
/// One rectified colour image and the depth image registered to it. Images are shared, never written to after the frame
/// has been made: copying a Frame copies no pixels.
struct Frame
{
  double stamp_s = 0;              ///< time of the colour image
  double depth_delay_s = 0;        ///< time of the depth image minus that of the colour image
  cv::Mat color_bgr;               ///< CV_8UC3
  cv::Mat gray;                    ///< CV_8UC1, of color_bgr
  cv::Mat depth_m;                 ///< CV_32FC1, along the optical axis; NaN where missing
  cv::Mat object_mask;             ///< CV_8UC1, 255 on the object; empty where not known
  cv::Mat moving_mask;             ///< the same for the object with the turntable that moves with it
  geometry::PinholeCamera camera;  ///< rectified: no distortion
  SensorNoiseModel noise_model;    ///< of the sensor; its bias has been taken off depth_m

  /// What moves with the object, as far as it is known.
  const cv::Mat& trackedMask() const { return moving_mask.empty() ? object_mask : moving_mask; }
  float depthAt_m(int u, int v) const { return depth_m.at<float>(v, u); }
  /// Optical-frame point of an integer pixel; NaN where depth is missing.
  Eigen::Vector3f point(int u, int v) const
  {
    const float z = depthAt_m(u, v);
    return { static_cast<float>((u - camera.cx) / camera.fx) * z, static_cast<float>((v - camera.cy) / camera.fy) * z,
             z };
  }
};

}  // namespace object_modelling::rgbd
