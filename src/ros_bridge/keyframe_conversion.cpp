#include "object_modelling/ros_bridge/keyframe_conversion.h"

#include <opencv2/imgproc.hpp>

#include "object_modelling/rgbd/depth_units.h"
#include "object_modelling/ros_bridge/camera_conversion.h"
#include "object_modelling/ros_bridge/image_conversion.h"
#include "object_modelling/ros_bridge/noise_model_conversion.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "object_modelling/ros_bridge/time_conversion.h"

namespace object_modelling::ros_bridge
{
namespace
{
constexpr double MILLIMETER_M = 0.001;

void requireSize(const cv::Mat& image, const geometry::PinholeCamera& camera, const std::string& what)
{
  if (image.cols != camera.width || image.rows != camera.height)
    throw base::Error(base::StatusCode::BAD_INPUT,
                      "keyframe: " + what + " is " + std::to_string(image.cols) + " x " + std::to_string(image.rows) +
                          ", camera_info says " + std::to_string(camera.width) + " x " + std::to_string(camera.height));
}

rgbd::Frame frameFromMessage(const object_modelling::Keyframe& message)
{
  rgbd::Frame frame;
  frame.stamp_s = toSeconds(message.header.stamp);
  frame.camera = fromMessage(message.camera_info, ImageKind::RECTIFIED);
  const cv::Mat color = colorFromMessage(message.color);
  if (color.channels() == 1)
  {
    frame.gray = color;
    cv::cvtColor(color, frame.color_bgr, cv::COLOR_GRAY2BGR);
  }
  else
  {
    frame.color_bgr = color;
    cv::cvtColor(color, frame.gray, cv::COLOR_BGR2GRAY);
  }
  frame.depth_m = rgbd::depthInMeters(depthFromMessage(message.depth), MILLIMETER_M);
  frame.object_mask = maskFromMessage(message.object_mask);
  frame.moving_mask = maskFromMessage(message.moving_mask);
  if (message.has_noise_model)
    frame.noise_model = fromMessage(message.noise_model);
  requireSize(frame.color_bgr, frame.camera, "colour");
  requireSize(frame.depth_m, frame.camera, "depth");
  if (!frame.object_mask.empty())
    requireSize(frame.object_mask, frame.camera, "object mask");
  if (!frame.moving_mask.empty())
    requireSize(frame.moving_mask, frame.camera, "moving mask");
  return frame;
}
}  // namespace

object_modelling::Keyframe toMessage(const rgbd::Keyframe& keyframe, const std::string& session_id,
                                     const std::string& camera_frame_id)
{
  object_modelling::Keyframe message;
  message.header.stamp = toTime(keyframe.frame.stamp_s);
  message.header.frame_id = camera_frame_id;
  message.session_id = session_id;
  message.keyframe_id = keyframe.id;
  message.camera_info = toMessage(keyframe.frame.camera, keyframe.frame.camera, message.header);
  message.color = toMessage(keyframe.frame.color_bgr, message.header);
  message.depth = toMessage(keyframe.frame.depth_m, message.header);
  message.object_mask = toMessage(keyframe.frame.object_mask, message.header);
  message.moving_mask = toMessage(keyframe.frame.moving_mask, message.header);
  message.session_from_camera = toMessage(keyframe.T_session_camera, keyframe.covariance);
  message.has_noise_model = true;
  message.noise_model = toMessage(keyframe.frame.noise_model);
  message.observations.reserve(keyframe.observations.size());
  for (const rgbd::Observation& observation : keyframe.observations)
  {
    object_modelling::Observation item;
    item.landmark_id = observation.landmark_id;
    item.u_px = observation.pixel.x();
    item.v_px = observation.pixel.y();
    item.depth_m = observation.depth_m;
    message.observations.push_back(item);
  }
  return message;
}

rgbd::Keyframe fromMessage(const object_modelling::Keyframe& message)
{
  rgbd::Keyframe keyframe;
  keyframe.id = message.keyframe_id;
  keyframe.frame = frameFromMessage(message);
  keyframe.T_session_camera = fromMessage(message.session_from_camera.pose);
  keyframe.covariance = covarianceFromMessage(message.session_from_camera);
  keyframe.observations.reserve(message.observations.size());
  for (const object_modelling::Observation& item : message.observations)
    keyframe.observations.push_back({ item.landmark_id, { item.u_px, item.v_px }, item.depth_m });
  return keyframe;
}

object_modelling::ObjectMask toMessage(const keyframes::MaskUpdate& update, const std::string& session_id)
{
  object_modelling::ObjectMask message;
  message.session_id = session_id;
  message.keyframe_id = update.keyframe_id;
  message.mask = toMessage(update.object_mask, std_msgs::Header());
  return message;
}

keyframes::MaskUpdate fromMessage(const object_modelling::ObjectMask& message)
{
  return { message.keyframe_id, maskFromMessage(message.mask) };
}

}  // namespace object_modelling::ros_bridge
