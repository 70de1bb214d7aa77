#include "object_modelling/ros_bridge/session_conversion.h"

#include "object_modelling/ros_bridge/keyframe_conversion.h"
#include "object_modelling/ros_bridge/noise_model_conversion.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "object_modelling/ros_bridge/time_conversion.h"

namespace object_modelling::ros_bridge
{
namespace
{
object_modelling::StageMark toMessage(const keyframes::StageMark& mark)
{
  object_modelling::StageMark message;
  message.by = mark.by;
  message.options = mark.options;
  return message;
}

keyframes::StageMark fromMessage(const object_modelling::StageMark& message)
{
  return { message.by, message.options };
}

using Rows3x4 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
using Rows6x6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

object_modelling::KeyframePose toKeyframePose(const keyframes::PoseUpdate& update)
{
  object_modelling::KeyframePose message;
  message.keyframe_id = update.keyframe_id;
  Eigen::Map<Rows3x4>(message.session_from_camera.data()) = update.T_session_camera.matrix().topRows<3>();
  Eigen::Map<Rows6x6>(message.covariance.data()) = update.covariance;
  return message;
}

keyframes::PoseUpdate fromKeyframePose(const object_modelling::KeyframePose& message)
{
  keyframes::PoseUpdate update;
  update.keyframe_id = message.keyframe_id;
  update.T_session_camera.matrix().topRows<3>() = Eigen::Map<const Rows3x4>(message.session_from_camera.data());
  update.covariance = Eigen::Map<const Rows6x6>(message.covariance.data());
  constexpr double MAX_SHEAR = 1e-6;
  const Eigen::Matrix3d R = update.T_session_camera.linear();
  if (!update.T_session_camera.matrix().allFinite() || !(R * R.transpose()).isIdentity(MAX_SHEAR) ||
      R.determinant() < 0)
    throw base::Error(
        base::StatusCode::INVALID_ARGUMENT,
        "the new pose of keyframe " + std::to_string(message.keyframe_id) + " is no rotation and translation");
  return update;
}

std::optional<geometry::Plane> supportPlaneFrom(const object_modelling::Session& message)
{
  if (!message.has_support_plane)
    return std::nullopt;
  return ros_bridge::fromMessage(message.support_plane);
}

std::optional<Eigen::Isometry3d> modelPoseFrom(const object_modelling::Session& message)
{
  if (!message.has_model_from_session)
    return std::nullopt;
  return ros_bridge::fromMessage(message.model_from_session);
}

rgbd::SensorCalibration calibrationFrom(const object_modelling::Session& message)
{
  return message.has_calibration ? ros_bridge::fromMessage(message.calibration) : rgbd::SensorCalibration();
}
}  // namespace

object_modelling::Session toMessage(const keyframes::Session& session)
{
  object_modelling::Session message;
  message.session_id = session.id;
  message.object_id = session.object_id;
  message.camera_frame_id = session.camera_frame_id;
  message.started = toTime(session.started_s);
  message.keyframe_count = session.keyframe_count;
  message.reference_is_object = session.reference_is_object;
  message.closed = session.closed;
  message.has_support_plane = session.support_plane_session.has_value();
  message.support_plane = toMessage(session.support_plane_session.value_or(geometry::Plane()));
  message.has_model_from_session = session.T_model_session.has_value();
  message.model_from_session = toPoseMessage(session.T_model_session.value_or(Eigen::Isometry3d::Identity()));
  message.has_calibration = true;
  message.calibration = toMessage(session.calibration);
  message.refinement_report = session.refinement_report;
  message.refined = toMessage(session.refined);
  message.segmented = toMessage(session.segmented);
  return message;
}

keyframes::Session fromMessage(const object_modelling::Session& message)
{
  keyframes::Session session;
  session.id = message.session_id;
  session.object_id = message.object_id;
  session.camera_frame_id = message.camera_frame_id;
  session.started_s = toSeconds(message.started);
  session.keyframe_count = message.keyframe_count;
  session.reference_is_object = message.reference_is_object;
  session.closed = message.closed;
  session.support_plane_session = supportPlaneFrom(message);
  session.T_model_session = modelPoseFrom(message);
  session.calibration = calibrationFrom(message);
  session.refinement_report = message.refinement_report;
  session.refined = fromMessage(message.refined);
  session.segmented = fromMessage(message.segmented);
  return session;
}

object_modelling::SessionChange toMessage(const keyframes::SessionChange& change)
{
  object_modelling::SessionChange message;
  for (const keyframes::PoseUpdate& update : change.poses)
    message.poses.push_back(toKeyframePose(update));
  for (const keyframes::MaskUpdate& update : change.masks)
    message.masks.push_back(toMessage(update, std::string()));
  message.set_object_id = change.object_id.has_value();
  message.set_reference_is_object = change.reference_is_object.has_value();
  message.set_closed = change.closed.has_value();
  message.set_support_plane = change.support_plane_session.has_value();
  message.set_model_from_session = change.T_model_session.has_value();
  message.set_calibration = change.calibration.has_value();
  message.set_refinement_report = change.refinement_report.has_value();
  message.set_refined = change.refined.has_value();
  message.set_segmented = change.segmented.has_value();
  keyframes::Session values;
  values.object_id = change.object_id.value_or("");
  values.reference_is_object = change.reference_is_object.value_or(false);
  values.closed = change.closed.value_or(false);
  values.support_plane_session = change.support_plane_session.value_or(std::nullopt);
  values.T_model_session = change.T_model_session.value_or(std::nullopt);
  values.calibration = change.calibration.value_or(rgbd::SensorCalibration());
  values.refinement_report = change.refinement_report.value_or("");
  values.refined = change.refined.value_or(keyframes::StageMark());
  values.segmented = change.segmented.value_or(keyframes::StageMark());
  message.session = toMessage(values);
  return message;
}

keyframes::SessionChange fromMessage(const object_modelling::SessionChange& message)
{
  const object_modelling::Session& values = message.session;
  keyframes::SessionChange change;
  for (const object_modelling::KeyframePose& pose : message.poses)
    change.poses.push_back(fromKeyframePose(pose));
  for (const object_modelling::ObjectMask& update : message.masks)
    change.masks.push_back(fromMessage(update));
  if (message.set_object_id)
    change.object_id = values.object_id;
  if (message.set_reference_is_object)
    change.reference_is_object = values.reference_is_object;
  if (message.set_closed)
    change.closed = values.closed;
  if (message.set_support_plane)
    change.support_plane_session = supportPlaneFrom(values);
  if (message.set_model_from_session)
    change.T_model_session = modelPoseFrom(values);
  if (message.set_calibration)
    change.calibration = calibrationFrom(values);
  if (message.set_refinement_report)
    change.refinement_report = values.refinement_report;
  if (message.set_refined)
    change.refined = fromMessage(values.refined);
  if (message.set_segmented)
    change.segmented = fromMessage(values.segmented);
  return change;
}

object_modelling::AlignmentRecord toMessage(const keyframes::AlignmentRecord& record)
{
  object_modelling::AlignmentRecord message;
  message.session_a = record.session_a;
  message.session_b = record.session_b;
  message.findings = record.findings;
  return message;
}

keyframes::AlignmentRecord fromMessage(const object_modelling::AlignmentRecord& message)
{
  return { message.session_a, message.session_b, message.findings };
}

}  // namespace object_modelling::ros_bridge
