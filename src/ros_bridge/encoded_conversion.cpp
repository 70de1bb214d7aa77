#include "object_modelling/ros_bridge/keyframe_conversion.h"
#include "object_modelling/ros_bridge/noise_model_conversion.h"

namespace object_modelling::ros_bridge
{
object_modelling::EncodedKeyframe toMessage(const keyframes::EncodedKeyframe& keyframe)
{
  object_modelling::EncodedKeyframe message;
  message.keyframe_id = keyframe.id;
  message.stamp_s = keyframe.stamp_s;
  message.width_px = keyframe.camera.width;
  message.height_px = keyframe.camera.height;
  message.fx_px = keyframe.camera.fx;
  message.fy_px = keyframe.camera.fy;
  message.cx_px = keyframe.camera.cx;
  message.cy_px = keyframe.camera.cy;
  message.distortion = keyframe.camera.distortion;
  message.session_from_camera = keyframe.session_from_camera;
  message.covariance = keyframe.covariance;
  message.color_png.assign(keyframe.color_png.begin(), keyframe.color_png.end());
  message.depth_png.assign(keyframe.depth_png.begin(), keyframe.depth_png.end());
  message.depth_unit_m = keyframe.depth_unit_m;
  message.observations.assign(keyframe.observations.begin(), keyframe.observations.end());
  message.mask_png.assign(keyframe.mask_png.begin(), keyframe.mask_png.end());
  message.moving_mask_png.assign(keyframe.moving_mask_png.begin(), keyframe.moving_mask_png.end());
  message.calibration = toMessage(keyframe.calibration);
  return message;
}

keyframes::EncodedKeyframe fromMessage(const object_modelling::EncodedKeyframe& message)
{
  keyframes::EncodedKeyframe keyframe;
  keyframe.id = message.keyframe_id;
  keyframe.stamp_s = message.stamp_s;
  keyframe.camera = { static_cast<int>(message.width_px),
                      static_cast<int>(message.height_px),
                      message.fx_px,
                      message.fy_px,
                      message.cx_px,
                      message.cy_px,
                      message.distortion };
  keyframe.session_from_camera = message.session_from_camera;
  keyframe.covariance = message.covariance;
  keyframe.color_png.assign(message.color_png.begin(), message.color_png.end());
  keyframe.depth_png.assign(message.depth_png.begin(), message.depth_png.end());
  keyframe.depth_unit_m = message.depth_unit_m;
  keyframe.observations.assign(message.observations.begin(), message.observations.end());
  keyframe.mask_png.assign(message.mask_png.begin(), message.mask_png.end());
  keyframe.moving_mask_png.assign(message.moving_mask_png.begin(), message.moving_mask_png.end());
  keyframe.calibration = fromMessage(message.calibration);
  return keyframe;
}

}  // namespace object_modelling::ros_bridge
