#include <cmath>
#include <set>
#include <utility>

#include "object_modelling/base/options.h"
#include "object_modelling/keyframes/session_store.h"
#include "object_modelling/rgbd/corrected.h"
#include "session_file.h"
#include "sql_connection.h"
#include "store_rows.h"
#include "store_schema.h"

namespace object_modelling::keyframes
{
namespace
{
using base::Error;
using base::StatusCode;

const std::string POSTGRESQL_SCHEME = "postgresql://";

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
  if (!session.object_id.empty() && !isValidId(session.object_id))
    throw Error(StatusCode::INVALID_ARGUMENT, sessionText(session.id) + ": '" + session.object_id.substr(0, 80) +
                                                  "' is no object id: 1 to 64 of A-Z a-z 0-9 _ . - are, not starting "
                                                  "with '.' or '-'");
  if (!std::isfinite(session.started_s))
    throw Error(StatusCode::INVALID_ARGUMENT, sessionText(session.id) + ": started_s is not a finite time");
  base::checked(session.calibration.noise_model);
  if (!session.calibration.color_offset_px.allFinite())
    throw Error(StatusCode::INVALID_ARGUMENT, sessionText(session.id) + ": the colour offset is not finite");
  if (session.refinement_report.find('\0') != std::string::npos)
    throw Error(StatusCode::INVALID_ARGUMENT, sessionText(session.id) + ": refinement_report holds a zero byte");
  if (session.camera_frame_id.find('\0') != std::string::npos)
    throw Error(StatusCode::INVALID_ARGUMENT, sessionText(session.id) + ": camera_frame_id holds a zero byte");
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

/// An update that names a keyframe twice says two things; which one is meant is not ours to guess.
template <typename Update>
void checkDistinct(const std::string& session_id, const std::vector<Update>& updates)
{
  std::set<int> ids;
  for (const Update& update : updates)
    if (!ids.insert(update.keyframe_id).second)
      throw Error(StatusCode::INVALID_ARGUMENT,
                  sessionText(session_id) + ": keyframe " + std::to_string(update.keyframe_id) + " is given twice");
}

class SqlStore : public SessionStore
{
public:
  explicit SqlStore(std::unique_ptr<SqlDialect> dialect) : connection_(std::move(dialect))
  {
    migrate(connection_, storeMigrations());
  }

  void createSession(const Session& session) override
  {
    checkSession(session);
    connection_.write(sessionText(session.id), [&](soci::session& sql) { insertSession(sql, session); });
  }

  std::vector<Session> listSessions() override
  {
    std::vector<Session> sessions;
    connection_.read("listing sessions", [&](soci::session& sql) { sessions = selectSessions(sql); });
    return sessions;
  }

  Session session(const std::string& session_id) override
  {
    checkSessionId(session_id);
    Session session;
    connection_.read(sessionText(session_id), [&](soci::session& sql) { session = selectSession(sql, session_id); });
    return session;
  }

  void updateSession(const Session& session) override
  {
    checkSession(session);
    connection_.write(sessionText(session.id), [&](soci::session& sql) { updateSessionRow(sql, session); });
  }

  void deleteSession(const std::string& session_id) override
  {
    checkSessionId(session_id);
    connection_.write(sessionText(session_id), [&](soci::session& sql) { deleteSessionRows(sql, session_id); });
  }

  void addKeyframe(const std::string& session_id, const rgbd::Keyframe& keyframe) override
  {
    checkSessionId(session_id);
    const KeyframeRow row = encodeKeyframe(keyframe);  // outside the transaction: nobody waits for the compression
    connection_.write(sessionText(session_id),
                      [&](soci::session& sql) { insertKeyframe(sql, connection_.dialect(), session_id, row); });
  }

  std::vector<int> keyframeIds(const std::string& session_id) override
  {
    checkSessionId(session_id);
    std::vector<int> ids;
    connection_.read(sessionText(session_id), [&](soci::session& sql) { ids = selectKeyframeIds(sql, session_id); });
    return ids;
  }

  rgbd::Keyframe keyframe(const std::string& session_id, int keyframe_id) override
  {
    checkSessionId(session_id);
    KeyframeRow row;
    Session session;
    connection_.read(sessionText(session_id),
                     [&](soci::session& sql)
                     {
                       row = selectKeyframe(sql, connection_.dialect(), session_id, keyframe_id);
                       session = selectSession(sql, session_id);
                     });
    rgbd::Keyframe keyframe =
        decodeKeyframe(row, "keyframe " + std::to_string(keyframe_id) + " of " + sessionText(session_id));
    keyframe.frame.noise_model = session.calibration.noise_model;
    if (!session.calibration.correction.isIdentity())
      keyframe = rgbd::corrected(keyframe, session.calibration.correction);
    return keyframe;
  }

  void updatePoses(const std::string& session_id, const std::vector<PoseUpdate>& updates) override
  {
    checkSessionId(session_id);
    checkDistinct(session_id, updates);
    for (const PoseUpdate& update : updates)
      if (!update.T_session_camera.matrix().allFinite())
        throw Error(StatusCode::INVALID_ARGUMENT, sessionText(session_id) + ": the new pose of keyframe " +
                                                      std::to_string(update.keyframe_id) +
                                                      " holds numbers that are not finite");
    connection_.write(sessionText(session_id),
                      [&](soci::session& sql)
                      {
                        selectSession(sql, session_id);
                        for (const PoseUpdate& update : updates)
                          updatePose(sql, session_id, update);
                      });
  }

  void updateMasks(const std::string& session_id, const std::vector<MaskUpdate>& updates) override
  {
    checkSessionId(session_id);
    checkDistinct(session_id, updates);
    connection_.write(sessionText(session_id),
                      [&](soci::session& sql)
                      {
                        selectSession(sql, session_id);
                        for (const MaskUpdate& update : updates)
                          updateMask(sql, connection_.dialect(), session_id, update);
                      });
  }

  std::vector<AlignmentRecord> alignments() override
  {
    std::vector<AlignmentRecord> records;
    connection_.read("listing alignments", [&](soci::session& sql) { records = selectAlignments(sql); });
    return records;
  }

  void updateAlignments(const std::vector<AlignmentRecord>& records) override
  {
    for (const AlignmentRecord& record : records)
      checkAlignment(record);
    connection_.write("updating alignments",
                      [&](soci::session& sql)
                      {
                        for (const AlignmentRecord& record : records)
                          replaceAlignment(sql, record);
                      });
  }

  void exportSession(const std::string& session_id, const std::string& path) override
  {
    checkSessionId(session_id);
    writeSessionFile(connection_, session_id, path);
  }

  std::string importSession(const std::string& path) override { return readSessionFile(connection_, path); }

private:
  SqlConnection connection_;
};
}  // namespace

std::unique_ptr<SessionStore> openSqlStore(const std::string& connection)
{
  const bool postgresql = connection.compare(0, POSTGRESQL_SCHEME.size(), POSTGRESQL_SCHEME) == 0;
  return std::make_unique<SqlStore>(postgresql ? makePostgresqlDialect(connection)
                                               : makeSqliteDialect(connection, JournalMode::WAL));
}

}  // namespace object_modelling::keyframes
