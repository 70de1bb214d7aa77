#pragma once

#include <sensor_msgs/CameraInfo.h>

#include "object_modelling/geometry/pinhole_camera.h"

namespace object_modelling::ros_bridge
{
/// Which image a CameraInfo is read for: P belongs to the rectified one, K and D to the raw one.
enum class ImageKind
{
  RECTIFIED,
  RAW,
};

/// Intrinsics of the image as delivered (binning and region of interest taken into account). Throws base::Error
/// (BAD_INPUT) for an uncalibrated camera (fx 0) and a distortion model other than plumb_bob and rational_polynomial,
/// naming it. A rectified image whose P was left empty by the driver is read from K if there is no distortion.
geometry::PinholeCamera fromMessage(const sensor_msgs::CameraInfo& info, ImageKind kind);

/// CameraInfo of a rectified image (P) that was made of `raw` (K, D). For an undistorted camera give it twice.
sensor_msgs::CameraInfo toMessage(const geometry::PinholeCamera& raw, const geometry::PinholeCamera& rectified,
                                  const std_msgs::Header& header);

}  // namespace object_modelling::ros_bridge
