#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>

#include "cost_functions.h"
#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
template <typename T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

/// W with W^T W = information, which may be singular: directions that nothing is known of.
geometry::Matrix6d rootOf(const geometry::Matrix6d& information)
{
  const geometry::EigenSystem<6> system = geometry::eigenSystem(information);
  return system.values.cwiseMax(0).cwiseSqrt().asDiagonal() * system.vectors.transpose();
}

class SurfaceCost
{
public:
  SurfaceCost(const Eigen::Isometry3d& T_a_b_start, const SurfaceLink& link)
      : T_a_b_start_(T_a_b_start),
        T_b_a_measured_(link.T_a_b.inverse()),
        weight_(rootOf(link.information)),
        by_color_offset_(link.by_color_offset),
        color_offset_px_(link.color_offset_px)
  {
  }

  /// E = M_a T_a_b_start M_b^-1 T_b_a_measured, whose vector is the error.
  template <typename T>
  bool operator()(const T* motion_a, const T* motion_b, const T* color_offset_px, T* residuals) const
  {
    Matrix3<T> R_a, R_b;
    ceres::AngleAxisToRotationMatrix(motion_a + 3, R_a.data());
    ceres::AngleAxisToRotationMatrix(motion_b + 3, R_b.data());
    const Eigen::Map<const Vector3<T>> t_a(motion_a), t_b(motion_b);
    const Matrix3<T> R = R_a * T_a_b_start_.linear().cast<T>() * R_b.transpose();
    const Vector3<T> t = R_a * T_a_b_start_.translation().cast<T>() + t_a - R * t_b;
    const Matrix3<T> R_error = R * T_b_a_measured_.linear().cast<T>();
    Eigen::Matrix<T, 6, 1> error;
    error.template head<3>() = R * T_b_a_measured_.translation().cast<T>() + t;
    ceres::RotationMatrixToAngleAxis(R_error.data(), error.data() + 3);
    // The error is small, so that what the offset does to the measurement may be taken off its vector.
    const Eigen::Map<const Eigen::Matrix<T, 2, 1>> offset_px(color_offset_px);
    error -= by_color_offset_.cast<T>() * (offset_px - color_offset_px_.cast<T>());
    Eigen::Map<Eigen::Matrix<T, 6, 1>> weighted(residuals);
    weighted = weight_.cast<T>() * error;
    return true;
  }

private:
  Eigen::Isometry3d T_a_b_start_, T_b_a_measured_;
  geometry::Matrix6d weight_;
  Eigen::Matrix<double, 6, 2> by_color_offset_;
  Eigen::Vector2d color_offset_px_;
};
}  // namespace

ceres::CostFunction* surfaceCost(const LinearizedCamera& a, const LinearizedCamera& b, const SurfaceLink& link)
{
  return new ceres::AutoDiffCostFunction<SurfaceCost, 6, 6, 6, 2>(
      new SurfaceCost(a.T_camera_session * b.T_camera_session.inverse(), link));
}

}  // namespace object_modelling::bundle_adjustment
