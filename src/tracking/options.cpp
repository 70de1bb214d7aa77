#include "object_modelling/base/options.h"
#include "object_modelling/tracking/camera_tracker.h"

namespace object_modelling::tracking
{
std::vector<std::string> CameraTrackerOptions::violations() const
{
  base::OptionsCheck check("camera_tracker");
  check.inRange("max_features", max_features, 50, 5000);
  check.inRange("min_inliers", min_inliers, 6, 1000);
  check.inRange("min_inlier_ratio", min_inlier_ratio, 0.05, 1.0);
  check.inRange("max_reprojection_error_px", max_reprojection_error_px, 0.5, 20.0);
  check.inRange("keyframe_angle_rad", keyframe_angle_rad, 0.01, 1.0);
  check.inRange("keyframe_distance_ratio", keyframe_distance_ratio, 0.01, 2.0);
  check.inRange("robot_translation_sigma_m", robot_translation_sigma_m, 1e-5, 10.0);
  check.inRange("robot_rotation_sigma_rad", robot_rotation_sigma_rad, 1e-5, 10.0);
  return check.violations();
}

const char* toString(TrackingStatus status)
{
  switch (status)
  {
    case TrackingStatus::NOT_STARTED:
      return "not started";
    case TrackingStatus::TRACKING:
      return "tracking";
    case TrackingStatus::LOST:
      return "lost";
    case TrackingStatus::RELOCALISED:
      return "relocalised";
  }
  return "unknown";
}

}  // namespace object_modelling::tracking
