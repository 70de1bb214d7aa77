#include "object_modelling/recognition/object_knowledge.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "knowledge_file.h"
#include "lab_color.h"
#include "object_modelling/base/options.h"
#include "object_modelling/database/cloud_file.h"
#include "object_modelling/database/view_files.h"
#include "object_modelling/features/keyframe_features.h"
#include "object_modelling/mesh/decimation.h"
#include "object_modelling/mesh/mesh_check.h"
#include "object_modelling/mesh/mesh_files.h"

namespace object_modelling::recognition
{
namespace
{
constexpr char FILE_NAME[] = "knowledge.bin";

/// Every n-th cloud point, so that about `count` remain.
ColoredSurface surfaceOf(const fusion::FusedCloud& cloud, std::size_t count)
{
  // Spread over the surface, not over the file: by cubes, whose edge follows from the area that a point stands for.
  OrientedPoints all{ cloud.points, cloud.normals };
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / count);
  ColoredSurface surface;
  std::vector<Eigen::Matrix<std::uint8_t, 3, 1>> colors;
  for (std::size_t i = 0; i < cloud.size(); i += step)
  {
    surface.oriented.points.push_back(all.points[i]);
    surface.oriented.normals.push_back(all.normals[i]);
    colors.push_back(cloud.colors[i]);
  }
  surface.lab = labOf(colors);
  return surface;
}

mesh::TriangleMesh fewTriangles(const mesh::TriangleMesh& mesh, const LearningOptions& options)
{
  if (!mesh::checkMesh(mesh).manifold())
    return mesh;  // cannot be thinned: drawn as it is
  mesh::DecimationOptions decimation;
  decimation.max_triangles = options.max_triangles;
  decimation.max_error_m = options.max_mesh_error_m;
  return mesh::decimate(mesh, decimation).mesh;
}

void learnFeatures(const std::vector<rgbd::View>& views, const LearningOptions& options, base::JobControl& control,
                   ObjectKnowledge* object)
{
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    control.report("learn '" + object->id + "'", i, views.size());
    const features::KeyframeFeatures found =
        features::detectFeatures(views[i].frame, options.max_features_per_view, true);
    for (std::size_t k = 0; k < found.features.size(); ++k)
    {
      if (!(found.features[k].depth_m > 0))
        continue;
      object->feature_points.push_back((views[i].T_world_camera * found.features[k].p_camera).cast<float>());
      object->descriptors.push_back(found.descriptors.row(static_cast<int>(k)));
      object->norm = found.norm;
    }
  }
}

/// What the database says of it.
ObjectKnowledge describedBy(const database::ObjectEntry& entry)
{
  ObjectKnowledge object;
  object.id = entry.id;
  object.name = entry.name;
  object.content_hash = entry.content_hash;
  object.diameter_m = entry.diameter_m;
  object.box_model = entry.box_model;
  object.center_model = entry.box_model.T_frame_box.translation().cast<float>();
  return object;
}

/// What is in its files; this takes time.
void learn(const database::ObjectDatabase& database, const database::ObjectEntry& entry, const LearningOptions& options,
           base::JobControl& control, ObjectKnowledge* object)
{
  const std::string folder = database.root() + "/" + entry.id;
  const fusion::FusedCloud cloud = database::readCloud(folder + "/cloud.pcd");
  object->surface = surfaceOf(cloud, options.surface_points);
  object->texture = surfaceOf(cloud, options.texture_points);
  object->colored = std::any_of(cloud.colors.begin(), cloud.colors.end(),
                                [&](const auto& color) { return color != cloud.colors.front(); });
  object->pairs = PairTable({ cloud.points, cloud.normals }, object->diameter_m, options.pairs);
  object->mesh = fewTriangles(mesh::readMesh(entry.mesh_path), options);
  learnFeatures(database::readViews(folder, options.max_views), options, control, object);
}

void addSymmetries(const database::ObjectEntry& entry, ObjectKnowledge* object)
{
  using Of = object_properties::Symmetry::Of;
  if (entry.properties)
    object->symmetries = SymmetryGroup(entry.properties->symmetries, object->colored ? Of::TEXTURE : Of::SHAPE);
}
}  // namespace

std::vector<std::string> LearningOptions::violations() const
{
  base::OptionsCheck check("learning");
  check.atLeast("max_features_per_view", max_features_per_view, 10);
  check.positive("max_mesh_error_m", max_mesh_error_m);
  return check.violations();
}

std::shared_ptr<const ObjectKnowledge> learnObject(const database::ObjectDatabase& database,
                                                   const database::ObjectEntry& entry, const LearningOptions& options,
                                                   base::JobControl& control)
{
  auto object = std::make_shared<ObjectKnowledge>(describedBy(entry));
  learn(database, entry, options, control, object.get());
  addSymmetries(entry, object.get());
  return object;
}

LearntObject recallOrLearn(database::ObjectDatabase& database, const database::ObjectEntry& entry,
                           const LearningOptions& options, base::JobControl& control)
{
  LearntObject learnt;
  auto object = std::make_shared<ObjectKnowledge>(describedBy(entry));
  const std::string key = knowledgeKey(entry.content_hash, options);
  learnt.recalled =
      readKnowledge(database::ObjectDatabase::derivedPath(database.root(), entry.id, FILE_NAME), key, object.get());
  if (!learnt.recalled)
  {
    learn(database, entry, options, control, object.get());
    try
    {
      database.keepDerived(
          entry.id, entry.content_hash, FILE_NAME, [&](const std::string& path) { writeKnowledge(path, key, *object); },
          control);
    }
    catch (const base::Cancelled&)
    {
      throw;
    }
    catch (const base::Error& error)
    {
      learnt.kept = error.status();
    }
  }
  addSymmetries(entry, object.get());
  learnt.knowledge = std::move(object);
  return learnt;
}

}  // namespace object_modelling::recognition
