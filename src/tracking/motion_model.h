#pragma once

#include <optional>

#include <Eigen/Geometry>

namespace object_modelling::tracking
{
/// Constant velocity of the camera, from the last two tracked frames.
class MotionModel
{
public:
  void clear() { *this = {}; }
  /// A tracked frame; `continuous` is false after a loss, when no velocity follows from the frame before.
  void add(double stamp_s, const Eigen::Isometry3d& T_session_camera, bool continuous);
  std::optional<Eigen::Isometry3d> predict(double stamp_s) const;
  /// T_now_later: the camera's own motion within a short time, at the velocity it had.
  Eigen::Isometry3d motion(double duration_s) const;
  const std::optional<Eigen::Isometry3d>& last() const { return T_session_camera_; }
  double speed_m_per_s() const { return velocity_m_per_s_.norm(); }
  double angularSpeed_rad_per_s() const { return angular_velocity_rad_per_s_.norm(); }

private:
  double stamp_s_ = 0;
  double interval_s_ = 0;  // between the last two frames
  std::optional<Eigen::Isometry3d> T_session_camera_;
  Eigen::Vector3d velocity_m_per_s_ = Eigen::Vector3d::Zero();  // in the camera frame
  Eigen::Vector3d angular_velocity_rad_per_s_ = Eigen::Vector3d::Zero();
};

}  // namespace object_modelling::tracking
