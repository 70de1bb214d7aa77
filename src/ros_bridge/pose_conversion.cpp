#include "object_modelling/ros_bridge/pose_conversion.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "object_modelling/base/status.h"

namespace object_modelling::ros_bridge
{
namespace
{
constexpr double UNIT_LENGTH_TOLERANCE = 1e-3;

/// A small motion (t, r) on the left of T moves the source's origin p by t + r x p; ROS uses that displacement and
/// r, this package t and r. With `sign` +1 the Jacobian from ours to that of ROS, with -1 the way back.
geometry::Matrix6d displacementOf(const Eigen::Vector3d& p_target, double sign)
{
  geometry::Matrix6d jacobian = geometry::Matrix6d::Identity();
  jacobian.topRightCorner<3, 3>() << 0, p_target.z(), -p_target.y(), -p_target.z(), 0, p_target.x(), p_target.y(),
      -p_target.x(), 0;
  jacobian.topRightCorner<3, 3>() *= sign;
  return jacobian;
}

geometry::Matrix6d propagated(const geometry::Matrix6d& covariance, const geometry::Matrix6d& jacobian)
{
  const geometry::Matrix6d result = jacobian * covariance * jacobian.transpose();
  return (result + result.transpose()) / 2;
}

void requireUnit(double length, const std::string& what)
{
  if (std::abs(length - 1) <= UNIT_LENGTH_TOLERANCE)
    return;
  std::ostringstream text;
  text << what << " has length " << length << ", expected 1";
  throw base::Error(base::StatusCode::INVALID_ARGUMENT, text.str());
}
}  // namespace

geometry_msgs::Pose toPoseMessage(const Eigen::Isometry3d& T_target_source)
{
  const Eigen::Quaterniond R(T_target_source.rotation());
  geometry_msgs::Pose message;
  message.position.x = T_target_source.translation().x();
  message.position.y = T_target_source.translation().y();
  message.position.z = T_target_source.translation().z();
  message.orientation.x = R.x();
  message.orientation.y = R.y();
  message.orientation.z = R.z();
  message.orientation.w = R.w();
  return message;
}

geometry_msgs::Vector3 toVectorMessage(const Eigen::Vector3d& vector)
{
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

geometry_msgs::Transform toTransformMessage(const Eigen::Isometry3d& T_target_source)
{
  const geometry_msgs::Pose pose = toPoseMessage(T_target_source);
  geometry_msgs::Transform message;
  message.translation = toVectorMessage(T_target_source.translation());
  message.rotation = pose.orientation;
  return message;
}

geometry_msgs::PoseWithCovariance toMessage(const Eigen::Isometry3d& T_target_source,
                                            const geometry::Matrix6d& covariance)
{
  geometry_msgs::PoseWithCovariance message;
  message.pose = toPoseMessage(T_target_source);
  const geometry::Matrix6d covariance_ros = propagated(covariance, displacementOf(T_target_source.translation(), 1));
  // Symmetric, so that Eigen's column order is the message's row order.
  std::copy_n(covariance_ros.data(), message.covariance.size(), message.covariance.begin());
  return message;
}

Eigen::Isometry3d fromMessage(const geometry_msgs::Pose& target_from_source)
{
  const auto& q = target_from_source.orientation;
  const auto& p = target_from_source.position;
  const Eigen::Quaterniond R(q.w, q.x, q.y, q.z);
  requireUnit(R.norm(), "orientation of a pose");
  const Eigen::Vector3d t(p.x, p.y, p.z);
  if (!t.allFinite())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "position of a pose is not finite");
  return geometry::isometryFrom(R.normalized(), t);
}

geometry::Matrix6d covarianceFromMessage(const geometry_msgs::PoseWithCovariance& pose)
{
  const Eigen::Map<const geometry::Matrix6d> covariance(pose.covariance.data());
  if (!covariance.allFinite())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "covariance of a pose is not finite");
  const Eigen::Vector3d p_target(pose.pose.position.x, pose.pose.position.y, pose.pose.position.z);
  return propagated(covariance, displacementOf(p_target, -1));
}

object_modelling::Plane toMessage(const geometry::Plane& plane)
{
  object_modelling::Plane message;
  message.normal.x = plane.normal.x();
  message.normal.y = plane.normal.y();
  message.normal.z = plane.normal.z();
  message.offset_m = plane.offset_m;
  return message;
}

geometry::Plane fromMessage(const object_modelling::Plane& plane)
{
  const Eigen::Vector3d normal(plane.normal.x, plane.normal.y, plane.normal.z);
  requireUnit(normal.norm(), "normal of a plane");
  if (!std::isfinite(plane.offset_m))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "offset of a plane is not finite");
  geometry::Plane result;
  result.normal = normal;
  result.offset_m = plane.offset_m;
  return result;
}

object_modelling::PoseUpdate toMessage(const keyframes::PoseUpdate& update)
{
  object_modelling::PoseUpdate message;
  message.keyframe_id = update.keyframe_id;
  message.session_from_camera = toMessage(update.T_session_camera, update.covariance);
  return message;
}

keyframes::PoseUpdate fromMessage(const object_modelling::PoseUpdate& update)
{
  return { update.keyframe_id, fromMessage(update.session_from_camera.pose),
           covarianceFromMessage(update.session_from_camera) };
}

}  // namespace object_modelling::ros_bridge
