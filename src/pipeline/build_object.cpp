#include "object_modelling/pipeline/build_object.h"

#include <chrono>
#include <optional>

#include "joint_refinement.h"
#include "model_frame.h"
#include "object_modelling/base/options.h"
#include "object_modelling/pipeline/report_maker.h"
#include "object_modelling/surface/mesh_renderer.h"
#include "object_modelling/surface/textured_renderer.h"
#include "quality_figures.h"
#include "quality_report.h"

namespace object_modelling::pipeline
{
namespace
{
constexpr int TURNTABLE_STEPS = 8;

class StageTimer
{
public:
  explicit StageTimer(std::map<std::string, double>* stage_s) : stage_s_(stage_s) {}
  void finish(const std::string& stage)
  {
    const auto now = std::chrono::steady_clock::now();
    (*stage_s_)[stage] += std::chrono::duration<double>(now - start_).count();
    start_ = now;
  }

private:
  std::map<std::string, double>* stage_s_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The sessions of one build, everything in the reference frame.
struct Views
{
  std::vector<keyframes::Session> sessions;
  std::vector<rgbd::Keyframe> keyframes;  // those that see the object; T_session_camera holds T_reference_camera
  std::vector<ViewOrigin> origins;        // of each of them
  // The lamps stay where they are while the object is turned over: every session is under a light of its own.
  std::vector<int> lights;
  std::vector<geometry::Plane> support_planes_reference;  // of each session that has one
};

base::Status loadViews(keyframes::SessionStore& store, const std::vector<alignment::SessionPlacement>& placements,
                       base::JobControl& control, Views* views)
{
  for (const alignment::SessionPlacement& placement : placements)
  {
    views->sessions.push_back(store.session(placement.session_id));
    const std::vector<int> ids = store.keyframeIds(placement.session_id);
    if (ids.empty())
      return { base::StatusCode::FAILED_PRECONDITION,
               "session '" + placement.session_id + "' has no keyframes: record it before building" };
    std::size_t masked = 0;
    for (const int id : ids)
    {
      control.report("load", masked, ids.size());
      rgbd::Keyframe keyframe = store.keyframe(placement.session_id, id);
      if (keyframe.frame.object_mask.empty())
        continue;
      views->origins.push_back({ placement.session_id, id });
      views->lights.push_back(static_cast<int>(views->sessions.size()) - 1);
      keyframe.id = static_cast<int>(views->keyframes.size());
      keyframe.T_session_camera = placement.T_reference_session * keyframe.T_session_camera;
      views->keyframes.push_back(std::move(keyframe));
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

std::optional<database::ObjectEntry> existingEntry(const database::ObjectDatabase& database, const std::string& id)
{
  for (database::ObjectEntry& entry : database.list())
    if (entry.id == id)
      return std::move(entry);
  return std::nullopt;
}

/// T_model_reference of the object as it stands in the database, through a session that both builds share.
std::optional<Eigen::Isometry3d> inheritedFrame(const database::ObjectEntry& entry,
                                                const std::vector<alignment::SessionPlacement>& placements)
{
  for (const database::ModelSession& known : entry.sessions)
    for (const alignment::SessionPlacement& placement : placements)
      if (known.id == placement.session_id)
        return known.T_model_session * placement.T_reference_session.inverse();
  return std::nullopt;
}

void transform(const Eigen::Isometry3d& T_target_source, fusion::FusedCloud* cloud)
{
  const Eigen::Isometry3f T = T_target_source.cast<float>();
  for (Eigen::Vector3f& point : cloud->points)
    point = T * point;
  for (Eigen::Vector3f& normal : cloud->normals)
    normal = T.linear() * normal;
}

/// Sessions of one camera have one shift, but for errors.
Eigen::Vector2d meanColorOffset_px(const std::vector<keyframes::Session>& sessions)
{
  Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
  for (const keyframes::Session& session : sessions)
    sum_px += session.calibration.color_offset_px;
  return sum_px / static_cast<double>(sessions.size());
}

std::vector<std::string> idsOf(const std::vector<alignment::SessionPlacement>& placements)
{
  std::vector<std::string> ids;
  for (const alignment::SessionPlacement& placement : placements)
    ids.push_back(placement.session_id);
  return ids;
}

/// A model is worth having without its texture: what is wrong becomes the result's status.
surface::TextureResult textured(const geometry::TriangleMesh& mesh, const std::vector<rgbd::Keyframe>& views,
                                const surface::TextureOptions& options, base::JobControl& control)
{
  try
  {
    return surface::textureMesh(mesh, views, options, control);
  }
  catch (const base::Cancelled&)
  {
    throw;
  }
  catch (const base::Error& error)
  {
    surface::TextureResult none;
    none.status = { error.code(), std::string("no texture: ") + error.what() };
    return none;
  }
}

std::optional<geometry::Plane> firstSupportOf(const Views& views)
{
  return views.support_planes_reference.empty() ? std::nullopt
                                                : std::make_optional(views.support_planes_reference.front());
}

/// What the object of a single session stood on. Of several, each saw what another one stood on.
std::optional<geometry::Plane> supportOf(const Views& views)
{
  return views.sessions.size() == 1 ? firstSupportOf(views) : std::nullopt;
}

/// Everything of the model but its geometry.
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
    T_support_model.linear() =
        Eigen::Quaterniond::FromTwoVectors(plane_model.normal, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T_support_model.translation().z() = plane_model.offset_m;
    model->T_support_model.push_back(T_support_model);
  }
  for (std::size_t i = 0; i < placements.size(); ++i)
    model->sessions.push_back({ placements[i].session_id, T_model_reference * placements[i].T_reference_session,
                                views.sessions[i].keyframe_count });
}
/// OK in any case: a model is worth having without its report, but whoever built it is told.
base::Status reportStatus(const std::string& folder, const std::string& object_id, const std::string& database_root,
                          base::JobControl& control)
{
  control.report("report", 0, 1);
  try
  {
    makeReport(folder, control);
  }
  catch (const base::Cancelled&)
  {
    throw;
  }
  catch (const base::Error& error)
  {
    return { base::StatusCode::OK, std::string("the model is built, but report.html could not be made: ") +
                                       error.what() + "; make it later by 'object_modelling report " + object_id +
                                       " --database " + database_root + "'" };
  }
  control.report("report", 1, 1);
  return {};
}
}  // namespace

std::vector<std::string> BuildOptions::violations() const
{
  base::OptionsCheck check("build_object");
  check.include(fusion.violations());
  check.include(surface.violations());
  check.include(texture.violations());
  return check.violations();
}

BuildReport buildObject(keyframes::SessionStore& store, database::ObjectDatabase& database,
                        const std::string& object_id, const std::string& name,
                        const std::vector<alignment::SessionPlacement>& placements, const BuildOptions& options,
                        base::JobControl& control)
{
  base::checked(options);
  BuildReport report;
  StageTimer timer(&report.stage_s);
  try
  {
    database::checkObjectId(object_id);  // now, not after all the work
  }
  catch (const base::Error& error)
  {
    report.status = error.status();
    return report;
  }
  if (placements.empty())
  {
    report.status = { base::StatusCode::FAILED_PRECONDITION,
                      "object '" + object_id + "' has no session to build from: record one first" };
    return report;
  }
  Views views;
  report.status = loadViews(store, placements, control, &views);
  if (!report.status.ok())
    return report;

  std::optional<Eigen::Isometry3d> T_model_reference;
  if (const std::optional<database::ObjectEntry> existing = existingEntry(database, object_id))
  {
    T_model_reference = inheritedFrame(*existing, placements);
    if (!T_model_reference && !options.replace)
    {
      report.status = { base::StatusCode::FAILED_PRECONDITION,
                        "object '" + object_id +
                            "' exists and was built from other sessions, so its frame (and grasps annotated in it) "
                            "would change: choose another object id, or build with replace" };
      return report;
    }
  }
  timer.finish("load");
  std::string unrefined;
  if (placements.size() > 1)  // one session has been refined already
  {
    unrefined =
        refineJointly({ meanColorOffset_px(views.sessions), views.lights, printHolds(store, idsOf(placements)) },
                      &views.keyframes, control);
    timer.finish("joint refinement");
  }

  fusion::CloudFusionOptions fusion_options = options.fusion;
  surface::TextureOptions texture_options = options.texture;
  fusion_options.color_offset_px += meanColorOffset_px(views.sessions);
  texture_options.color_offset_px += meanColorOffset_px(views.sessions);
  texture_options.lights = views.lights;
  fusion::CloudFusionResult fused = fusion::fuse(views.keyframes, fusion_options, control);
  report.status = fused.status;
  if (!report.status.ok())
    return report;
  timer.finish("fuse");

  surface::SurfaceResult surface = surface::reconstructSurface(fused.cloud, supportOf(views), options.surface, control);
  report.status = surface.status;
  if (!report.status.ok())
    return report;
  // Of the mesh: a few fused points that stand out would widen it.
  const geometry::OrientedBox box_reference = objectBox(surface.mesh.vertices, firstSupportOf(views));
  if (!T_model_reference)
    T_model_reference = box_reference.T_frame_box.inverse();
  transform(*T_model_reference, &fused.cloud);
  geometry::transform(*T_model_reference, &surface.mesh);
  timer.finish("surface");

  for (rgbd::Keyframe& view : views.keyframes)
    view.T_session_camera = *T_model_reference * view.T_session_camera;
  surface::TextureResult texture = textured(surface.mesh, views.keyframes, texture_options, control);
  timer.finish("texture");

  database::ObjectModel model;
  model.id = object_id;
  model.name = name.empty() ? object_id : name;
  describe(views, placements, *T_model_reference, box_reference, &model);
  model.diameter_m = diameter_m(surface.mesh.vertices);
  model.quality = qualityFigures(views.keyframes.size(), fused, surface.mesh, texture);
  model.provenance = { { "software", "object_modelling " OBJECT_MODELLING_VERSION },
                       { "fusion_resolution_m", std::to_string(options.fusion.resolution_m) },
                       { "surface_resolution_m", std::to_string(options.surface.resolution_m) } };
  model.cloud = std::move(fused.cloud);
  model.mesh = std::move(surface.mesh);
  model.textured = std::move(texture.textured);
  model.preview_bgr =
      texture.status.ok() ? surface::renderFourSides(model.textured) : surface::renderFourSides(model.mesh);
  model.views = std::move(views.keyframes);

  model.turntable_bgr = texture.status.ok() ? surface::renderTurntable(model.textured, TURNTABLE_STEPS)
                                            : surface::renderTurntable(model.mesh, TURNTABLE_STEPS);
  model.quality_yaml = qualityYaml(model, views.sessions, views.origins, options, report.stage_s);
  timer.finish("describe");

  report.object_folder = database.write(model, control,
                                        [&](const std::string& folder)
                                        {
                                          timer.finish("write");
                                          if (!options.make_report)
                                            return;
                                          report.status = reportStatus(folder, object_id, database.root(), control);
                                          timer.finish("report");
                                        });
  // What went wrong after the mesh does not cost the model, but whoever built it is told.
  for (const std::string& warning : { unrefined, surface.warning, texture.status.message })
    if (!warning.empty())
      report.status.message += (report.status.message.empty() ? "" : "; ") + warning;
  report.preview_path = report.object_folder + "/preview.png";
  report.size_m = model.box_model.size_m;
  report.diameter_m = model.diameter_m;
  report.point_count = model.cloud.size();
  report.vertex_count = model.mesh.vertices.size();
  report.triangle_count = model.mesh.triangles.size();
  for (std::size_t i = 0; i < views.sessions.size(); ++i)
  {
    views.sessions[i].object_id = object_id;
    views.sessions[i].T_model_session = model.sessions[i].T_model_session;
    store.updateSession(views.sessions[i]);
  }
  timer.finish("write");
  return report;
}

}  // namespace object_modelling::pipeline
