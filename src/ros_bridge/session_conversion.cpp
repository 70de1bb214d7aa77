#include "object_modelling/ros_bridge/session_conversion.h"

#include "object_modelling/ros_bridge/noise_model_conversion.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "object_modelling/ros_bridge/time_conversion.h"

namespace object_modelling::ros_bridge
{
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
  if (message.has_support_plane)
    session.support_plane_session = fromMessage(message.support_plane);
  if (message.has_model_from_session)
    session.T_model_session = fromMessage(message.model_from_session);
  if (message.has_calibration)
    session.calibration = fromMessage(message.calibration);
  session.refinement_report = message.refinement_report;
  return session;
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
