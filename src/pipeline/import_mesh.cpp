#include "object_modelling/pipeline/import_mesh.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "mesh_views.h"
#include "model_description.h"
#include "model_frame.h"
#include "object_modelling/base/options.h"
#include "object_modelling/mesh/decimation.h"
#include "object_modelling/mesh/foreign_mesh.h"
#include "object_modelling/mesh/mesh_check.h"
#include "object_modelling/mesh/surface_sampling.h"
#include "object_modelling/mesh/textured_renderer.h"

namespace object_modelling::pipeline
{
namespace
{
using base::Error;
using base::StatusCode;

constexpr double MM = 0.001;
constexpr double MIN_EDGE_M = 0.01, MAX_EDGE_M = 1.0;
constexpr double MAX_EDGE_RATIO = 0.03;  // of the diagonal: colours and marks are held by vertices
constexpr std::size_t MAX_POINTS = 500000;
constexpr float POINT_SIGMA_M = 0.0001f;  // of a surface that is taken for true
constexpr float POINT_WEIGHT = 10;        // of a surface seen well from all around

Eigen::Vector3f extentOf(const mesh::TriangleMesh& mesh)
{
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    box.extend(vertex);
  return box.sizes();
}

std::string formatted(double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

/// As few triangles as its shape needs, then as small ones as its colours need.
void makeEven(const ImportOptions& options, mesh::TexturedMesh* textured)
{
  if (textured->uvs.empty() && textured->mesh.triangles.size() > options.max_triangles &&
      mesh::checkMesh(textured->mesh).manifold())
  {
    mesh::DecimationOptions decimation;
    decimation.max_triangles = options.max_triangles;
    textured->mesh = mesh::decimate(textured->mesh, decimation).mesh;
  }
  const double diagonal_m = static_cast<double>(extentOf(textured->mesh).norm());
  *textured = mesh::subdivided(std::move(*textured), MAX_EDGE_RATIO * diagonal_m, options.max_triangles);
}

/// Row by row.
std::string formatted(const Eigen::Matrix4d& matrix)
{
  static const Eigen::IOFormat ROWS(9, Eigen::DontAlignCols, ", ", ", ", "", "", "[", "]");
  std::ostringstream text;
  text << matrix.format(ROWS);
  return text.str();
}

/// Brings the mesh into the object frame: z up as it lies most probably, the origin at the centre of its box.
/// Returns T_model_mesh.
Eigen::Isometry3d placeInFrame(const ImportOptions& options, mesh::TriangleMesh* mesh, database::ObjectModel* model)
{
  const object_properties::MassProperties mass = object_properties::massProperties(*mesh, options.properties.mass);
  const std::vector<object_properties::RestingPose> poses =
      object_properties::restingPoses(mesh->vertices, mass.center_of_mass_m, {}, options.properties.resting_poses);
  if (poses.empty())
    throw Error(StatusCode::BAD_INPUT, "the mesh is flat: an object needs a volume");
  const Eigen::Vector3d up = poses.front().T_support_model.linear().row(2).transpose();
  geometry::OrientedBox box = geometry::boxAlong(up, mesh->vertices);
  const Eigen::Isometry3d T_model_mesh = box.T_frame_box.inverse();
  mesh::transform(T_model_mesh, mesh);
  box.T_frame_box = Eigen::Isometry3d::Identity();
  model->box_model = box;
  Eigen::Isometry3d T_support_model = Eigen::Isometry3d::Identity();
  T_support_model.translation().z() = box.size_m.z() / 2;
  model->T_support_model = { T_support_model };
  model->diameter_m = diameter_m(mesh->vertices);
  return T_model_mesh;
}

Eigen::Matrix<std::uint8_t, 3, 1> colorAt(const mesh::TexturedMesh& textured, const mesh::SurfaceSample& sample)
{
  if (textured.uvs.empty())
  {
    Eigen::Vector3d color = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      color +=
          sample.shares[k] *
          textured.mesh.colors[textured.mesh.triangles[sample.triangle][static_cast<std::size_t>(k)]].cast<double>();
    return color.array().round().matrix().cast<std::uint8_t>();
  }
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  for (int k = 0; k < 3; ++k)
    uv += static_cast<float>(sample.shares[k]) * textured.uvs[sample.triangle][static_cast<std::size_t>(k)];
  const Eigen::Vector2f texel = textured.texel(uv);
  const int u = std::clamp(static_cast<int>(std::lround(texel.x())), 0, textured.texture_bgr.cols - 1);
  const int v = std::clamp(static_cast<int>(std::lround(texel.y())), 0, textured.texture_bgr.rows - 1);
  const cv::Vec3b& bgr = textured.texture_bgr.at<cv::Vec3b>(v, u);
  return { bgr[2], bgr[1], bgr[0] };
}

fusion::FusedCloud cloudOf(const mesh::TexturedMesh& textured, double resolution_m)
{
  const double wanted = mesh::surfaceArea_m2(textured.mesh) / (resolution_m * resolution_m);
  fusion::FusedCloud cloud;
  const auto count = static_cast<std::size_t>(std::min(wanted, static_cast<double>(MAX_POINTS))) + 1;
  for (const mesh::SurfaceSample& sample : mesh::sampleEvenly(textured.mesh, count))
  {
    const auto& [a, b, c] = textured.mesh.triangles[sample.triangle];
    const Eigen::Vector3f& origin = textured.mesh.vertices[a];
    cloud.points.emplace_back(mesh::pointAt(textured.mesh, sample).cast<float>());
    cloud.normals.emplace_back(
        (textured.mesh.vertices[b] - origin).cross(textured.mesh.vertices[c] - origin).normalized());
    cloud.colors.push_back(colorAt(textured, sample));
    cloud.weights.push_back(POINT_WEIGHT);
    cloud.sigmas_m.push_back(POINT_SIGMA_M);
  }
  return cloud;
}
}  // namespace

std::vector<std::string> ImportOptions::violations() const
{
  base::OptionsCheck check("import_mesh");
  check.atLeast("unit_m", unit_m, 0.0);
  check.inRange("cloud_resolution_m", cloud_resolution_m, 0.0001, 0.1);
  check.atLeast("max_triangles", max_triangles, std::size_t(100));
  check.include(properties.violations());
  return check.violations();
}

double unitBySize_m(double largest_edge)
{
  for (const double unit_m : { 1.0, MM })
    if (largest_edge * unit_m >= MIN_EDGE_M && largest_edge * unit_m <= MAX_EDGE_M)
      return unit_m;
  throw Error(StatusCode::INVALID_ARGUMENT,
              "the unit of the mesh is not clear: its largest edge is " + formatted(largest_edge) +
                  ", which is 10 mm to 1 m neither in metres nor in millimetres; say --unit mm or --unit m");
}

database::ObjectModel modelFromMesh(const std::string& path, const std::string& object_id, const std::string& name,
                                    const ImportOptions& options, base::JobControl& control)
{
  base::checked(options);
  control.report("read mesh", 0, 1);
  mesh::TexturedMesh textured = mesh::readForeignMesh(path);
  const double unit_m =
      options.unit_m > 0 ? options.unit_m : unitBySize_m(static_cast<double>(extentOf(textured.mesh).maxCoeff()));
  for (Eigen::Vector3f& vertex : textured.mesh.vertices)
    vertex *= static_cast<float>(unit_m);
  control.report("read mesh", 1, 1);

  database::ObjectModel model;
  model.id = object_id;
  model.name = name.empty() ? object_id : name;
  const Eigen::Isometry3d T_model_mesh = placeInFrame(options, &textured.mesh, &model);
  makeEven(options, &textured);
  if (textured.mesh.colors.empty())
    textured.mesh.colors.assign(textured.mesh.vertices.size(), { 180, 180, 180 });
  textured.seen = cv::Mat(textured.texture_bgr.size(), CV_8UC1, cv::Scalar(255));
  model.cloud = cloudOf(textured, options.cloud_resolution_m);
  model.views = renderedViews(textured, model.diameter_m, control);
  model.mesh = textured.mesh;
  model.mesh.seen.assign(model.mesh.vertices.size(), 1);
  model.mesh_sigmas_m.assign(model.mesh.vertices.size(), POINT_SIGMA_M);
  model.properties = object_properties::propertiesOf(model.mesh, {}, options.properties, control);
  model.properties->unseen = object_properties::Unseen{ 0, false };  // the file has the whole surface
  if (!textured.texture_bgr.empty())
    model.textured = std::move(textured);
  drawPictures(&model);
  model.quality = { { "view_count", static_cast<double>(model.views.size()) } };
  model.provenance = { { "software", "object_modelling " OBJECT_MODELLING_VERSION },
                       { "imported_mesh", std::filesystem::path(path).filename().string() },
                       { "imported_unit_m", formatted(unit_m) },
                       { "model_from_imported_mesh", formatted(T_model_mesh.matrix()) },
                       { "views", "rendered" } };
  return model;
}

ImportReport importMesh(const std::string& path, const std::string& object_id, const std::string& name,
                        database::ObjectDatabase& database, const ImportOptions& options, base::JobControl& control)
{
  database::checkObjectId(object_id);
  const std::vector<database::ObjectEntry> there = database.list();
  const auto existing = std::find_if(there.begin(), there.end(),
                                     [&](const database::ObjectEntry& entry) { return entry.id == object_id; });
  if (existing != there.end() && !options.replace)
    throw Error(StatusCode::INVALID_ARGUMENT, "object '" + object_id + "' is in " + database.root() +
                                                  " already: choose another id, or import with replace");
  database::ObjectModel model = modelFromMesh(path, object_id, name, options, control);
  if (existing != there.end())
  {
    model.aliases = existing->aliases;
    model.frame_version = existing->frame_version + 1;  // the file's pose has nothing to do with it
  }
  ImportReport report;
  report.object_folder = database.write(model, control);
  report.unit_m = std::stod(model.provenance.at("imported_unit_m"));
  report.size_m = model.box_model.size_m;
  report.properties = object_properties::summaryText(*model.properties, model.properties->collision_parts.size());
  return report;
}

}  // namespace object_modelling::pipeline
