#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/registration/partial_model.h"

namespace object_modelling::registration
{
/// Answers at once which point of a partial model is nearest: a grid round the surface holds it for every cell. Nearest
/// to the cell's centre, that is; point-to-plane distances do not feel the difference.
class SurfaceField
{
public:
  /// `reach_m`: farther from the surface nothing is found. Cells become larger than asked for where there would be too
  /// many of them.
  SurfaceField(const std::vector<Eigen::Vector3f>& points, double reach_m, double cell_m);

  /// -1 beyond the reach.
  int nearest(const Eigen::Vector3f& p) const
  {
    const Eigen::Vector3f cell = (p - corner_) * cells_per_m_;
    // Before they become integers, which what is far off or not finite does not fit into.
    if (!((cell.array() >= 0).all() && (cell.array() < limit_.array()).all()))
      return -1;
    const int x = static_cast<int>(cell.x()), y = static_cast<int>(cell.y()), z = static_cast<int>(cell.z());
    return nearest_[(static_cast<std::size_t>(z) * size_.y() + y) * size_.x() + x];
  }

private:
  Eigen::Vector3f corner_ = Eigen::Vector3f::Zero();
  float cells_per_m_ = 1;
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  Eigen::Vector3f limit_ = Eigen::Vector3f::Zero();  ///< the size as what it is compared with
  std::vector<int> nearest_;
};

}  // namespace object_modelling::registration
