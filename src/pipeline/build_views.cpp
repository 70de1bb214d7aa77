#include "build_views.h"

#include "object_modelling/geometry/plane.h"
#include "object_modelling/rgbd/keyframe_view.h"
#include "object_modelling/rgbd/pose_certainty.h"

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

namespace
{
/// Keeps those of the last session, which begins at `first`, whose poses are known.
void keepKnown(const std::string& session_id, std::size_t first, Views* views)
{
  const auto begin = static_cast<std::ptrdiff_t>(first);
  const std::vector<rgbd::View> all(views->views.begin() + begin, views->views.end());
  const std::vector<report::ViewOrigin> origins(views->origins.begin() + begin, views->origins.end());
  const rgbd::PathCertainty path = rgbd::pathCertainty(all);
  if (path.allKnown())
    return;
  std::vector<int> ids;
  for (const report::ViewOrigin& origin : origins)
    ids.push_back(origin.keyframe_id);
  views->warnings.push_back(describe(path, ids, session_id));
  views->views.resize(first);
  views->origins.resize(first);
  for (const std::size_t i : rgbd::knownViews(path, all.size()))
  {
    views->views.push_back(all[i]);
    views->origins.push_back(origins[i]);
  }
}
}  // namespace

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
    const std::size_t first = views->views.size();
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
    keepKnown(placement.session_id, first, views);
    if (const std::optional<geometry::Plane>& plane = views->sessions.back().support_plane_session)
      views->support_planes_reference.push_back(geometry::transformed(placement.T_reference_session, *plane));
  }
  return {};
}

}  // namespace object_modelling::pipeline
