#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::object_properties
{
/// A proper rotation (or all about one axis) under which an object stays the same. Frame of the mesh.
struct Symmetry
{
  enum class Of
  {
    SHAPE,
    TEXTURE  ///< shape and vertex colours
  };
  Of of = Of::SHAPE;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();    ///< unit length
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< on the axis
  int order = 2;                                      ///< turns by 360/order degrees; 0: by any angle
  double error_m = 0;                                 ///< rms distance of the turned surface from itself

  bool continuous() const { return order == 0; }
};

struct SymmetryOptions
{
  double min_tolerance_m = 0.001;    ///< of error_m, for small objects
  double tolerance_ratio = 0.01;     ///< of error_m in the diameter, for large ones; the greater of the two counts
  double max_quantile_ratio = 2;     ///< 95 % of the surface are no further off than that many tolerances
  double max_color_difference = 20;  ///< of 255: rms over the surface, light taken off
  double min_counted_ratio = 0.3;    ///< of the surface that must have been seen and come to lie on seen surface
  int max_order = 6;                 ///< of discrete symmetries
  std::vector<std::string> violations() const;
};

/// Symmetries of a surface and of its vertex colours, those of shape first, the strongest first. Tried are the axes of
/// the second moments and of the box, and where the moments leave an axis open a fan of others; each is refined by
/// aligning the turned surface with itself. Of each axis the highest order that holds is told, not the lower ones that
/// it implies. Round about an axis: this one, and one two-fold axis across it where there is any. A ball: two axes,
/// which make all its rotations. What `seen` of the mesh marks as unseen does not count. None for a mesh without area.
/// Throws base::Error (INVALID_ARGUMENT) for broken options.
std::vector<Symmetry> findSymmetries(const mesh::TriangleMesh& mesh, const SymmetryOptions& options = {});

}  // namespace object_modelling::object_properties
