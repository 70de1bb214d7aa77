#pragma once

#include <map>
#include <optional>
#include <string>

#include "object_modelling/geometry/oriented_box.h"
#include "object_modelling/segmentation/scene_segmenter.h"

namespace object_modelling::nodes
{
/// What the user has chosen, over views and sessions: the object as a point, and the region of interest as a box. Both
/// are kept in the session frame while a session is recorded, before that in the camera's frame, which then has to
/// stand still until the first keyframe. Free of ROS. Not thread safe.
class Selection
{
public:
  explicit Selection(double margin_m) : margin_m_(margin_m) {}

  /// `session_id` empty and `T_session_camera` empty while none is recorded.
  void choose(const Eigen::Vector3d& p_camera, const std::string& session_id,
              const std::optional<Eigen::Isometry3d>& T_session_camera);
  void setRoi(const std::optional<geometry::OrientedBox>& box_camera, const std::string& session_id,
              const std::optional<Eigen::Isometry3d>& T_session_camera);
  void clear();
  /// The first keyframe of a session takes over what was chosen before it began.
  void beginSession(const std::string& session_id, const Eigen::Isometry3d& T_session_camera);

  /// Drops the hypotheses whose centroid lies outside the region of interest, and sets NO_RESULT if none is left.
  void applyRoi(const std::optional<Eigen::Isometry3d>& T_session_camera,
                segmentation::SceneSegmentation* segmentation) const;
  /// Index of the chosen object's hypothesis; NO_RESULT if it is not in view, FAILED_PRECONDITION if none was chosen.
  base::Result<int> find(const segmentation::SceneSegmentation& segmentation, const std::string& session_id,
                         const std::optional<Eigen::Isometry3d>& T_session_camera) const;
  /// The chosen object of a session, in its frame (m).
  std::optional<Eigen::Vector3d> seed(const std::string& session_id) const;
  bool roiSet() const { return roi_.has_value(); }

private:
  struct Roi
  {
    std::string session_id;  // empty: box is in the camera's frame
    geometry::OrientedBox box;
  };

  double margin_m_;
  std::optional<Eigen::Vector3d> pending_camera_;     // chosen while no session was recorded
  std::map<std::string, Eigen::Vector3d> p_session_;  // by session
  std::optional<Roi> roi_;
};

}  // namespace object_modelling::nodes
