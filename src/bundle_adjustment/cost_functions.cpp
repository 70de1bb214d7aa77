#include "cost_functions.h"

#include "object_modelling/geometry/so3.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
// A landmark this close to the camera's plane has no pixel. It costs as much as a gross outlier and pulls nowhere:
// refusing the step instead would let one bad landmark stop all others.
constexpr double MIN_DEPTH_M = 1e-3;
constexpr double BEHIND_SIGMAS = 1e3;

using MotionJacobian = Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>>;
using PointJacobian = Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>;
using IntrinsicsJacobian = Eigen::Map<Eigen::Matrix<double, 2, 4, Eigen::RowMajor>>;
using OffsetJacobian = Eigen::Map<Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>;

}  // namespace

Eigen::Vector3d LinearizedCamera::transform(const double* xi, const double* p_session,
                                            Eigen::Matrix<double, 3, 6>* by_motion, Eigen::Matrix3d* by_point) const
{
  const Eigen::Map<const Eigen::Vector3d> t(xi), r(xi + 3), p(p_session);
  const Eigen::Matrix3d R = geometry::rotationFromVector(r);
  const Eigen::Vector3d rotated = R * (T_camera_session * p);
  if (by_motion != nullptr)
  {
    by_motion->leftCols<3>().setIdentity();
    by_motion->rightCols<3>() = -geometry::crossMatrix(rotated) * geometry::leftJacobian(r);
  }
  if (by_point != nullptr)
    *by_point = R * T_camera_session.linear();
  return rotated + t;
}

bool ReprojectionCost::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const
{
  Eigen::Matrix<double, 3, 6> by_motion;
  Eigen::Matrix3d by_point;
  const bool derive = jacobians != nullptr;
  const Eigen::Vector3d p =
      camera_->transform(parameters[0], parameters[1], derive ? &by_motion : nullptr, derive ? &by_point : nullptr);
  if (!(p.z() > MIN_DEPTH_M))
  {
    residuals[0] = residuals[1] = BEHIND_SIGMAS;
    if (derive && jacobians[0] != nullptr)
      MotionJacobian{ jacobians[0] }.setZero();
    if (derive && jacobians[1] != nullptr)
      PointJacobian{ jacobians[1] }.setZero();
    if (derive && jacobians[2] != nullptr)
      OffsetJacobian{ jacobians[2] }.setZero();
    if (derive && jacobians[3] != nullptr)
      IntrinsicsJacobian{ jacobians[3] }.setZero();
    return true;
  }
  const double* correction = parameters[3];
  const double fx = camera_->fx * (1 + correction[0]), fy = camera_->fy * (1 + correction[1]);
  const double x = p.x() / p.z(), y = p.y() / p.z();
  residuals[0] = (fx * x + camera_->cx + correction[2] + parameters[2][0] - pixel_.x()) / sigma_px_;
  residuals[1] = (fy * y + camera_->cy + correction[3] + parameters[2][1] - pixel_.y()) / sigma_px_;
  if (!derive)
    return true;
  Eigen::Matrix<double, 2, 3> by_camera_point;
  by_camera_point << fx / p.z(), 0, -fx * x / p.z(), 0, fy / p.z(), -fy * y / p.z();
  by_camera_point /= sigma_px_;
  if (jacobians[0] != nullptr)
    MotionJacobian{ jacobians[0] }.noalias() = by_camera_point * by_motion;
  if (jacobians[1] != nullptr)
    PointJacobian{ jacobians[1] }.noalias() = by_camera_point * by_point;
  if (jacobians[2] != nullptr)
    OffsetJacobian{ jacobians[2] } = Eigen::Matrix2d::Identity() / sigma_px_;
  if (jacobians[3] != nullptr)
  {
    IntrinsicsJacobian{ jacobians[3] } << camera_->fx * x, 0, 1, 0, 0, camera_->fy * y, 0, 1;
    IntrinsicsJacobian{ jacobians[3] } /= sigma_px_;
  }
  return true;
}

bool DepthCost::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const
{
  Eigen::Matrix<double, 3, 6> by_motion;
  Eigen::Matrix3d by_point;
  const bool derive = jacobians != nullptr;
  const Eigen::Vector3d p =
      camera_->transform(parameters[0], parameters[1], derive ? &by_motion : nullptr, derive ? &by_point : nullptr);
  const double measured_m = depth_m_ - slope_m_px_.x() * parameters[2][0] - slope_m_px_.y() * parameters[2][1];
  const double growth = 1 + parameters[3][0];
  residuals[0] = (p.z() - growth * measured_m - parameters[4][0]) / sigma_m_;
  residuals[1] = 0;
  if (!derive)
    return true;
  if (jacobians[0] != nullptr)
    MotionJacobian{ jacobians[0] } << by_motion.row(2) / sigma_m_, Eigen::Matrix<double, 1, 6>::Zero();
  if (jacobians[1] != nullptr)
    PointJacobian{ jacobians[1] } << by_point.row(2) / sigma_m_, Eigen::RowVector3d::Zero();
  if (jacobians[2] != nullptr)
    OffsetJacobian{ jacobians[2] } << growth * slope_m_px_.transpose() / sigma_m_, Eigen::RowVector2d::Zero();
  if (jacobians[3] != nullptr)
    Eigen::Map<Eigen::Vector2d>{ jacobians[3] } << -measured_m / sigma_m_, 0;
  if (jacobians[4] != nullptr)
    Eigen::Map<Eigen::Vector2d>{ jacobians[4] } << -1 / sigma_m_, 0;
  return true;
}

bool DistortedDepthCost::Evaluate(const double* const* parameters, double* residuals, double** jacobians) const
{
  constexpr int FIRST_KNOT = 5;
  if (!undistorted_->Evaluate(parameters, residuals, jacobians))
    return false;
  for (int i = 0; i < 4; ++i)
  {
    const double by_knot = undistorted_->sigmasByDistortion() * shares_[i];
    residuals[0] += by_knot * parameters[FIRST_KNOT + i][0];
    if (jacobians != nullptr && jacobians[FIRST_KNOT + i] != nullptr)
      Eigen::Map<Eigen::Vector2d>{ jacobians[FIRST_KNOT + i] } << by_knot, 0;
  }
  return true;
}

}  // namespace object_modelling::bundle_adjustment
