#pragma once

#include <string>

#include "object_modelling/keyframes/encoded_keyframe.h"

namespace object_modelling::keyframes
{
/// Throws base::Error (INVALID_ARGUMENT) naming what cannot be stored: id, image types and sizes, camera, pose, stamp.
/// Colour and depth are compressed on two threads: the caller is a tracker that waits.
EncodedKeyframe encodeKeyframe(const rgbd::Keyframe& keyframe);
/// Throws base::Error (BAD_INPUT) naming the damaged part; `what` names the keyframe.
rgbd::Keyframe decodeKeyframe(const EncodedKeyframe& row, const std::string& what);

/// "" for an empty mask. Throws base::Error (INVALID_ARGUMENT, naming `what`) if it is not CV_8UC1 of the given size.
std::string encodeMask(const cv::Mat& mask, int width, int height, const std::string& what = "object mask");

/// Little-endian: uint32 count, then per observation uint64 landmark_id, float32 u_px, v_px, depth_m (20 bytes).
std::string encodeObservations(const std::vector<rgbd::Observation>& observations);
std::vector<rgbd::Observation> decodeObservations(const std::string& bytes, const std::string& what);

}  // namespace object_modelling::keyframes
