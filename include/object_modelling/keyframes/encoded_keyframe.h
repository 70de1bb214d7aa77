#pragma once

#include <string>

#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::keyframes
{
/// A keyframe as the store holds it: images and observations as bytes, matrices as text that gives back the same
/// doubles (docs/keyframe_store_schema.md). A third of a keyframe's size; who decodes it chooses where and when.
struct EncodedKeyframe
{
  int id = -1;
  double stamp_s = 0;
  geometry::PinholeCamera camera;
  std::string session_from_camera, covariance;
  std::string color_png, depth_png;
  double depth_unit_m = 0;
  std::string observations;
  std::string mask_png;         ///< of the object; empty: no mask
  std::string moving_mask_png;  ///< of the object with its turntable; empty: not known
  /// Of its session, as it was when the pose was read: one without the other is of no use.
  rgbd::SensorCalibration calibration;
};

/// The keyframe, with the noise model of its session, corrected by the calibration. Throws base::Error (BAD_INPUT)
/// naming session, keyframe and the damaged part.
rgbd::Keyframe decoded(const EncodedKeyframe& encoded, const std::string& session_id);

}  // namespace object_modelling::keyframes
