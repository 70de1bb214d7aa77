#include "object_modelling/ros_bridge/camera_conversion.h"

#include <algorithm>

#include <sensor_msgs/distortion_models.h>

#include "object_modelling/base/status.h"

namespace object_modelling::ros_bridge
{
namespace
{
namespace models = sensor_msgs::distortion_models;

std::string name(const sensor_msgs::CameraInfo& info)
{
  return "camera_info of \"" + info.header.frame_id + "\" (" + std::to_string(info.width) + " x " +
         std::to_string(info.height) + ")";
}

std::vector<double> distortionOf(const sensor_msgs::CameraInfo& info)
{
  if (std::all_of(info.D.begin(), info.D.end(), [](double value) { return value == 0; }))
    return {};
  if (info.distortion_model == models::PLUMB_BOB || info.distortion_model == models::RATIONAL_POLYNOMIAL)
    return { info.D.begin(), info.D.end() };
  throw base::Error(
      base::StatusCode::BAD_INPUT,
      name(info) + ": distortion model \"" + info.distortion_model +
          "\" is not supported; use plumb_bob or rational_polynomial, or rectify the images (image_proc)");
}

/// The matrices describe the full image; the delivered image is a region of it, binned.
void applyRegionAndBinning(const sensor_msgs::CameraInfo& info, geometry::PinholeCamera* camera)
{
  const int bin_x = std::max(1u, info.binning_x), bin_y = std::max(1u, info.binning_y);
  camera->cx = (camera->cx - info.roi.x_offset) / bin_x;
  camera->cy = (camera->cy - info.roi.y_offset) / bin_y;
  camera->fx /= bin_x;
  camera->fy /= bin_y;
  camera->width = static_cast<int>(info.roi.width > 0 ? info.roi.width : info.width) / bin_x;
  camera->height = static_cast<int>(info.roi.height > 0 ? info.roi.height : info.height) / bin_y;
}
}  // namespace

geometry::PinholeCamera fromMessage(const sensor_msgs::CameraInfo& info, ImageKind kind)
{
  geometry::PinholeCamera camera;
  const bool has_p = info.P[0] != 0;
  if (kind == ImageKind::RECTIFIED && has_p)
  {
    camera.fx = info.P[0];
    camera.fy = info.P[5];
    camera.cx = info.P[2];
    camera.cy = info.P[6];
  }
  else
  {
    camera.fx = info.K[0];
    camera.fy = info.K[4];
    camera.cx = info.K[2];
    camera.cy = info.K[5];
    camera.distortion = distortionOf(info);
    if (kind == ImageKind::RECTIFIED && camera.distorted())
      throw base::Error(base::StatusCode::BAD_INPUT, name(info) + ": has distortion but no P for the rectified image");
  }
  if (!(camera.fx > 0 && camera.fy > 0))
    throw base::Error(base::StatusCode::BAD_INPUT,
                      name(info) + ": focal length is 0; calibrate the camera or set its driver's camera_info_url");
  applyRegionAndBinning(info, &camera);
  return camera;
}

sensor_msgs::CameraInfo toMessage(const geometry::PinholeCamera& raw, const geometry::PinholeCamera& rectified,
                                  const std_msgs::Header& header)
{
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = rectified.width;
  info.height = rectified.height;
  info.distortion_model = raw.distortion.size() > 5 ? models::RATIONAL_POLYNOMIAL : models::PLUMB_BOB;
  info.D = raw.distortion;
  info.D.resize(raw.distortion.size() > 5 ? 8 : 5, 0.0);
  info.K = { raw.fx, 0, raw.cx, 0, raw.fy, raw.cy, 0, 0, 1 };
  info.R = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
  info.P = { rectified.fx, 0, rectified.cx, 0, 0, rectified.fy, rectified.cy, 0, 0, 0, 1, 0 };
  return info;
}

}  // namespace object_modelling::ros_bridge
