#include "selection.h"

#include <algorithm>

namespace object_modelling::nodes
{
void Selection::choose(const Eigen::Vector3d& p_camera, const std::string& session_id,
                       const std::optional<Eigen::Isometry3d>& T_session_camera)
{
  pending_camera_.reset();
  if (!session_id.empty() && T_session_camera)
    p_session_[session_id] = *T_session_camera * p_camera;
  else
    pending_camera_ = p_camera;
}

void Selection::setRoi(const std::optional<geometry::OrientedBox>& box_camera, const std::string& session_id,
                       const std::optional<Eigen::Isometry3d>& T_session_camera)
{
  roi_.reset();
  if (!box_camera)
    return;
  roi_ = Roi{ "", *box_camera };
  if (!session_id.empty() && T_session_camera)
    roi_ = Roi{ session_id, { *T_session_camera * box_camera->T_frame_box, box_camera->size_m } };
}

void Selection::clear()
{
  pending_camera_.reset();
  p_session_.clear();
}

void Selection::beginSession(const std::string& session_id, const Eigen::Isometry3d& T_session_camera)
{
  if (pending_camera_)
    p_session_[session_id] = T_session_camera * *pending_camera_;
  pending_camera_.reset();
  if (!roi_)
    return;
  if (roi_->session_id.empty())
    roi_ = Roi{ session_id, { T_session_camera * roi_->box.T_frame_box, roi_->box.size_m } };
  else if (roi_->session_id != session_id)
    roi_.reset();  // its frame is gone
}

void Selection::applyRoi(const std::optional<Eigen::Isometry3d>& T_session_camera,
                         segmentation::SceneSegmentation* segmentation) const
{
  if (!roi_ || segmentation->hypotheses.empty())
    return;
  const bool in_session = !roi_->session_id.empty();
  if (in_session && !T_session_camera)
    return;
  auto& hypotheses = segmentation->hypotheses;
  const std::size_t count = hypotheses.size();
  hypotheses.erase(std::remove_if(hypotheses.begin(), hypotheses.end(),
                                  [&](const segmentation::Hypothesis& hypothesis)
                                  {
                                    const Eigen::Vector3d& p_camera = hypothesis.centroid_camera;
                                    return !roi_->box.contains(in_session ? *T_session_camera * p_camera : p_camera);
                                  }),
                   hypotheses.end());
  for (std::size_t i = 0; i < hypotheses.size(); ++i)
    hypotheses[i].id = static_cast<int>(i);
  if (hypotheses.empty())
    segmentation->status = { base::StatusCode::NO_RESULT,
                             "none of " + std::to_string(count) +
                                 " hypotheses lies in the region of interest: move it, or switch it off (set_roi)" };
}

base::Result<int> Selection::find(const segmentation::SceneSegmentation& segmentation, const std::string& session_id,
                                  const std::optional<Eigen::Isometry3d>& T_session_camera) const
{
  const std::optional<Eigen::Vector3d> p_session = seed(session_id);
  if (p_session && T_session_camera)
    return segmentation::selectByPoint(segmentation, T_session_camera->inverse() * *p_session, margin_m_);
  if (pending_camera_)
    return segmentation::selectByPoint(segmentation, *pending_camera_, margin_m_);
  return { { base::StatusCode::FAILED_PRECONDITION, "no object has been selected" }, -1 };
}

std::optional<Eigen::Vector3d> Selection::seed(const std::string& session_id) const
{
  const auto found = p_session_.find(session_id);
  return found == p_session_.end() ? std::nullopt : std::optional<Eigen::Vector3d>(found->second);
}

}  // namespace object_modelling::nodes
