#include <soci/soci.h>

#include "number_text.h"
#include "object_modelling/base/status.h"
#include "object_modelling/rgbd/noise_model_file.h"
#include "store_rows.h"

namespace object_modelling::keyframes
{
namespace
{
using base::Error;
using base::StatusCode;

const char* const SESSION_COLUMNS =
    "SELECT session_id, object_id, camera_frame_id, started_s, reference_is_object, closed, "
    "support_plane_session, model_from_session, calibration, refinement_report, refined_by, refined_options, "
    "segmented_by, segmented_options, (SELECT COUNT(*) FROM keyframes WHERE keyframes.session_id = "
    "sessions.session_id) FROM sessions ";

/// The columns as they travel to and from SQL; empty optional columns are NULL.
struct SessionRow
{
  std::string id, object_id, camera_frame_id, support_plane, model_from_session, calibration, refinement_report;
  StageMark refined, segmented;
  double started_s = 0;
  int reference_is_object = 0, closed = 0, keyframe_count = 0;
  soci::indicator has_support_plane = soci::i_null, has_model_from_session = soci::i_null,
                  has_calibration = soci::i_null;
};

SessionRow rowFrom(const Session& session)
{
  SessionRow row;
  row.id = session.id;
  row.object_id = session.object_id;
  row.camera_frame_id = session.camera_frame_id;
  row.started_s = session.started_s;
  row.reference_is_object = session.reference_is_object ? 1 : 0;
  row.closed = session.closed ? 1 : 0;
  if (session.support_plane_session)
  {
    const geometry::Plane& plane = *session.support_plane_session;
    const double values[] = { plane.normal.x(), plane.normal.y(), plane.normal.z(), plane.offset_m };
    row.support_plane = textFromNumbers(values, 4);
    row.has_support_plane = soci::i_ok;
  }
  if (session.T_model_session)
  {
    row.model_from_session = textFromTransform(*session.T_model_session);
    row.has_model_from_session = soci::i_ok;
  }
  if (!(session.calibration == rgbd::SensorCalibration()))
  {
    row.calibration = rgbd::calibrationText(session.calibration);
    row.has_calibration = soci::i_ok;
  }
  row.refinement_report = session.refinement_report;
  row.refined = session.refined;
  row.segmented = session.segmented;
  return row;
}

Session sessionFrom(const SessionRow& row)
{
  Session session;
  session.id = row.id;
  session.object_id = row.object_id;
  session.camera_frame_id = row.camera_frame_id;
  session.started_s = row.started_s;
  session.reference_is_object = row.reference_is_object != 0;
  session.closed = row.closed != 0;
  session.keyframe_count = row.keyframe_count;
  if (row.has_support_plane == soci::i_ok)
  {
    const std::vector<double> values =
        numbersFromText(row.support_plane, 4, "support_plane_session of session '" + row.id + "'");
    session.support_plane_session = geometry::Plane{ { values[0], values[1], values[2] }, values[3] };
  }
  if (row.has_model_from_session == soci::i_ok)
    session.T_model_session =
        transformFromText(row.model_from_session, "model_from_session of session '" + row.id + "'");
  if (row.has_calibration == soci::i_ok)
    session.calibration = rgbd::calibrationFromText(row.calibration, "calibration of session '" + row.id + "'");
  session.refinement_report = row.refinement_report;
  session.refined = row.refined;
  session.segmented = row.segmented;
  return session;
}

/// A change's values of the optional columns.
Session sessionWith(const SessionChange& change)
{
  Session session;
  session.support_plane_session = change.support_plane_session.value_or(std::nullopt);
  session.T_model_session = change.T_model_session.value_or(std::nullopt);
  session.calibration = change.calibration.value_or(rgbd::SensorCalibration());
  return session;
}

/// All sessions that the statement's condition chooses, in its order.
std::vector<Session> fetchSessions(soci::session& sql, const std::string& condition, const std::string* session_id)
{
  SessionRow row;
  soci::statement statement(sql);
  statement.exchange(soci::into(row.id));
  statement.exchange(soci::into(row.object_id));
  statement.exchange(soci::into(row.camera_frame_id));
  statement.exchange(soci::into(row.started_s));
  statement.exchange(soci::into(row.reference_is_object));
  statement.exchange(soci::into(row.closed));
  statement.exchange(soci::into(row.support_plane, row.has_support_plane));
  statement.exchange(soci::into(row.model_from_session, row.has_model_from_session));
  statement.exchange(soci::into(row.calibration, row.has_calibration));
  statement.exchange(soci::into(row.refinement_report));
  statement.exchange(soci::into(row.refined.by));
  statement.exchange(soci::into(row.refined.options));
  statement.exchange(soci::into(row.segmented.by));
  statement.exchange(soci::into(row.segmented.options));
  statement.exchange(soci::into(row.keyframe_count));
  if (session_id != nullptr)
    statement.exchange(soci::use(*session_id, "session_id"));
  statement.alloc();
  statement.prepare(SESSION_COLUMNS + condition);
  statement.define_and_bind();
  std::vector<Session> sessions;
  for (bool more = statement.execute(true); more; more = statement.fetch())
    sessions.push_back(sessionFrom(row));
  return sessions;
}
}  // namespace

void insertSession(soci::session& sql, const Session& session)
{
  int existing = 0;
  sql << "SELECT COUNT(*) FROM sessions WHERE session_id = :session_id", soci::into(existing), soci::use(session.id);
  if (existing > 0)
    throw Error(StatusCode::FAILED_PRECONDITION,
                "session '" + session.id + "' exists already; choose another id or delete that session first");
  SessionRow row = rowFrom(session);
  sql << "INSERT INTO sessions (session_id, object_id, camera_frame_id, started_s, reference_is_object, closed, "
         "support_plane_session, model_from_session, calibration, refinement_report, refined_by, refined_options, "
         "segmented_by, segmented_options) VALUES (:session_id, :object_id, :camera_frame_id, :started_s, "
         ":reference_is_object, :closed, :support_plane, :model_from_session, :calibration, :refinement_report, "
         ":refined_by, :refined_options, :segmented_by, :segmented_options)",
      soci::use(row.id), soci::use(row.object_id), soci::use(row.camera_frame_id), soci::use(row.started_s),
      soci::use(row.reference_is_object), soci::use(row.closed), soci::use(row.support_plane, row.has_support_plane),
      soci::use(row.model_from_session, row.has_model_from_session), soci::use(row.calibration, row.has_calibration),
      soci::use(row.refinement_report), soci::use(row.refined.by), soci::use(row.refined.options),
      soci::use(row.segmented.by), soci::use(row.segmented.options);
}

std::vector<Session> selectSessions(soci::session& sql)
{
  return fetchSessions(sql, "ORDER BY started_s, session_id", nullptr);
}

Session selectSession(soci::session& sql, const std::string& session_id)
{
  const std::vector<Session> sessions = fetchSessions(sql, "WHERE session_id = :session_id", &session_id);
  if (sessions.empty())
    throw Error(StatusCode::NOT_FOUND, "session '" + session_id +
                                           "' is not in the store; list the sessions to see "
                                           "which are");
  return sessions.front();
}

void updateSessionRow(soci::session& sql, const std::string& session_id, const SessionChange& change)
{
  selectSession(sql, session_id);
  // A column each: what another process wrote meanwhile to the others stays.
  const auto set = [&](const std::string& column, const auto& value, soci::indicator& has)
  {
    sql << "UPDATE sessions SET " << column << " = :value WHERE session_id = :session_id", soci::use(value, has),
        soci::use(session_id);
  };
  soci::indicator there = soci::i_ok;
  if (change.object_id)
    set("object_id", *change.object_id, there);
  if (change.reference_is_object)
    set("reference_is_object", static_cast<int>(*change.reference_is_object), there);
  if (change.closed)
    set("closed", static_cast<int>(*change.closed), there);
  SessionRow row = rowFrom(sessionWith(change));
  if (change.support_plane_session)
    set("support_plane_session", row.support_plane, row.has_support_plane);
  if (change.T_model_session)
    set("model_from_session", row.model_from_session, row.has_model_from_session);
  if (change.calibration)
    set("calibration", row.calibration, row.has_calibration);
  if (change.refinement_report)
    set("refinement_report", *change.refinement_report, there);
  if (change.refined)
  {
    set("refined_by", change.refined->by, there);
    set("refined_options", change.refined->options, there);
  }
  if (change.segmented)
  {
    set("segmented_by", change.segmented->by, there);
    set("segmented_options", change.segmented->options, there);
  }
}

void deleteSessionRows(soci::session& sql, const std::string& session_id)
{
  selectSession(sql, session_id);
  sql << "DELETE FROM sessions WHERE session_id = :session_id", soci::use(session_id);
}

}  // namespace object_modelling::keyframes
