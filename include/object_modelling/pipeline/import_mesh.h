#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/database/object_database.h"

namespace object_modelling::pipeline
{
struct ImportOptions
{
  double unit_m = 0;                  ///< length of the file's unit; 0: found by the size (unitBySize_m)
  double cloud_resolution_m = 0.001;  ///< spacing of the points on the surface
  std::size_t max_triangles = 40000;  ///< of the mesh
  bool replace = false;               ///< an object of this id that is there already
  object_properties::PropertyOptions properties;
  std::vector<std::string> violations() const;
};

/// Millimetres or metres, whichever makes the largest edge of the mesh's box 10 mm to 1 m. Throws base::Error
/// (INVALID_ARGUMENT) if neither does.
double unitBySize_m(double largest_edge);

/// An object made of a mesh file alone (CAD, a scan; mesh::readForeignMesh), as one that was recorded: z up in its most
/// probable resting pose, the origin at the centre of its box, with cloud, mesh, texture where there is one, and
/// rendered views from all around.
database::ObjectModel modelFromMesh(const std::string& path, const std::string& object_id, const std::string& name,
                                    const ImportOptions& options, base::JobControl& control);

struct ImportReport
{
  std::string object_folder;
  double unit_m = 0;  ///< the one taken
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  std::string properties;  ///< in one line
};

/// Writes it into the database. Throws base::Error: INVALID_ARGUMENT (options, object id, the object exists),
/// NOT_FOUND, BAD_INPUT (mesh), STORAGE, Cancelled.
ImportReport importMesh(const std::string& path, const std::string& object_id, const std::string& name,
                        database::ObjectDatabase& database, const ImportOptions& options, base::JobControl& control);

}  // namespace object_modelling::pipeline
