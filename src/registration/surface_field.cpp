#include "object_modelling/registration/surface_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace object_modelling::registration
{
namespace
{
constexpr double MAX_CELLS = 8e6;
}

SurfaceField::SurfaceField(const std::vector<Eigen::Vector3f>& points, double reach_m, double cell_m)
{
  if (points.empty())
    return;
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : points)
    box.extend(p);
  const auto reach = static_cast<float>(reach_m);
  corner_ = box.min() - Eigen::Vector3f::Constant(reach);
  const double volume_m3 = (box.sizes().cast<double>().array() + 2 * reach_m).prod();
  const auto cell = static_cast<float>(std::max(cell_m, std::cbrt(volume_m3 / MAX_CELLS)));
  cells_per_m_ = 1 / cell;
  size_ = ((box.sizes() + Eigen::Vector3f::Constant(2 * reach)) * cells_per_m_).array().ceil().cast<int>() + 1;
  limit_ = size_.cast<float>();
  nearest_.assign(static_cast<std::size_t>(size_.prod()), -1);
  std::vector<float> squared(nearest_.size(), reach * reach);
  // Each point offers itself to the cells in reach.
  for (int i = 0; i < static_cast<int>(points.size()); ++i)
  {
    const Eigen::Vector3f at = points[i] - corner_;
    const Eigen::Vector3i low = ((at.array() - reach) * cells_per_m_).floor().cast<int>().max(0);
    const Eigen::Vector3i high = ((at.array() + reach) * cells_per_m_).ceil().cast<int>().min(size_.array() - 1);
    for (int z = low.z(); z <= high.z(); ++z)
    {
      const float dz = (static_cast<float>(z) + 0.5F) * cell - at.z();
      for (int y = low.y(); y <= high.y(); ++y)
      {
        const float dy = (static_cast<float>(y) + 0.5F) * cell - at.y();
        const float beside = dz * dz + dy * dy;
        const std::size_t row = (static_cast<std::size_t>(z) * size_.y() + y) * size_.x();
        for (int x = low.x(); x <= high.x(); ++x)
        {
          const float dx = (static_cast<float>(x) + 0.5F) * cell - at.x();
          const float distance = beside + dx * dx;
          if (distance < squared[row + x])
          {
            squared[row + x] = distance;
            nearest_[row + x] = i;
          }
        }
      }
    }
  }
}

}  // namespace object_modelling::registration
