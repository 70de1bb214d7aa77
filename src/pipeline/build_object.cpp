#include "object_modelling/pipeline/build_object.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "joint_refinement.h"
#include "model_description.h"
#include "model_frame.h"
#include "object_modelling/base/options.h"
#include "object_modelling/database/mesh_evidence.h"
#include "object_modelling/report/quality_figures.h"
#include "object_modelling/report/report_maker.h"

namespace object_modelling::pipeline
{
namespace
{
constexpr double SEEN_RESOLUTIONS = 2;  // of fusion, between a seen place of the mesh and the nearest fused point

class StageTimer
{
public:
  explicit StageTimer(std::vector<StageTime>* stages) : stages_(stages) {}
  void finish(const std::string& stage)
  {
    const auto now = std::chrono::steady_clock::now();
    const double duration_s = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    const auto known =
        std::find_if(stages_->begin(), stages_->end(), [&](const StageTime& time) { return time.stage == stage; });
    if (known != stages_->end())
      known->duration_s += duration_s;
    else
      stages_->push_back({ stage, duration_s });
  }

private:
  std::vector<StageTime>* stages_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void transform(const Eigen::Isometry3d& T_target_source, fusion::FusedCloud* cloud)
{
  const Eigen::Isometry3f T = T_target_source.cast<float>();
  for (Eigen::Vector3f& point : cloud->points)
    point = T * point;
  for (Eigen::Vector3f& normal : cloud->normals)
    normal = T.linear() * normal;
}

std::vector<std::string> idsOf(const std::vector<alignment::SessionPlacement>& placements)
{
  std::vector<std::string> ids;
  for (const alignment::SessionPlacement& placement : placements)
    ids.push_back(placement.session_id);
  return ids;
}

/// A model is worth having without its texture: what is wrong becomes the result's status.
texture::TextureResult textured(const mesh::TriangleMesh& mesh, const std::vector<rgbd::View>& views,
                                const texture::TextureOptions& options, base::JobControl& control)
{
  try
  {
    return texture::textureMesh(mesh, views, options, control);
  }
  catch (const base::Cancelled&)
  {
    throw;
  }
  catch (const base::Error& error)
  {
    texture::TextureResult none;
    none.status = { error.code(), std::string("no texture: ") + error.what() };
    return none;
  }
}

/// A model without its report is kept, with a warning for the user.
std::string reportWarning(const std::string& folder, const std::string& object_id, const std::string& database_root,
                          base::JobControl& control)
{
  control.report("report", 0, 1);
  try
  {
    report::makeReport(folder, control);
  }
  catch (const base::Cancelled&)
  {
    throw;
  }
  catch (const base::Error& error)
  {
    return std::string("the model is built, but report.html could not be made: ") + error.what() +
           "; make it later by 'object_modelling report " + object_id + " --database " + database_root + "'";
  }
  control.report("report", 1, 1);
  return {};
}

/// One build, step by step; each step's status ends it unless OK.
class Build
{
public:
  Build(keyframes::SessionStore& store, database::ObjectDatabase& database,
        const std::vector<alignment::SessionPlacement>& placements, const BuildOptions& options,
        base::JobControl& control)
      : store_(store), database_(database), placements_(placements), options_(options), control_(control)
  {
  }
  BuildReport run(const std::string& object_id, const std::string& name)
  {
    model_.id = object_id;
    model_.name = name;
    using Step = base::Status (Build::*)();
    for (const Step step : { &Build::check, &Build::load, &Build::fuse, &Build::reconstruct })
    {
      report_.status = (this->*step)();
      if (!report_.status.ok())
      {
        addWarnings();
        return report_;
      }
    }
    addTexture();
    describe(views_, placements_, *T_model_reference_, box_reference_, &model_);
    addProperties();
    completeModel();
    write();
    return report_;
  }

private:
  base::Status check();  ///< what is known without any work
  base::Status load();
  base::Status fuse();
  base::Status reconstruct();  ///< the surface, and with it the object's frame
  void addTexture();
  void addProperties();
  void completeModel();
  void addWarnings();  ///< to the status' message
  void write();

  keyframes::SessionStore& store_;
  database::ObjectDatabase& database_;
  const std::vector<alignment::SessionPlacement>& placements_;
  const BuildOptions& options_;
  base::JobControl& control_;
  BuildReport report_;
  StageTimer timer_{ &report_.stages };
  Views views_;
  std::optional<Eigen::Isometry3d> T_model_reference_;
  geometry::OrientedBox box_reference_;
  fusion::CloudFusionResult fused_;
  texture::TextureResult texture_;
  std::vector<std::string> warnings_;  ///< the model is kept; reported to the user; empty ones are skipped
  database::ObjectModel model_;
};

base::Status Build::check()
{
  try
  {
    database::checkObjectId(model_.id);
  }
  catch (const base::Error& error)
  {
    return error.status();
  }
  if (placements_.empty())
    return { base::StatusCode::FAILED_PRECONDITION,
             "object '" + model_.id + "' has no session to build from: record one first" };
  const std::vector<std::string> placed = idsOf(placements_);
  for (const database::LeftOutSession& left_out : options_.left_out)
  {
    store_.session(left_out.id);  // NOT_FOUND names it
    if (std::find(placed.begin(), placed.end(), left_out.id) != placed.end())
      return { base::StatusCode::INVALID_ARGUMENT,
               "session '" + left_out.id + "' is placed and left out: name it once" };
  }
  return {};
}

base::Status Build::load()
{
  const base::Status loaded = loadViews(store_, placements_, control_, &views_);
  if (!loaded.ok())
    return loaded;
  warnings_ = views_.warnings;
  base::Result<std::optional<Eigen::Isometry3d>> inherited =
      inheritedFrame(database_, model_.id, placements_, options_.replace);
  T_model_reference_ = inherited.value;
  timer_.finish("load");
  return inherited.status;
}

base::Status Build::fuse()
{
  if (placements_.size() > 1)  // one session has been refined already
  {
    warnings_.push_back(refineJointly(idsOf(placements_), &views_.views, control_));
    timer_.finish("joint refinement");
  }
  fused_ = fusion::fuse(views_.views, options_.fusion, control_);
  timer_.finish("fuse");
  return fused_.status;
}

base::Status Build::reconstruct()
{
  surface::SurfaceResult surface =
      surface::reconstructSurface(fused_.cloud, views_.onlySupport(), options_.surface, control_);
  if (!surface.status.ok())
    return surface.status;
  warnings_.push_back(surface.warning);
  // Of the mesh: a few fused points that stand out would widen it.
  box_reference_ = objectBox(surface.mesh.vertices, views_.firstSupport());
  if (!T_model_reference_)
    T_model_reference_ = box_reference_.T_frame_box.inverse();
  transform(*T_model_reference_, &fused_.cloud);
  mesh::transform(*T_model_reference_, &surface.mesh);
  model_.mesh = std::move(surface.mesh);
  model_.views = std::move(views_.views);
  for (rgbd::View& view : model_.views)
    rgbd::transform(*T_model_reference_, &view);
  timer_.finish("surface");
  return {};
}

void Build::addTexture()
{
  texture_ = textured(model_.mesh, model_.views, options_.texture, control_);
  warnings_.push_back(texture_.status.message);
  timer_.finish("texture");
}

void Build::addProperties()
{
  database::markSeen(fused_.cloud, SEEN_RESOLUTIONS * options_.fusion.resolution_m, &model_.mesh);
  model_.mesh_sigmas_m = database::sigmasOf(fused_.cloud, model_.mesh);
  model_.properties =
      object_properties::propertiesOf(model_.mesh, model_.T_support_model, options_.properties, control_);
  report_.properties = object_properties::summaryText(*model_.properties, model_.properties->collision_parts.size());
  timer_.finish("properties");
}

void Build::completeModel()
{
  model_.diameter_m = diameter_m(model_.mesh.vertices);
  model_.quality = report::qualityFigures(model_.views.size(), fused_, model_.mesh, texture_);
  model_.provenance = { { "software", "object_modelling " OBJECT_MODELLING_VERSION },
                        { "fusion_resolution_m", std::to_string(options_.fusion.resolution_m) },
                        { "surface_resolution_m", std::to_string(options_.surface.resolution_m) } };
  model_.cloud = std::move(fused_.cloud);
  model_.textured = std::move(texture_.textured);
  model_.sessions_left_out = options_.left_out;
  warnings_.insert(warnings_.begin(), partialText(model_));
  drawPictures(&model_);
  model_.quality_yaml = report::qualityYaml(model_, views_.sessions, views_.origins,
                                            { options_.fusion, options_.surface, options_.texture }, report_.stages);
  timer_.finish("describe");
}

void Build::addWarnings()
{
  for (const std::string& warning : warnings_)
    if (!warning.empty())
      report_.status.message += (report_.status.message.empty() ? "" : "; ") + warning;
}

void Build::write()
{
  report_.object_folder =
      database_.write(model_, control_,
                      [&](const std::string& folder)
                      {
                        timer_.finish("write");
                        if (!options_.make_report)
                          return;
                        warnings_.push_back(reportWarning(folder, model_.id, database_.root(), control_));
                        timer_.finish("report");
                      });
  addWarnings();
  report_.preview_path = report_.object_folder + "/preview.png";
  report_.size_m = model_.box_model.size_m;
  report_.diameter_m = model_.diameter_m;
  report_.point_count = model_.cloud.size();
  report_.vertex_count = model_.mesh.vertices.size();
  report_.triangle_count = model_.mesh.triangles.size();
  updateSessions(store_, model_);
  timer_.finish("write");
}
}  // namespace

std::vector<std::string> BuildOptions::violations() const
{
  base::OptionsCheck check("build_object");
  check.include(fusion.violations());
  check.include(surface.violations());
  check.include(texture.violations());
  check.include(properties.violations());
  return check.violations();
}

BuildReport buildObject(keyframes::SessionStore& store, database::ObjectDatabase& database,
                        const std::string& object_id, const std::string& name,
                        const std::vector<alignment::SessionPlacement>& placements, const BuildOptions& options,
                        base::JobControl& control)
{
  base::checked(options);
  Build build(store, database, placements, options, control);
  return build.run(object_id, name.empty() ? object_id : name);
}

}  // namespace object_modelling::pipeline
