#include "camera_tracker_options.h"

#include "../common/store_parameters.h"
#include "object_modelling/base/options.h"

namespace object_modelling::nodes
{
std::vector<std::string> CameraTrackerNodeOptions::violations() const
{
  base::OptionsCheck check("camera_tracker");
  check.inRange("stored_timeout_s", stored_timeout_s, 0.1, 600.0);
  check.inRange("input_timeout_s", input_timeout_s, 0.1, 600.0);
  check.require("session_frame_id", !session_frame_id.empty() && session_frame_id.front() != '/',
                "must be a frame id without leading slash");
  check.include(tracker.violations());
  check.include(frame.violations());
  return check.violations();
}

CameraTrackerNodeOptions readCameraTrackerOptions(ros_bridge::ParamReader& reader)
{
  CameraTrackerNodeOptions options;
  reader.read("reference", options.tracker.reference,
              { { "scene", tracking::Reference::SCENE }, { "object", tracking::Reference::OBJECT } });
  reader.read("tracker/max_features", options.tracker.max_features);
  reader.read("tracker/min_inliers", options.tracker.min_inliers);
  reader.read("tracker/min_inlier_ratio", options.tracker.min_inlier_ratio);
  reader.read("tracker/max_reprojection_error_px", options.tracker.max_reprojection_error_px);
  reader.read("tracker/keyframe_angle_rad", options.tracker.keyframe_angle_rad);
  reader.read("tracker/keyframe_distance_ratio", options.tracker.keyframe_distance_ratio);
  reader.read("tracker/seed", options.tracker.seed);
  reader.read("frame/max_stamp_difference_s", options.frame.max_stamp_difference_s);
  reader.read("frame/min_depth_ratio", options.frame.min_depth_ratio);
  reader.read("frame/min_depth_m", options.frame.min_depth_m);
  reader.read("frame/max_depth_m", options.frame.max_depth_m);
  reader.read("use_store", options.use_store);
  reader.read("stored_timeout_s", options.stored_timeout_s);
  reader.read("session_frame_id", options.session_frame_id);
  reader.read("tf_direction", options.tf_direction,
              { { "session_below_camera", TfDirection::SESSION_BELOW_CAMERA },
                { "camera_below_session", TfDirection::CAMERA_BELOW_SESSION },
                { "none", TfDirection::NONE } });
  reader.read("input_timeout_s", options.input_timeout_s);
  reader.read("require_registered", options.require_registered);
  reader.include(options.violations());
  read(reader, &options.store);
  return options;
}

}  // namespace object_modelling::nodes
