#include <gtest/gtest.h>

#include <soci/sqlite3/soci-sqlite3.h>
#include <fstream>

#include "../../src/keyframes/store_schema.h"
#include "every_backend.h"

namespace object_modelling::keyframes
{
using base::StatusCode;

class StoreSchema : public OnEveryBackend
{
protected:
  std::unique_ptr<SqlConnection> connect() const { return std::make_unique<SqlConnection>(dialect()); }
  void execute(const std::string& statement) const
  {
    connect()->write("test", [&](soci::session& sql) { sql << statement; });
  }
  int version() const
  {
    int version = -1;
    connect()->read("test",
                    [&](soci::session& sql) { sql << "SELECT version FROM store_schema", soci::into(version); });
    return version;
  }
};
INSTANTIATE_ON_EVERY_BACKEND(StoreSchema);

TEST_P(StoreSchema, MigratesAVersionZeroStore)
{
  execute("CREATE TABLE store_schema (version INTEGER NOT NULL)");
  execute("INSERT INTO store_schema (version) VALUES (0)");
  const std::unique_ptr<SessionStore> store = openSqlStore(connection_);
  store->createSession(makeSession("a"));
  store->addKeyframe("a", makeKeyframe(0));
  EXPECT_EQ(version(), static_cast<int>(storeMigrations().size()));
}

TEST_P(StoreSchema, TakesAStoreOfVersionOneWithItsSessions)
{
  const std::vector<Migration> first(storeMigrations().begin(), storeMigrations().begin() + 1);
  migrate(*connect(), first);
  execute(
      "INSERT INTO sessions (session_id, object_id, camera_frame_id, started_s, reference_is_object, closed) "
      "VALUES ('a', 'cup', 'cam', 12.5, 1, 1)");
  execute(
      "INSERT INTO keyframes (session_id, keyframe_id, stamp_s, width_px, height_px, fx_px, fy_px, cx_px, cy_px, "
      "distortion, session_from_camera, covariance) VALUES ('a', 0, 12.5, 4, 3, 5, 5, 1, 1, '', '', '')");
  ASSERT_EQ(version(), 1);
  const std::unique_ptr<SessionStore> store = openSqlStore(connection_);
  EXPECT_EQ(version(), static_cast<int>(storeMigrations().size()));
  Session session = store->session("a");
  EXPECT_EQ(session.object_id, "cup");
  EXPECT_EQ(session.keyframe_count, 1);
  EXPECT_TRUE(session.closed && session.reference_is_object);
  EXPECT_TRUE(session.calibration == rgbd::SensorCalibration());
  EXPECT_EQ(session.refinement_report, "");
  session.calibration.color_offset_px = { 0.3, -0.1 };
  session.refinement_report = "bundle adjustment";
  store->update(session.id, SessionChange::toAllOf(session));
  EXPECT_TRUE(store->session("a").calibration == session.calibration);
  EXPECT_EQ(store->session("a").refinement_report, "bundle adjustment");
  store->createSession(makeSession("b"));
  store->updateAlignments({ { "a", "b", "found" } });
  EXPECT_EQ(store->alignments().size(), 1u);
}

TEST_P(StoreSchema, KnowsWhatWasDoneBeforeThereWereMarks)
{
  const std::vector<Migration> before(storeMigrations().begin(), storeMigrations().begin() + 3);
  migrate(*connect(), before);
  const auto insert = [&](const std::string& id, const std::string& plane, const std::string& report)
  {
    execute(
        "INSERT INTO sessions (session_id, object_id, camera_frame_id, started_s, reference_is_object, closed, "
        "support_plane_session, refinement_report) VALUES ('" +
        id + "', '', 'cam', 1, 0, 1, " + plane + ", '" + report + "')");
  };
  insert("new", "NULL", "");
  insert("refined", "NULL", "iterations: 3");
  insert("segmented", "'0 0 -1 0.5'", "");
  const std::unique_ptr<SessionStore> store = openSqlStore(connection_);
  EXPECT_EQ(version(), static_cast<int>(storeMigrations().size()));
  EXPECT_EQ(store->session("new").refined, StageMark());
  EXPECT_EQ(store->session("new").segmented, StageMark());
  EXPECT_EQ(store->session("refined").refined, (StageMark{ stage_mark::UNKNOWN, "" }));
  EXPECT_FALSE(store->session("refined").segmented.done());
  EXPECT_EQ(store->session("segmented").segmented, (StageMark{ stage_mark::UNKNOWN, "" }));
  EXPECT_FALSE(store->session("segmented").refined.done());
}

TEST_P(StoreSchema, TakesKeyframesOfWhichNobodyKeptWhatMoved)
{
  const std::vector<Migration> before(storeMigrations().begin(), storeMigrations().begin() + 4);
  migrate(*connect(), before);
  execute(
      "INSERT INTO sessions (session_id, object_id, camera_frame_id, started_s, reference_is_object, closed) "
      "VALUES ('a', '', 'cam', 1, 1, 1)");
  execute(
      "INSERT INTO keyframes (session_id, keyframe_id, stamp_s, width_px, height_px, fx_px, fy_px, cx_px, cy_px, "
      "distortion, session_from_camera, covariance) VALUES ('a', 0, 12.5, 4, 3, 5, 5, 1, 1, '', '', '')");
  execute(
      "INSERT INTO keyframe_images (session_id, keyframe_id, color_png, depth_png, depth_unit_m, observations) "
      "VALUES ('a', 0, 'colour', 'depth', 0.001, 'points')");
  execute("INSERT INTO keyframe_masks (session_id, keyframe_id, mask_png) VALUES ('a', 0, 'object')");
  const std::unique_ptr<SessionStore> store = openSqlStore(connection_);
  EXPECT_EQ(version(), static_cast<int>(storeMigrations().size()));
  const EncodedKeyframe encoded = store->encodedKeyframe("a", 0);
  EXPECT_EQ(encoded.color_png, "colour");
  EXPECT_EQ(encoded.mask_png, "object");
  EXPECT_EQ(encoded.moving_mask_png, "");
  store->addKeyframe("a", makeKeyframe(1));
  expectSame(store->keyframe("a", 1), makeKeyframe(1));
}

TEST_P(StoreSchema, MigrationsKeepTheData)
{
  {
    const std::unique_ptr<SessionStore> store = openSqlStore(connection_);
    store->createSession(makeSession("a"));
    store->addKeyframe("a", makeKeyframe(0));
  }
  std::vector<Migration> migrations = storeMigrations();
  migrations.emplace_back([](soci::session& sql, const SqlDialect&)
                          { sql << "ALTER TABLE sessions ADD COLUMN operator TEXT NOT NULL DEFAULT 'nobody'"; });
  const std::unique_ptr<SqlConnection> connection = connect();
  migrate(*connection, migrations);
  migrate(*connection, migrations);  // a second time there is nothing to do
  EXPECT_EQ(version(), static_cast<int>(migrations.size()));
  std::string name;
  int keyframes = 0;
  connection->read("test",
                   [&](soci::session& sql)
                   {
                     sql << "SELECT operator FROM sessions WHERE session_id = 'a'", soci::into(name);
                     sql << "SELECT COUNT(*) FROM keyframe_images", soci::into(keyframes);
                   });
  EXPECT_EQ(name, "nobody");
  EXPECT_EQ(keyframes, 1);
}

TEST_P(StoreSchema, AFailedMigrationChangesNothing)
{
  openSqlStore(connection_)->createSession(makeSession("a"));
  std::vector<Migration> migrations = storeMigrations();
  migrations.emplace_back([](soci::session& sql, const SqlDialect&) { sql << "DROP TABLE keyframe_masks"; });
  migrations.emplace_back([](soci::session& sql, const SqlDialect&) { sql << "ALTER TABLE no_such_table ADD x TEXT"; });
  const std::unique_ptr<SqlConnection> connection = connect();
  EXPECT_EQ(statusOf([&] { migrate(*connection, migrations); }).code, StatusCode::STORAGE);
  openSqlStore(connection_)->addKeyframe("a", makeKeyframe(0));
}

TEST_P(StoreSchema, RefusesANewerStore)
{
  openSqlStore(connection_)->createSession(makeSession("a"));
  const int current = static_cast<int>(storeMigrations().size());
  execute("UPDATE store_schema SET version = 97");
  const base::Status status = statusOf([&] { openSqlStore(connection_); });
  EXPECT_EQ(status.code, StatusCode::STORAGE);
  EXPECT_NE(status.message.find("97"), std::string::npos) << status.message;
  EXPECT_NE(status.message.find("up to " + std::to_string(current)), std::string::npos) << status.message;
  EXPECT_NE(status.message.find("update object_modelling"), std::string::npos) << status.message;
  EXPECT_EQ(version(), 97);
}

TEST_P(StoreSchema, RefusesAnotherProgramsDatabase)
{
  execute("CREATE TABLE invoices (id INTEGER)");
  const base::Status status = statusOf([&] { openSqlStore(connection_); });
  EXPECT_EQ(status.code, StatusCode::BAD_INPUT);
  EXPECT_NE(status.message.find("invoices"), std::string::npos) << status.message;
}

}  // namespace object_modelling::keyframes
