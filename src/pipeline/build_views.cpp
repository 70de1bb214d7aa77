#include "build_views.h"

#include "object_modelling/geometry/plane.h"
#include "object_modelling/rgbd/keyframe_view.h"

namespace object_modelling::pipeline
{
std::optional<geometry::Plane> Views::firstSupport() const
{
  return support_planes_reference.empty() ? std::nullopt : std::make_optional(support_planes_reference.front());
}

std::optional<geometry::Plane> Views::onlySupport() const
{
  return sessions.size() == 1 ? firstSupport() : std::nullopt;
}

base::Status loadViews(keyframes::SessionStore& store, const std::vector<alignment::SessionPlacement>& placements,
                       base::JobControl& control, Views* views)
{
  for (const alignment::SessionPlacement& placement : placements)
  {
    const auto session_index = static_cast<int>(views->sessions.size());
    views->sessions.push_back(store.session(placement.session_id));
    const Eigen::Vector2d color_offset_px = views->sessions.back().calibration.color_offset_px;
    const std::vector<int> ids = store.keyframeIds(placement.session_id);
    if (ids.empty())
      return { base::StatusCode::FAILED_PRECONDITION,
               "session '" + placement.session_id + "' has no keyframes: record it before building" };
    std::size_t masked = 0;
    for (const int id : ids)
    {
      control.report("load", masked, ids.size());
      const rgbd::Keyframe keyframe = store.keyframe(placement.session_id, id);
      if (keyframe.frame.object_mask.empty())
        continue;
      views->origins.push_back({ placement.session_id, id });
      views->views.push_back(rgbd::viewOf(keyframe, placement.T_reference_session, session_index, color_offset_px));
      ++masked;
    }
    if (masked == 0)
      return { base::StatusCode::FAILED_PRECONDITION,
               "none of the " + std::to_string(ids.size()) + " keyframes of session '" + placement.session_id +
                   "' has an object mask: select the object (segmenter) before building" };
    if (const std::optional<geometry::Plane>& plane = views->sessions.back().support_plane_session)
      views->support_planes_reference.push_back(geometry::transformed(placement.T_reference_session, *plane));
  }
  return {};
}

}  // namespace object_modelling::pipeline
