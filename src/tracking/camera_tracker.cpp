#include "object_modelling/tracking/camera_tracker.h"

#include "object_modelling/base/options.h"
#include "tracker_implementation.h"

namespace object_modelling::tracking
{
CameraTracker::CameraTracker(const CameraTrackerOptions& options)
    : implementation_(std::make_unique<Implementation>(base::checked(options)))
{
}

CameraTracker::~CameraTracker() = default;

TrackingResult CameraTracker::track(const rgbd::Frame& frame, const std::optional<Eigen::Isometry3d>& T_robot_camera)
{
  return implementation_->track(frame, T_robot_camera);
}

void CameraTracker::reset()
{
  implementation_->reset();
}

void CameraTracker::resume(const std::vector<rgbd::Keyframe>& keyframes)
{
  implementation_->resume(keyframes);
}

std::optional<Eigen::Isometry3d> CameraTracker::predict(double stamp_s) const
{
  return implementation_->predict(stamp_s);
}

}  // namespace object_modelling::tracking
