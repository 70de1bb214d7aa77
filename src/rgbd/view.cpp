#include "object_modelling/rgbd/view.h"

#include <string>

#include "object_modelling/base/status.h"
#include "object_modelling/rgbd/keyframe_view.h"

namespace object_modelling::rgbd
{
namespace
{
View inSession(const Keyframe& keyframe, int session_index, const Eigen::Vector2d& color_offset_px)
{
  return { keyframe.frame, keyframe.T_session_camera, keyframe.covariance, session_index, color_offset_px };
}
}  // namespace

bool isPlaced(const View& view)
{
  return view.T_world_camera.matrix().allFinite() && view.color_offset_px.allFinite() && view.session_index >= 0;
}

void checkPlaced(const std::vector<View>& views)
{
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!isPlaced(views[i]))
      throw base::Error(
          base::StatusCode::INVALID_ARGUMENT,
          "view " + std::to_string(i) +
              " is not placed: its pose and its colour offset must be finite, its session index at least 0");
}

void transform(const Eigen::Isometry3d& T_target_world, View* view)
{
  const geometry::Matrix6d to_target = geometry::adjoint(T_target_world);
  view->T_world_camera = T_target_world * view->T_world_camera;
  view->covariance = to_target * view->covariance * to_target.transpose();
}

View viewOf(const Keyframe& keyframe, const Eigen::Isometry3d& T_world_session, int session_index,
            const Eigen::Vector2d& color_offset_px)
{
  View view = inSession(keyframe, session_index, color_offset_px);
  transform(T_world_session, &view);
  return view;
}

std::vector<View> viewsOf(const std::vector<Keyframe>& keyframes, const Eigen::Vector2d& color_offset_px)
{
  std::vector<View> views;
  for (const Keyframe& keyframe : keyframes)
    views.push_back(inSession(keyframe, 0, color_offset_px));
  return views;
}

}  // namespace object_modelling::rgbd
