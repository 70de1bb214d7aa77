#include "object_modelling/registration/partial_model.h"

#include <algorithm>
#include <cmath>

namespace object_modelling::registration
{
Eigen::Vector3f PartialModel::center() const
{
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : points)
    box.extend(p);
  return points.empty() ? Eigen::Vector3f::Zero() : Eigen::Vector3f(box.center());
}

double PartialModel::radius_m() const
{
  const Eigen::Vector3f middle = center();
  float squared = 0;
  for (const Eigen::Vector3f& p : points)
    squared = std::max(squared, (p - middle).squaredNorm());
  return std::sqrt(squared);
}

}  // namespace object_modelling::registration
