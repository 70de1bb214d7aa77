#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/object_properties/symmetry.h"

namespace object_modelling::recognition
{
/// Rotations under which an object looks the same.
class SymmetryGroup
{
public:
  SymmetryGroup() = default;  ///< none

  /// All that follow from those of the kind `of`; at most MOST_TURNS.
  SymmetryGroup(const std::vector<object_properties::Symmetry>& symmetries, object_properties::Symmetry::Of of);

  /// Least angle (rad) between two rotations of the object, over what makes no difference.
  double angleBetween(const Eigen::Matrix3d& R_camera_model, const Eigen::Matrix3d& R_camera_other) const;

  static constexpr std::size_t MOST_TURNS = 60;

private:
  std::vector<Eigen::Matrix3d> turns_{ Eigen::Matrix3d::Identity() };
  std::optional<Eigen::Vector3d> round_axis_;
  bool ball_ = false;  // two round axes make every turn one
};

}  // namespace object_modelling::recognition
