#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseWithCovariance.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>
#include <object_modelling/Plane.h>
#include <object_modelling/PoseUpdate.h>
#include <Eigen/Geometry>

#include "object_modelling/geometry/plane.h"
#include "object_modelling/geometry/transform.h"
#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::ros_bridge
{
geometry_msgs::Pose toPoseMessage(const Eigen::Isometry3d& T_target_source);
geometry_msgs::Transform toTransformMessage(const Eigen::Isometry3d& T_target_source);
geometry_msgs::Vector3 toVectorMessage(const Eigen::Vector3d& vector);
/// `covariance` as geometry::Matrix6d has it; in the message it is that of the position and of rotations about the
/// target's axes, through the source's origin, as ROS defines it.
geometry_msgs::PoseWithCovariance toMessage(const Eigen::Isometry3d& T_target_source,
                                            const geometry::Matrix6d& covariance);

/// Throw base::Error (INVALID_ARGUMENT) for a quaternion that is not of unit length (to 1e-3) and for NaN.
Eigen::Isometry3d fromMessage(const geometry_msgs::Pose& target_from_source);
/// Back to what geometry::Matrix6d means.
geometry::Matrix6d covarianceFromMessage(const geometry_msgs::PoseWithCovariance& pose);

object_modelling::Plane toMessage(const geometry::Plane& plane);
/// Throws base::Error (INVALID_ARGUMENT) for a normal that is not of unit length (to 1e-3).
geometry::Plane fromMessage(const object_modelling::Plane& plane);

object_modelling::PoseUpdate toMessage(const keyframes::PoseUpdate& update);
keyframes::PoseUpdate fromMessage(const object_modelling::PoseUpdate& update);

}  // namespace object_modelling::ros_bridge
