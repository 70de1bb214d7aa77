#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "postgresql_server.h"
#include "store_fixtures.h"

namespace object_modelling::keyframes
{
namespace fs = std::filesystem;
using base::StatusCode;

class SessionFile : public ::testing::Test
{
protected:
  SessionFile() : store_(openSqlStore(folder_.path("store.db")))
  {
    Session session = makeSession("a");
    session.T_model_session = makeKeyframe(4).T_session_camera;
    session.closed = true;
    session.calibration = makeCalibration();
    session.refinement_report = "refined";
    session.reference_is_object = true;
    store_->createSession(session);
    store_->createSession(makeSession("other"));
    rgbd::Keyframe unmasked = makeKeyframe(1);
    unmasked.frame.object_mask.release();
    unmasked.frame.moving_mask.release();
    store_->addKeyframe("a", makeKeyframe(0));
    store_->addKeyframe("a", unmasked);
  }
  /// Whether a session arrived whole; depth bit for bit as the first store gives it.
  void expectArrived(SessionStore& target)
  {
    const Session session = target.session("a"), expected = store_->session("a");
    EXPECT_EQ(session.keyframe_count, 2);
    EXPECT_TRUE(session.closed);
    EXPECT_TRUE(session.reference_is_object);
    EXPECT_EQ(session.object_id, "cup");
    EXPECT_TRUE(session.calibration == expected.calibration);
    EXPECT_EQ(session.refinement_report, "refined");
    EXPECT_EQ(session.started_s, expected.started_s);
    EXPECT_EQ(session.T_model_session->matrix(), expected.T_model_session->matrix());
    for (const int id : store_->keyframeIds("a"))
    {
      expectSame(target.keyframe("a", id), store_->keyframe("a", id));
      EXPECT_EQ(depthDifference_m(target.keyframe("a", id).frame.depth_m, store_->keyframe("a", id).frame.depth_m), 0);
    }
  }
  std::size_t filesIn(const std::string& folder)
  {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  TemporaryFolder folder_, target_;
  std::unique_ptr<SessionStore> store_;
};

TEST_F(SessionFile, GoesToAnotherStore)
{
  const std::string file = target_.path("with space.session");
  store_->exportSession("a", file);
  EXPECT_EQ(filesIn(target_.path()), 1u);  // one file: no journal, no temporary
  const std::unique_ptr<SessionStore> other = openSqlStore(folder_.path("other.db"));
  EXPECT_EQ(other->importSession(file), "a");
  EXPECT_EQ(other->listSessions().size(), 1u);
  expectArrived(*other);
  EXPECT_EQ(openSqlStore(file)->listSessions().size(), 1u);  // and is a store by itself
}

TEST_F(SessionFile, GoesToPostgresqlAndBack)
{
  PostgresqlServer* server = PostgresqlServer::shared();
  if (server == nullptr)
    GTEST_SKIP() << "PostgreSQL's server is not installed (package postgresql)";
  store_->exportSession("a", target_.path("out.session"));
  const std::unique_ptr<SessionStore> fleet = openSqlStore(server->createDatabase());
  fleet->importSession(target_.path("out.session"));
  expectArrived(*fleet);
  fleet->exportSession("a", target_.path("back.session"));
  const std::unique_ptr<SessionStore> other = openSqlStore(folder_.path("other.db"));
  other->importSession(target_.path("back.session"));
  expectArrived(*other);
}

TEST_F(SessionFile, ReplacesNothing)
{
  const std::string file = target_.path("a.session");
  store_->exportSession("a", file);
  EXPECT_EQ(statusOf([&] { store_->exportSession("a", file); }).code, StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(statusOf([&] { store_->exportSession("a", folder_.path("store.db")); }).code,
            StatusCode::FAILED_PRECONDITION);
  const base::Status status = statusOf([&] { store_->importSession(file); });
  EXPECT_EQ(status.code, StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(status.message.find("'a'"), std::string::npos) << status.message;
  EXPECT_EQ(store_->session("a").keyframe_count, 2);
}

TEST_F(SessionFile, LeavesNothingBehindWhenItFails)
{
  EXPECT_EQ(statusOf([&] { store_->exportSession("none", target_.path("x")); }).code, StatusCode::NOT_FOUND);
  EXPECT_EQ(filesIn(target_.path()), 0u);
  EXPECT_EQ(statusOf([&] { store_->exportSession("a", target_.path("no/folder/x")); }).code, StatusCode::STORAGE);
  EXPECT_EQ(statusOf([&] { store_->exportSession("a", ""); }).code, StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(statusOf([&] { store_->exportSession("a", target_.path() + "/"); }).code, StatusCode::INVALID_ARGUMENT);
}

TEST_F(SessionFile, ImportsFromAWriteProtectedFile)
{
  const std::string file = target_.path("a.session");
  store_->exportSession("a", file);
  fs::permissions(file, fs::perms::owner_read);
  const std::unique_ptr<SessionStore> other = openSqlStore(folder_.path("other.db"));
  EXPECT_EQ(other->importSession(file), "a");
}

TEST_F(SessionFile, RefusesOtherFiles)
{
  EXPECT_EQ(statusOf([&] { store_->importSession(target_.path("none")); }).code, StatusCode::NOT_FOUND);
  EXPECT_EQ(statusOf([&] { store_->importSession(target_.path()); }).code, StatusCode::NOT_FOUND);
  std::ofstream(target_.path("empty")).flush();
  EXPECT_EQ(statusOf([&] { store_->importSession(target_.path("empty")); }).code, StatusCode::BAD_INPUT);
  std::ofstream(target_.path("text")) << std::string(5000, 'x');
  EXPECT_EQ(statusOf([&] { store_->importSession(target_.path("text")); }).code, StatusCode::BAD_INPUT);
  // A whole store is not one session.
  store_.reset();
  const std::unique_ptr<SessionStore> other = openSqlStore(folder_.path("other.db"));
  EXPECT_EQ(statusOf([&] { other->importSession(folder_.path("store.db")); }).code, StatusCode::BAD_INPUT);
  EXPECT_TRUE(other->listSessions().empty());
}

TEST_F(SessionFile, RefusesADamagedFileWhole)
{
  const std::string file = target_.path("a.session");
  store_->exportSession("a", file);
  fs::resize_file(file, fs::file_size(file) / 2);
  const std::unique_ptr<SessionStore> other = openSqlStore(folder_.path("other.db"));
  EXPECT_EQ(statusOf([&] { other->importSession(file); }).code, StatusCode::BAD_INPUT);
  EXPECT_TRUE(other->listSessions().empty());
}

}  // namespace object_modelling::keyframes
