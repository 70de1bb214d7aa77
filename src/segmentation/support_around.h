#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "object_modelling/rgbd/frame.h"
#include "plane_moments.h"

namespace object_modelling::segmentation
{
struct LocalSupport
{
  geometry::Plane plane_camera;
  PlaneMoments moments;    ///< of the points that made it, in the camera frame
  double noise_scale = 1;  ///< at least 1: ratio of its measured noise to the noise model's
};

/// The support as this view sees it within `area`, near a plane that is known: the depth sensor's distortion and the
/// error of the pose move it by millimetres, which is what an object's foot has. Points under `object` (CV_8UC1, may be
/// empty) are left out. Nothing where too little of it is visible or it contradicts the known plane.
std::optional<LocalSupport> refineSupport(const rgbd::Frame& frame, const geometry::Plane& known_camera,
                                          const cv::Rect& area, const cv::Mat& object);

/// Support of an object whose mask is given: of the planes round it the largest that has the object on one side and its
/// lowest points near the plane.
std::optional<LocalSupport> findSupportAround(const rgbd::Frame& frame, const cv::Mat& object_mask);

}  // namespace object_modelling::segmentation
