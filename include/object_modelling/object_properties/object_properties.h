#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/object_properties/convex_parts.h"
#include "object_modelling/object_properties/mass_properties.h"
#include "object_modelling/object_properties/resting_poses.h"
#include "object_modelling/object_properties/symmetry.h"

namespace object_modelling::object_properties
{
/// What no camera saw of an object.
struct Unseen
{
  double ratio = 0;     ///< of the mesh's area
  bool bottom = false;  ///< of the side on which it stands in its first resting pose, most was not seen
};

struct PropertyOptions
{
  MassOptions mass;
  RestingPoseOptions resting_poses;
  SymmetryOptions symmetry;
  ConvexPartsOptions convex_parts;
  std::vector<std::string> violations() const;
};

/// What follows from an object's mesh, in the object frame.
struct ObjectProperties
{
  MassProperties mass;
  std::vector<RestingPose> resting_poses;  ///< most probable first
  std::vector<Symmetry> symmetries;
  std::vector<mesh::TriangleMesh> collision_parts;  ///< convex
  std::optional<Unseen> unseen;                     ///< none where the mesh does not say what was seen
};

/// `recorded_T_support_model`: resting poses that the object was recorded in, the first of them that of its frame.
/// Reports the stage "properties". Throws base::Error (INVALID_ARGUMENT) for broken options, Cancelled.
ObjectProperties propertiesOf(const mesh::TriangleMesh& mesh,
                              const std::vector<Eigen::Isometry3d>& recorded_T_support_model,
                              const PropertyOptions& options, base::JobControl& control);

/// Of a mesh that says what was seen (TriangleMesh::seen).
Unseen unseenOf(const mesh::TriangleMesh& mesh, const Eigen::Isometry3d& T_support_model);

/// One line for people: volume, symmetries, resting poses, and what was not seen. The count of convex parts is given
/// for properties whose parts have not been loaded.
std::string summaryText(const ObjectProperties& properties, std::size_t part_count);

}  // namespace object_modelling::object_properties
