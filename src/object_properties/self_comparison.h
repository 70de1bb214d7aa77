#pragma once

#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/geometry/point_index.h"
#include "object_modelling/mesh/reference_surface.h"
#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::object_properties
{
/// An axis in the frame of the mesh.
struct Axis
{
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit length
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();     ///< on it

  Eigen::Isometry3d turn(double angle_rad) const;
};

/// How far a turned surface lies from itself.
struct SelfDistance
{
  double rms_m = 0;
  double quantile_95_m = 0;
  double counted_ratio = 0;  ///< of the surface that was seen and came to lie on seen surface
};

/// One surface compared with itself after a rotation; what no camera saw is left out on either side.
class SelfComparison
{
public:
  explicit SelfComparison(const mesh::TriangleMesh& mesh);

  /// On few samples, to samples: for a search.
  SelfDistance roughDistance(const Eigen::Isometry3d& T) const;
  /// To the triangles themselves.
  SelfDistance distance(const Eigen::Isometry3d& T) const;
  /// The axis near `axis` about which the surface, turned by `angle_rad`, fits itself best (point-to-plane ICP).
  Axis refined(const Axis& axis, double angle_rad) const;
  bool hasColors() const { return !colors_.empty(); }
  /// Rms over the surface, of 255, of the colour channels' mean difference, without that of the light.
  double colorDifference(const Eigen::Isometry3d& T) const;

  bool empty() const { return points_.empty(); }
  double diameter_m() const { return diameter_m_; }
  Eigen::Vector3d centroid() const { return centroid_; }
  /// Of the seen surface about the centroid, ascending, with their directions as columns.
  Eigen::Vector3d moments_m2() const { return moments_m2_; }
  Eigen::Matrix3d momentAxes() const { return moment_axes_; }

private:
  void describe();
  SelfDistance summary(std::vector<double> distances_m, std::size_t probed) const;

  mesh::ReferenceSurface reference_;
  std::vector<Eigen::Vector3f> points_, normals_, colors_;
  std::vector<std::uint8_t> seen_;
  std::unique_ptr<geometry::PointIndex> index_;
  double spacing_m_ = 0;
  double diameter_m_ = 0;
  Eigen::Vector3d centroid_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d moments_m2_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moment_axes_ = Eigen::Matrix3d::Identity();
};

}  // namespace object_modelling::object_properties
