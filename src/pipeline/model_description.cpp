#include "model_description.h"

#include <algorithm>

#include "object_modelling/geometry/plane.h"
#include "object_modelling/geometry/transform.h"
#include "object_modelling/mesh/mesh_renderer.h"
#include "object_modelling/mesh/textured_renderer.h"

namespace object_modelling::pipeline
{
namespace
{
/// Whether a view of the session was taken while the known one was recorded.
bool ofItsTime(const database::ModelSession& known, const std::vector<rgbd::View>& views, int session_index)
{
  return known.last_stamp_s < known.first_stamp_s || std::any_of(views.begin(), views.end(),
                                                                 [&](const rgbd::View& view)
                                                                 {
                                                                   return view.session_index == session_index &&
                                                                          view.frame.stamp_s >= known.first_stamp_s &&
                                                                          view.frame.stamp_s <= known.last_stamp_s;
                                                                 });
}
}  // namespace

std::vector<std::string> idsOf(const std::vector<alignment::SessionPlacement>& placements)
{
  std::vector<std::string> ids;
  for (const alignment::SessionPlacement& placement : placements)
    ids.push_back(placement.session_id);
  return ids;
}

std::optional<database::ObjectEntry> existingEntry(const database::ObjectDatabase& database, const std::string& id)
{
  for (database::ObjectEntry& entry : database.list())
    if (entry.id == id)
      return std::move(entry);
  return std::nullopt;
}

std::optional<Eigen::Isometry3d> sharedFrame(const database::ObjectEntry& existing,
                                             const std::vector<alignment::SessionPlacement>& placements,
                                             const std::vector<rgbd::View>& views)
{
  for (const database::ModelSession& known : existing.sessions)
    for (std::size_t i = 0; i < placements.size(); ++i)
      if (known.id == placements[i].session_id && ofItsTime(known, views, static_cast<int>(i)))
        return known.T_model_session * placements[i].T_reference_session.inverse();
  return std::nullopt;
}

void describe(const Views& views, const std::vector<alignment::SessionPlacement>& placements,
              const Eigen::Isometry3d& T_model_reference, const geometry::OrientedBox& box_reference,
              database::ObjectModel* model)
{
  model->box_model = box_reference;
  model->box_model.T_frame_box = T_model_reference * box_reference.T_frame_box;
  for (const geometry::Plane& plane : views.support_planes_reference)
  {
    // A resting pose of the recordings: model frame lifted to stand on z = 0.
    const geometry::Plane plane_model = geometry::transformed(T_model_reference, plane);
    Eigen::Isometry3d T_support_model = Eigen::Isometry3d::Identity();
    T_support_model.linear() = geometry::rotationBetween(plane_model.normal, Eigen::Vector3d::UnitZ());
    T_support_model.translation().z() = plane_model.offset_m;
    model->T_support_model.push_back(T_support_model);
  }
  for (std::size_t i = 0; i < placements.size(); ++i)
    model->sessions.push_back({ placements[i].session_id, T_model_reference * placements[i].T_reference_session,
                                views.sessions[i].keyframe_count });
}

void drawPictures(database::ObjectModel* model)
{
  constexpr int TURNTABLE_STEPS = 8;
  const bool has_texture = !model->textured.empty();
  model->preview_bgr = has_texture ? mesh::renderFourSides(model->textured) : mesh::renderFourSides(model->mesh);
  model->turntable_bgr = has_texture ? mesh::renderTurntable(model->textured, TURNTABLE_STEPS)
                                     : mesh::renderTurntable(model->mesh, TURNTABLE_STEPS);
}

std::string partialText(const database::ObjectModel& model)
{
  if (model.sessions_left_out.empty())
    return {};
  std::string without;
  for (const database::LeftOutSession& session : model.sessions_left_out)
    without += (without.empty() ? "'" : ", '") + session.id + "'";
  return "PARTIAL: object '" + model.id + "' is built from " + std::to_string(model.sessions.size()) + " of its " +
         std::to_string(model.sessions.size() + model.sessions_left_out.size()) + " sessions, without " + without;
}

void updateSessions(keyframes::SessionStore& store, const database::ObjectModel& model)
{
  keyframes::SessionChange change;
  change.object_id = model.id;
  for (const database::ModelSession& session : model.sessions)
  {
    change.T_model_session = session.T_model_session;
    store.update(session.id, change);
  }
  change.T_model_session = std::optional<Eigen::Isometry3d>();
  for (const database::LeftOutSession& left_out : model.sessions_left_out)
  {
    const std::string owner = store.session(left_out.id).object_id;
    if (owner.empty() || owner == model.id)  // else another object's
      store.update(left_out.id, change);
  }
}

}  // namespace object_modelling::pipeline
