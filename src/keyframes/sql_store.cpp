#include "sql_store.h"

#include <utility>

#include "session_file.h"
#include "sql_connection.h"
#include "store_checks.h"
#include "store_rows.h"
#include "store_schema.h"

namespace object_modelling::keyframes
{
namespace
{
const std::string POSTGRESQL_SCHEME = "postgresql://";

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

  void update(const std::string& session_id, const SessionChange& change) override
  {
    checkSessionId(session_id);
    checkChange(session_id, change);
    connection_.write(sessionText(session_id),
                      [&](soci::session& sql)
                      {
                        updateSessionRow(sql, session_id, change);
                        for (const PoseUpdate& pose : change.poses)
                          updatePose(sql, session_id, pose);
                        for (const MaskUpdate& mask : change.masks)
                          updateMask(sql, connection_.dialect(), session_id, mask);
                      });
  }

  void deleteSession(const std::string& session_id) override
  {
    checkSessionId(session_id);
    connection_.write(sessionText(session_id), [&](soci::session& sql) { deleteSessionRows(sql, session_id); });
  }

  void addKeyframe(const std::string& session_id, const rgbd::Keyframe& keyframe) override
  {
    checkSessionId(session_id);
    const EncodedKeyframe row = encodeKeyframe(keyframe);  // outside the transaction: it must not wait for compression
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

  EncodedKeyframe encodedKeyframe(const std::string& session_id, int keyframe_id) override
  {
    checkSessionId(session_id);
    EncodedKeyframe row;
    connection_.read(sessionText(session_id),
                     [&](soci::session& sql)
                     {
                       row = selectKeyframe(sql, connection_.dialect(), session_id, keyframe_id);
                       row.calibration = selectSession(sql, session_id).calibration;
                     });
    return row;
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

std::unique_ptr<SessionStore> makeSqlStore(std::unique_ptr<SqlDialect> dialect)
{
  return std::make_unique<SqlStore>(std::move(dialect));
}

std::unique_ptr<SessionStore> openSqlStore(const std::string& connection)
{
  const bool postgresql = connection.compare(0, POSTGRESQL_SCHEME.size(), POSTGRESQL_SCHEME) == 0;
  return makeSqlStore(postgresql ? makePostgresqlDialect(connection) : makeSqliteDialect(connection, JournalMode::WAL));
}

}  // namespace object_modelling::keyframes
