#pragma once

#include <string>
#include <vector>

#include "object_modelling/geometry/transform.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::rgbd
{
/// Standard deviations of a camera's pose in its least known directions, as motions in the camera frame.
struct PoseSigma
{
  double translation_m = 0;
  double rotation_rad = 0;

  /// Within 2 % of the depth of what is looked at, and 20 mrad. What is not finite is not.
  bool isKnown(double depth_m) const;
  std::string text() const;  ///< "12 mm, 31 mrad"
};

/// Of a covariance in the camera frame.
PoseSigma poseSigma(const geometry::Matrix6d& covariance_camera);

/// Covariance of a motion on the left of T_world_camera as one on the left of T_camera_world.
geometry::Matrix6d inCameraFrame(const geometry::Matrix6d& covariance_world, const Eigen::Isometry3d& T_world_camera);

/// Which views of a session are of use: the covariances show the directions that a plain scene does not constrain, and
/// views with such a direction would put surfaces where there are none.
struct PathCertainty
{
  std::vector<std::size_t> unknown;  ///< indices of views whose pose is not known; zero covariances count as known
  PoseSigma worst;                   ///< of those
  /// More than half are unknown, or fewer than two would be left. Then none is better than others: the covariances are
  /// relative to the first keyframe and do not bound the others relative to each other.
  bool doubtful = false;

  bool allKnown() const { return unknown.empty(); }
};

PathCertainty pathCertainty(const std::vector<View>& views);

/// Message for the user, with a remedy; empty where all are known. `keyframe_ids`: of the views.
std::string describe(const PathCertainty& path, const std::vector<int>& keyframe_ids, const std::string& session_id);

/// Takes out the views that are not known, unless the path is doubtful: gives the indices of those that stay.
std::vector<std::size_t> knownViews(const PathCertainty& path, std::size_t views);

}  // namespace object_modelling::rgbd
