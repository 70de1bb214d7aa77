#pragma once

#include <vector>

#include "object_modelling/geometry/point_index.h"
#include "object_modelling/mesh/reference_surface.h"

namespace object_modelling::evaluation
{
/// Every n-th point, about `count` of them.
std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points, std::size_t count);

/// The nearest of fixed points. Queries are safe from several threads.
class SampleTree
{
public:
  explicit SampleTree(const std::vector<Eigen::Vector3d>& samples);
  /// Index of the nearest sample and the distance to it.
  std::size_t nearest(const Eigen::Vector3d& query, double* distance_m) const;
  const Eigen::Vector3d& sample(std::size_t index) const { return samples_[index]; }

private:
  std::vector<Eigen::Vector3d> samples_;
  geometry::PointIndexOf<double> index_;
};

struct Placement
{
  Eigen::Isometry3d T_reference_model = Eigen::Isometry3d::Identity();
  double rms_m = 0;  ///< of the points that take part
};

/// Point-to-point ICP in which the nearest `overlap_ratio` of the points take part.
Placement trimmedIcp(const std::vector<Eigen::Vector3d>& points, const SampleTree& tree, Placement start,
                     double overlap_ratio, int iterations);

/// One Gauss-Newton step of the weighted distances to the triangles, along the directions to their nearest points,
/// which serve as normals and hold at edges too. Returns the step's size (m): rotation counts by the radius of the
/// points. Directions that the surface leaves free (round a can's axis) stay.
double fitToSurface(const std::vector<Eigen::Vector3d>& points, const mesh::ReferenceSurface& surface,
                    Eigen::Isometry3d* T_reference_model);

/// Root mean square distance to the triangles of the nearest `overlap_ratio` of the points.
double trimmedRms_m(const std::vector<Eigen::Vector3d>& points, const mesh::ReferenceSurface& surface,
                    const Eigen::Isometry3d& T_reference_model, double overlap_ratio);

}  // namespace object_modelling::evaluation
