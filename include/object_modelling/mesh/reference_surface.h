#pragma once

#include <memory>
#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::mesh
{
/// Nearest points on the triangles themselves (not on their corners or on samples) of a mesh that is taken for true.
/// Metres. Queries are not for several threads at once.
class ReferenceSurface
{
public:
  /// Throws base::Error (BAD_INPUT) for a mesh without triangles, with vertices that are not finite or with no area.
  explicit ReferenceSurface(const TriangleMesh& mesh);
  ~ReferenceSurface();

  Eigen::Vector3d closestPoint(const Eigen::Vector3d& p_reference) const;
  double distance_m(const Eigen::Vector3d& p_reference) const;

  /// Points spread evenly over the area, the same ones every time.
  const std::vector<Eigen::Vector3d>& samples() const { return samples_; }
  std::size_t triangleCount() const { return triangle_count_; }
  /// Diagonal of the box along the axes.
  double diagonal_m() const { return diagonal_m_; }

private:
  class Locator;
  std::unique_ptr<Locator> locator_;
  std::vector<Eigen::Vector3d> samples_;
  std::size_t triangle_count_ = 0;
  double diagonal_m_ = 0;
};

}  // namespace object_modelling::mesh
