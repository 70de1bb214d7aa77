#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "../../src/keyframes/sql_store.h"
#include "every_backend.h"

namespace object_modelling::keyframes
{
namespace
{
/// Any dialect, whose process dies by SIGKILL instead of sending its `statement`-th statement after arm().
class DyingDialect : public SqlDialect
{
public:
  explicit DyingDialect(std::unique_ptr<SqlDialect> inner) : inner_(std::move(inner)) {}
  void arm(int statement) { *left_ = statement; }

  std::string storeName() const override { return inner_->storeName(); }
  void connect(soci::session& sql) const override
  {
    inner_->connect(sql);
    sql.set_query_transformation(
        [left = left_](const std::string& query)
        {
          if (*left > 0 && --*left == 0)
            raise(SIGKILL);
          return query;
        });
  }
  std::string beginRead() const override { return inner_->beginRead(); }
  std::string beginWrite() const override { return inner_->beginWrite(); }
  void lockSchema(soci::session& sql) const override { inner_->lockSchema(sql); }
  std::vector<std::string> tables(soci::session& sql) const override { return inner_->tables(sql); }
  std::string blobType() const override { return inner_->blobType(); }
  std::string blobValue(const std::string& parameter) const override { return inner_->blobValue(parameter); }
  std::string encodeBlob(const std::string& bytes) const override { return inner_->encodeBlob(bytes); }
  std::string decodeBlob(const std::string& text) const override { return inner_->decodeBlob(text); }
  base::Status explain(const soci::soci_error& error) const override { return inner_->explain(error); }
  bool connectionLost(const soci::soci_error& error) const override { return inner_->connectionLost(error); }

private:
  std::unique_ptr<SqlDialect> inner_;
  std::shared_ptr<int> left_ = std::make_shared<int>(0);
};

/// Everything that a change can set.
SessionChange changeOfAll()
{
  SessionChange change;
  for (int id = 0; id < 3; ++id)
  {
    const rgbd::Keyframe other = makeKeyframe(id + 5);
    change.poses.push_back({ id, other.T_session_camera, other.covariance });
    change.masks.push_back({ id, cv::Mat(48, 64, CV_8UC1, cv::Scalar(255)) });
  }
  change.object_id = "changed";
  change.reference_is_object = true;
  change.closed = true;
  change.support_plane_session = geometry::Plane{ Eigen::Vector3d(0, 0, -1), 0.75 };
  change.T_model_session = makeKeyframe(9).T_session_camera;
  change.calibration = makeCalibration();
  change.refinement_report = "report";
  change.refined = StageMark{ "both", "{}" };
  change.segmented = StageMark{ stage_mark::BY_HAND, "{seed_point_session_m: [0, 0, 1]}" };
  return change;
}

/// What a change can touch, as text: equal where nothing of it differs.
std::string stateOf(SessionStore& store)
{
  const Session session = store.session("a");
  std::ostringstream out;
  out << session.object_id << session.reference_is_object << session.closed << session.refinement_report
      << session.refined.by << session.refined.options << session.segmented.by << session.segmented.options
      << (session.calibration == makeCalibration()) << session.support_plane_session.has_value();
  if (session.T_model_session)
    out << session.T_model_session->matrix();
  for (int id = 0; id < 3; ++id)
  {
    const rgbd::Keyframe keyframe = store.keyframe("a", id);
    out << keyframe.T_session_camera.matrix() << keyframe.covariance << cv::sum(keyframe.frame.object_mask)[0];
  }
  return out.str();
}
}  // namespace

class SessionChangeTest : public OnEveryBackend
{
protected:
  void SetUp() override
  {
    OnEveryBackend::SetUp();
    if (!IsSkipped())
      fill();
  }
  void fill()
  {
    const std::unique_ptr<SessionStore> store = openSqlStore(connection_);
    for (const Session& session : store->listSessions())
      store->deleteSession(session.id);
    store->createSession(makeSession("a"));
    for (int id = 0; id < 3; ++id)
      store->addKeyframe("a", makeKeyframe(id));
  }
  /// Whether another process that makes the change dies of its `statement`-th statement.
  bool diesAt(int statement) const
  {
    const pid_t child = fork();
    if (child == 0)
    {
      auto dying = std::make_unique<DyingDialect>(dialect());
      DyingDialect& armed = *dying;
      const std::unique_ptr<SessionStore> store = makeSqlStore(std::move(dying));
      armed.arm(statement);
      store->update("a", changeOfAll());
      _exit(0);  // without the parent's own clean-up: the server is the parent's
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) || (WIFEXITED(status) && WEXITSTATUS(status) == 0)) << status;
    return WIFSIGNALED(status);
  }
};
INSTANTIATE_ON_EVERY_BACKEND(SessionChangeTest);

TEST_P(SessionChangeTest, WritesAllThatIsSet)
{
  const std::unique_ptr<SessionStore> store = openSqlStore(connection_);
  store->update("a", changeOfAll());
  const Session session = store->session("a");
  EXPECT_EQ(session.object_id, "changed");
  EXPECT_TRUE(session.reference_is_object && session.closed);
  ASSERT_TRUE(session.support_plane_session && session.T_model_session);
  EXPECT_EQ(session.support_plane_session->offset_m, 0.75);
  EXPECT_TRUE(session.T_model_session->isApprox(makeKeyframe(9).T_session_camera, 0));
  EXPECT_TRUE(session.calibration == makeCalibration());
  EXPECT_EQ(session.refinement_report, "report");
  EXPECT_EQ(session.refined, (StageMark{ "both", "{}" }));
  EXPECT_EQ(session.segmented.by, stage_mark::BY_HAND);
  EXPECT_TRUE(store->keyframe("a", 2).T_session_camera.isApprox(makeKeyframe(7).T_session_camera, 0));
  EXPECT_EQ(cv::countNonZero(store->keyframe("a", 1).frame.object_mask), 64 * 48);
}

TEST_P(SessionChangeTest, LeavesWhatIsNotSetToOthers)
{
  const std::unique_ptr<SessionStore> store = openSqlStore(connection_), other = openSqlStore(connection_);
  store->update("a", changeOfAll());
  SessionChange change;
  change.closed = false;
  other->update("a", change);
  SessionChange taken_away;
  taken_away.support_plane_session = std::optional<geometry::Plane>();
  taken_away.segmented = StageMark();
  store->update("a", taken_away);
  const Session session = store->session("a");
  EXPECT_FALSE(session.closed || session.support_plane_session || session.segmented.done());
  EXPECT_EQ(session.object_id, "changed");
  EXPECT_TRUE(session.T_model_session && session.reference_is_object && session.refined.done());
  EXPECT_TRUE(session.calibration == makeCalibration());
}

TEST_P(SessionChangeTest, AnEmptyOneChangesNothingButNeedsTheSession)
{
  const std::unique_ptr<SessionStore> store = openSqlStore(connection_);
  const std::string before = stateOf(*store);
  store->update("a", {});
  EXPECT_EQ(stateOf(*store), before);
  EXPECT_EQ(statusOf([&] { store->update("none", {}); }).code, base::StatusCode::NOT_FOUND);
}

TEST_P(SessionChangeTest, AMistakeInOnePartUndoesAll)
{
  const std::unique_ptr<SessionStore> store = openSqlStore(connection_);
  const std::string before = stateOf(*store);
  SessionChange change = changeOfAll();
  change.masks.back().keyframe_id = 42;
  EXPECT_EQ(statusOf([&] { store->update("a", change); }).code, base::StatusCode::NOT_FOUND);
  change = changeOfAll();
  change.masks.back().object_mask = cv::Mat(5, 5, CV_8UC1, cv::Scalar(0));
  EXPECT_EQ(statusOf([&] { store->update("a", change); }).code, base::StatusCode::INVALID_ARGUMENT);
  change = changeOfAll();
  change.refined->options = std::string("a\0b", 3);
  EXPECT_EQ(statusOf([&] { store->update("a", change); }).code, base::StatusCode::INVALID_ARGUMENT);
  change = changeOfAll();
  change.object_id = "../escape";
  EXPECT_EQ(statusOf([&] { store->update("a", change); }).code, base::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(stateOf(*store), before);
}

TEST_P(SessionChangeTest, AKillBetweenAnyTwoStatementsLeavesItAsBeforeOrAsAfter)
{
  const std::string before = stateOf(*openSqlStore(connection_));
  openSqlStore(connection_)->update("a", changeOfAll());
  const std::string after = stateOf(*openSqlStore(connection_));
  ASSERT_NE(before, after);
  fill();
  int kills = 0;
  while (kills < 100 && diesAt(kills + 1))
  {
    ++kills;
    EXPECT_EQ(stateOf(*openSqlStore(connection_)), before) << "killed at statement " << kills;
  }
  EXPECT_EQ(stateOf(*openSqlStore(connection_)), after);
  EXPECT_GT(kills, 20) << "begin, session, poses, masks and commit are more statements";
  EXPECT_LT(kills, 100);
}

}  // namespace object_modelling::keyframes
