#include "motion_model.h"

#include <algorithm>

#include "object_modelling/geometry/transform.h"

namespace object_modelling::tracking
{
namespace
{
constexpr double MAX_EXTRAPOLATION_S = 0.2;  // further ahead than that and than one frame a hand has changed its mind
}  // namespace

void MotionModel::add(double stamp_s, const Eigen::Isometry3d& T_session_camera, bool continuous)
{
  velocity_m_per_s_.setZero();
  angular_velocity_rad_per_s_.setZero();
  if (continuous && T_session_camera_ && stamp_s > stamp_s_)
  {
    const geometry::Vector6d motion = geometry::vectorFromIsometry(T_session_camera_->inverse() * T_session_camera);
    velocity_m_per_s_ = motion.head<3>() / (stamp_s - stamp_s_);
    angular_velocity_rad_per_s_ = motion.tail<3>() / (stamp_s - stamp_s_);
  }
  interval_s_ = continuous ? stamp_s - stamp_s_ : 0;
  stamp_s_ = stamp_s;
  T_session_camera_ = T_session_camera;
}

std::optional<Eigen::Isometry3d> MotionModel::predict(double stamp_s) const
{
  if (!T_session_camera_)
    return std::nullopt;
  const double ahead_s = std::min(stamp_s - stamp_s_, std::max(interval_s_, MAX_EXTRAPOLATION_S));
  return *T_session_camera_ * motion(ahead_s);
}

Eigen::Isometry3d MotionModel::motion(double duration_s) const
{
  geometry::Vector6d motion;
  motion << velocity_m_per_s_ * duration_s, angular_velocity_rad_per_s_ * duration_s;
  return geometry::isometryFromVector(motion);
}

}  // namespace object_modelling::tracking
