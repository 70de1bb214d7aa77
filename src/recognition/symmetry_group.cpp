#include "object_modelling/recognition/symmetry_group.h"

#include <algorithm>
#include <cmath>

namespace object_modelling::recognition
{
namespace
{
constexpr double SAME_TURN_RAD = 0.1;  // of axes that were found with some error

double angleOf(const Eigen::Matrix3d& R)
{
  return std::acos(std::clamp((R.trace() - 1) / 2, -1.0, 1.0));
}
}  // namespace

SymmetryGroup::SymmetryGroup(const std::vector<object_properties::Symmetry>& symmetries,
                             object_properties::Symmetry::Of of)
{
  std::vector<Eigen::Matrix3d> generators;
  for (const object_properties::Symmetry& symmetry : symmetries)
  {
    if (symmetry.of != of)
      continue;
    if (!symmetry.continuous())
      generators.push_back(Eigen::AngleAxisd(2 * M_PI / symmetry.order, symmetry.axis).toRotationMatrix());
    else if (!round_axis_)
      round_axis_ = symmetry.axis;
    else if (round_axis_->cross(symmetry.axis).norm() > std::sin(SAME_TURN_RAD))
      ball_ = true;
  }
  for (std::size_t i = 0; i < turns_.size(); ++i)
    for (const Eigen::Matrix3d& generator : generators)
    {
      const Eigen::Matrix3d turn = turns_[i] * generator;
      const bool known =
          std::any_of(turns_.begin(), turns_.end(),
                      [&](const Eigen::Matrix3d& other) { return angleOf(other.transpose() * turn) < SAME_TURN_RAD; });
      if (!known && turns_.size() < MOST_TURNS)
        turns_.push_back(turn);
    }
}

double SymmetryGroup::angleBetween(const Eigen::Matrix3d& R_camera_model, const Eigen::Matrix3d& R_camera_other) const
{
  if (ball_)
    return 0;
  double least = M_PI;
  for (const Eigen::Matrix3d& turn : turns_)
  {
    const Eigen::Matrix3d between = R_camera_model.transpose() * R_camera_other * turn;
    const double angle =
        round_axis_ ? std::acos(std::clamp(round_axis_->dot(between * *round_axis_), -1.0, 1.0)) : angleOf(between);
    least = std::min(least, angle);
  }
  return least;
}

}  // namespace object_modelling::recognition
