#pragma once

#include <optional>
#include <vector>

#include "keyframe_map.h"
#include "object_modelling/registration/dense_alignment.h"

namespace object_modelling::tracking
{
/// A pose at which the surfaces of a keyframe fit surely.
struct RecognisedSurfaces
{
  registration::DenseAlignment aligned;
  std::vector<Eigen::Isometry3d> rivals;  ///< other poses at which other keyframes fit nearly as well
};

/// Places a frame that looks from near a keyframe by aligning it densely: quick, and works without texture. Tried are
/// the keyframes whose images are most alike and, if given, those nearest to `T_session_camera_hint`. The best
/// alignment is given if `certain()`; whoever uses it checks landmarks too.
std::optional<RecognisedSurfaces> relocaliseBySurfaces(const registration::DensePyramid& frame,
                                                       const cv::Mat& thumbnail, const KeyframeMap& map,
                                                       const std::optional<Eigen::Isometry3d>& T_session_camera_hint);

}  // namespace object_modelling::tracking
