#include "model_build.h"

#include <algorithm>

#include "joint_refinement.h"
#include "model_description.h"
#include "model_frame.h"
#include "model_match.h"
#include "object_modelling/database/mesh_evidence.h"
#include "object_modelling/report/quality_figures.h"
#include "object_modelling/report/report_maker.h"

namespace object_modelling::pipeline
{
namespace
{
constexpr double SEEN_RESOLUTIONS = 2;  // of fusion, between a seen place of the mesh and the nearest fused point

void transform(const Eigen::Isometry3d& T_target_source, fusion::FusedCloud* cloud)
{
  const Eigen::Isometry3f T = T_target_source.cast<float>();
  for (Eigen::Vector3f& point : cloud->points)
    point = T * point;
  for (Eigen::Vector3f& normal : cloud->normals)
    normal = T.linear() * normal;
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
}  // namespace

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

void StageTimer::finish(const std::string& stage)
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

BuildReport ModelBuild::run(BuildInput input)
{
  input_ = std::move(input);
  model_.id = input_.object_id;
  model_.name = input_.name;
  if (input_.existing)
    model_.aliases = input_.existing->aliases;
  warnings_ = input_.views.warnings;
  timer_.finish("load");
  using Step = base::Status (ModelBuild::*)();
  for (const Step step : { &ModelBuild::fuse, &ModelBuild::chooseFrame, &ModelBuild::reconstruct })
  {
    report_.status = (this->*step)();
    if (!report_.status.ok())
    {
      addWarnings();
      return report_;
    }
  }
  addTexture();
  describe(input_.views, input_.placements, *input_.T_model_reference, box_reference_, &model_);
  findSimilar();
  addProperties();
  completeModel();
  write();
  return report_;
}

base::Status ModelBuild::fuse()
{
  if (input_.placements.size() > 1)  // one session has been refined already
  {
    warnings_.push_back(refineJointly(idsOf(input_.placements), &input_.views.views, control_));
    timer_.finish("joint refinement");
  }
  fused_ = fusion::fuse(input_.views.views, options_.fusion, control_);
  timer_.finish("fuse");
  return fused_.status;
}

base::Status ModelBuild::chooseFrame()
{
  model_.frame_version = input_.existing ? input_.existing->frame_version : 1;
  if (!input_.existing)
    return {};
  if (input_.T_model_reference)
  {
    identity_.frame.by = "session";
    return {};
  }
  control_.report("compare with the stored '" + model_.id + "'", 0, 1);
  const ModelMatch match = matchExisting(database_, *input_.existing, fused_.cloud, input_.views.views, control_);
  control_.report("compare with the stored '" + model_.id + "'", 1, 1);
  timer_.finish("compare");
  identity_.frame = { match.accepted ? "alignment" : "new", match.probability };
  if (match.accepted)
  {
    input_.T_model_reference = match.T_stored_model;
    return {};
  }
  if (!options_.replace)
    return { base::StatusCode::FAILED_PRECONDITION, frameWouldChange(model_.id, match) };
  ++model_.frame_version;
  warnings_.push_back(frameHasChanged(model_.id, model_.frame_version, match));
  return {};
}

base::Status ModelBuild::reconstruct()
{
  surface::SurfaceResult surface =
      surface::reconstructSurface(fused_.cloud, input_.views.onlySupport(), options_.surface, control_);
  if (!surface.status.ok())
    return surface.status;
  warnings_.push_back(surface.warning);
  // Of the mesh: a few fused points that stand out would widen it.
  box_reference_ = objectBox(surface.mesh.vertices, input_.views.firstSupport());
  if (!input_.T_model_reference)
    input_.T_model_reference = box_reference_.T_frame_box.inverse();
  transform(*input_.T_model_reference, &fused_.cloud);
  mesh::transform(*input_.T_model_reference, &surface.mesh);
  model_.mesh = std::move(surface.mesh);
  model_.views = std::move(input_.views.views);
  for (rgbd::View& view : model_.views)
    rgbd::transform(*input_.T_model_reference, &view);
  timer_.finish("surface");
  return {};
}

void ModelBuild::addTexture()
{
  texture_ = textured(model_.mesh, model_.views, options_.texture, control_);
  warnings_.push_back(texture_.status.message);
  timer_.finish("texture");
}

void ModelBuild::findSimilar()
{
  model_.diameter_m = diameter_m(model_.mesh.vertices);
  if (input_.existing || !options_.find_similar)
    return;
  const SimilarObjects similar = similarObjects(database_, model_, fused_.cloud, control_);
  identity_.looks_like = similar.found;
  warnings_.push_back(looksLikeText(identity_.looks_like, model_.id, database_.root()));
  if (similar.compared_count > 0)
    timer_.finish("compare");
}

void ModelBuild::addProperties()
{
  database::markSeen(fused_.cloud, SEEN_RESOLUTIONS * options_.fusion.resolution_m, &model_.mesh);
  model_.mesh_sigmas_m = database::sigmasOf(fused_.cloud, model_.mesh);
  model_.properties =
      object_properties::propertiesOf(model_.mesh, model_.T_support_model, options_.properties, control_);
  report_.properties = object_properties::summaryText(*model_.properties, model_.properties->collision_parts.size());
  timer_.finish("properties");
}

void ModelBuild::completeModel()
{
  model_.quality = report::qualityFigures(model_.views.size(), fused_, model_.mesh, texture_);
  model_.provenance = { { "software", "object_modelling " OBJECT_MODELLING_VERSION },
                        { "fusion_resolution_m", std::to_string(options_.fusion.resolution_m) },
                        { "surface_resolution_m", std::to_string(options_.surface.resolution_m) } };
  model_.cloud = std::move(fused_.cloud);
  model_.textured = std::move(texture_.textured);
  model_.sessions_left_out = options_.left_out;
  warnings_.insert(warnings_.begin(), partialText(model_));
  drawPictures(&model_);
  identity_.warnings = warnings_;
  model_.quality_yaml =
      report::qualityYaml(model_, input_.views.sessions, input_.views.origins,
                          { options_.fusion, options_.surface, options_.texture }, identity_, report_.stages);
  timer_.finish("describe");
}

void ModelBuild::addWarnings()
{
  for (const std::string& warning : warnings_)
    if (!warning.empty())
      report_.status.message += (report_.status.message.empty() ? "" : "; ") + warning;
}

void ModelBuild::write()
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
  report_.frame_version = model_.frame_version;
  report_.frame = identity_.frame;
  report_.looks_like = identity_.looks_like;
  report_.size_m = model_.box_model.size_m;
  report_.diameter_m = model_.diameter_m;
  report_.point_count = model_.cloud.size();
  report_.vertex_count = model_.mesh.vertices.size();
  report_.triangle_count = model_.mesh.triangles.size();
  timer_.finish("write");
}
}  // namespace object_modelling::pipeline
