#pragma once

#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/base/job_control.h"
#include "object_modelling/database/object_database.h"
#include "object_modelling/mesh/triangle_mesh.h"
#include "object_modelling/recognition/pair_features.h"
#include "object_modelling/recognition/symmetry_group.h"

namespace object_modelling::recognition
{
struct LearningOptions
{
  std::size_t max_views = 30;         ///< whose features are learnt
  int max_features_per_view = 250;    ///< by response
  std::size_t max_triangles = 3000;   ///< of the mesh that hypotheses are drawn with
  double max_mesh_error_m = 0.0015;   ///< of that mesh
  std::size_t surface_points = 1500;  ///< about, for the alignment of hypotheses
  std::size_t texture_points = 9000;  ///< about, for the comparison of colours
  PairFeatureOptions pairs;
  std::vector<std::string> violations() const;
};

/// A surface with colours, metres, object frame.
struct ColoredSurface
{
  OrientedPoints oriented;
  std::vector<Eigen::Vector3f> lab;  ///< CIE L*a*b*, L in [0, 100]
};

/// What a recogniser has learnt from one object of a database. Object frame, metres. Never changed once made, and
/// shared.
struct ObjectKnowledge
{
  std::string id, name, content_hash;
  double diameter_m = 0;
  geometry::OrientedBox box_model;
  Eigen::Vector3f center_model = Eigen::Vector3f::Zero();  ///< of the box
  mesh::TriangleMesh mesh;                                 ///< few triangles, with vertex colours
  ColoredSurface surface;
  ColoredSurface texture;    ///< more points of the same
  bool colored = true;       ///< false: one colour all over, as an imported mesh without colours; says nothing then
  SymmetryGroup symmetries;  ///< of shape with texture
  PairTable pairs;
  std::vector<Eigen::Vector3f> feature_points;  ///< where the features are
  cv::Mat descriptors;                          ///< one row per feature; empty for an object without texture
  int norm = 0;                                 ///< cv::NormTypes of the descriptors
};

/// Learns an object from its database alone. Throws base::Error (NOT_FOUND, BAD_INPUT naming the file), or what
/// `control` throws when cancelled. Deterministic.
std::shared_ptr<const ObjectKnowledge> learnObject(const database::ObjectDatabase& database,
                                                   const database::ObjectEntry& entry, const LearningOptions& options,
                                                   base::JobControl& control);

/// An object that is known, and whether it will be known at once the next time.
struct LearntObject
{
  std::shared_ptr<const ObjectKnowledge> knowledge;
  bool recalled = false;  ///< it was learnt earlier, and only read
  base::Status kept;      ///< STORAGE: why what was learnt could not be written
};

/// As learnObject(), or read from recognition/ in the object's folder if the same was learnt earlier; else kept there.
/// A damaged file, or one of another version, is learnt anew.
LearntObject recallOrLearn(database::ObjectDatabase& database, const database::ObjectEntry& entry,
                           const LearningOptions& options, base::JobControl& control);

}  // namespace object_modelling::recognition
