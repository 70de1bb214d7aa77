#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/keyframes/session_store.h"
#include "object_modelling/segmentation/object_follower.h"
#include "object_modelling/source/frame_source.h"
#include "object_modelling/source/trajectory_file.h"
#include "object_modelling/tracking/camera_tracker.h"

namespace object_modelling::pipeline
{
struct RecordOptions
{
  rgbd::FrameBuilderOptions frame;
  tracking::CameraTrackerOptions tracker;
  segmentation::ObjectFollowerOptions follower;  ///< finds the object in `object` mode where a recording has no masks
  double max_unusable_ratio = 0.5;               ///< recordings with a larger share of unusable frames are refused
  std::vector<std::string> violations() const;
};

struct RecordReport
{
  std::string session_id;
  int frame_count = 0;
  int tracked_count = 0;
  int unusable_count = 0;  ///< frames that could not be read or had no depth
  int lost_count = 0;      ///< times that tracking was lost
  int relocalised_count = 0;
  int keyframe_count = 0;
  std::string first_problem;                    ///< message of the first unusable or lost frame
  std::vector<source::StampedPose> trajectory;  ///< T_map_camera = T_session_camera, tracked frames only
  std::vector<double> track_ms;                 ///< per frame: tracker alone, no reading

  double trackedRatio() const { return frame_count > 0 ? static_cast<double>(tracked_count) / frame_count : 0; }
};

/// Tracks a recording from its first to its last frame and commits its keyframes to the store as they arrive, under a
/// new session (closed at the end). A cancelled or failed recording leaves no session behind. Without a store only the
/// trajectory is made. Throws base::Error (BAD_INPUT: nothing could be tracked; the message says why).
RecordReport recordSession(source::FrameSource& source, const keyframes::Session& session,
                           keyframes::SessionStore* store, const RecordOptions& options, base::JobControl& control);

}  // namespace object_modelling::pipeline
