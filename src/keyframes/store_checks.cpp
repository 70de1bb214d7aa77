#include "store_checks.h"

#include <cmath>
#include <set>

#include "object_modelling/base/options.h"

namespace object_modelling::keyframes
{
namespace
{
using base::Error;
using base::StatusCode;

void checkObjectId(const std::string& session_id, const std::string& object_id)
{
  if (!object_id.empty() && !isValidId(object_id))
    throw Error(StatusCode::INVALID_ARGUMENT, sessionText(session_id) + ": '" + object_id.substr(0, 80) +
                                                  "' is no object id: 1 to 64 of A-Z a-z 0-9 _ . - are, not starting "
                                                  "with '.' or '-'");
}

void checkCalibration(const std::string& session_id, const rgbd::SensorCalibration& calibration)
{
  base::checked(calibration.noise_model);
  if (!calibration.color_offset_px.allFinite())
    throw Error(StatusCode::INVALID_ARGUMENT, sessionText(session_id) + ": the colour offset is not finite");
}

void checkText(const std::string& session_id, const std::string& name, const std::string& text)
{
  if (text.find('\0') != std::string::npos)
    throw Error(StatusCode::INVALID_ARGUMENT, sessionText(session_id) + ": " + name + " holds a zero byte");
}

void checkMark(const std::string& session_id, const std::string& name, const StageMark& mark)
{
  checkText(session_id, name, mark.by);
  checkText(session_id, name, mark.options);
}

/// Refuses an update that names a keyframe twice, since its values may differ.
template <typename Update>
void checkDistinct(const std::string& session_id, const std::vector<Update>& updates)
{
  std::set<int> ids;
  for (const Update& update : updates)
    if (!ids.insert(update.keyframe_id).second)
      throw Error(StatusCode::INVALID_ARGUMENT,
                  sessionText(session_id) + ": keyframe " + std::to_string(update.keyframe_id) + " is given twice");
}
}  // namespace

std::string sessionText(const std::string& id)
{
  return "session '" + id + "'";
}

void checkSessionId(const std::string& id)
{
  if (!isValidId(id))
    throw Error(StatusCode::INVALID_ARGUMENT, "'" + id.substr(0, 80) +
                                                  "' is no session id: 1 to 64 of A-Z a-z 0-9 _ . - are, not starting "
                                                  "with '.' or '-'");
}

void checkSession(const Session& session)
{
  checkSessionId(session.id);
  checkObjectId(session.id, session.object_id);
  if (!std::isfinite(session.started_s))
    throw Error(StatusCode::INVALID_ARGUMENT, sessionText(session.id) + ": started_s is not a finite time");
  checkCalibration(session.id, session.calibration);
  checkText(session.id, "refinement_report", session.refinement_report);
  checkText(session.id, "camera_frame_id", session.camera_frame_id);
  checkMark(session.id, "refined", session.refined);
  checkMark(session.id, "segmented", session.segmented);
}

void checkChange(const std::string& session_id, const SessionChange& change)
{
  checkDistinct(session_id, change.poses);
  checkDistinct(session_id, change.masks);
  for (const PoseUpdate& pose : change.poses)
    if (!pose.T_session_camera.matrix().allFinite())
      throw Error(StatusCode::INVALID_ARGUMENT, sessionText(session_id) + ": the new pose of keyframe " +
                                                    std::to_string(pose.keyframe_id) +
                                                    " holds numbers that are not finite");
  checkObjectId(session_id, change.object_id.value_or(""));
  if (change.calibration)
    checkCalibration(session_id, *change.calibration);
  checkText(session_id, "refinement_report", change.refinement_report.value_or(""));
  checkMark(session_id, "refined", change.refined.value_or(StageMark()));
  checkMark(session_id, "segmented", change.segmented.value_or(StageMark()));
}

void checkAlignment(const AlignmentRecord& record)
{
  checkSessionId(record.session_a);
  checkSessionId(record.session_b);
  const std::string pair = "alignment of " + sessionText(record.session_a) + " and " + sessionText(record.session_b);
  if (record.session_a == record.session_b)
    throw Error(StatusCode::INVALID_ARGUMENT, pair + ": a session is not aligned with itself; name two");
  if (record.findings.find('\0') != std::string::npos)
    throw Error(StatusCode::INVALID_ARGUMENT, pair + ": its findings hold a zero byte");
}

}  // namespace object_modelling::keyframes
