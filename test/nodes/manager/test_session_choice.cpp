#include "nodes/manager/session_choice.h"

#include <gtest/gtest.h>

#include "support/temp_dir.h"

namespace object_modelling::nodes
{
namespace
{
using base::StatusCode;
using Ids = std::vector<std::string>;

rgbd::Keyframe smallKeyframe()
{
  rgbd::Keyframe keyframe;
  keyframe.id = 0;
  keyframe.frame.stamp_s = 100;
  keyframe.frame.camera.width = 8;
  keyframe.frame.camera.height = 6;
  keyframe.frame.camera.fx = keyframe.frame.camera.fy = 8;
  keyframe.frame.color_bgr = cv::Mat(6, 8, CV_8UC3, cv::Scalar::all(9));
  keyframe.frame.gray = cv::Mat(6, 8, CV_8UC1, cv::Scalar(9));
  keyframe.frame.depth_m = cv::Mat(6, 8, CV_32FC1, cv::Scalar(0.5));
  return keyframe;
}

class SessionChoice : public ::testing::Test
{
protected:
  SessionChoice() : store_(keyframes::openSqlStore(folder_.path("store.sqlite"))) {}

  void add(const std::string& session_id, const std::string& object_id, bool with_keyframe = true)
  {
    keyframes::Session session;
    session.id = session_id;
    session.object_id = object_id;
    session.started_s = ++count_;
    store_->createSession(session);
    if (with_keyframe)
      store_->addKeyframe(session_id, smallKeyframe());
  }
  void addAll()
  {
    add("a", "mug");
    add("b", "mug");
    add("c", "");
    add("d", "cup", false);
  }

  Ids choose(const std::string& object_id, const Ids& session_ids = {}, const std::string& last = "")
  {
    return chooseSessions(*store_, object_id, session_ids, last);
  }
  void expectRefused(StatusCode code, const std::string& part, const std::string& object_id,
                     const Ids& session_ids = {}, const std::string& last = "")
  {
    try
    {
      choose(object_id, session_ids, last);
      FAIL() << "not refused: " << part;
    }
    catch (const base::Error& error)
    {
      EXPECT_EQ(error.code(), code);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }

  test_support::TempDir folder_;
  int count_ = 0;
  std::unique_ptr<keyframes::SessionStore> store_;
};
}  // namespace

TEST_F(SessionChoice, NamedSessionsInTheirOrder)
{
  addAll();
  EXPECT_EQ(choose("mug", { "c", "a" }), (Ids{ "c", "a" }));
}

TEST_F(SessionChoice, AllSessionsOfTheObject)
{
  addAll();
  EXPECT_EQ(choose("mug"), (Ids{ "a", "b" }));
  EXPECT_EQ(choose("mug", {}, "c"), (Ids{ "a", "b" }));
}

TEST_F(SessionChoice, TheLastSessionIfItNamesNoObject)
{
  addAll();
  EXPECT_EQ(choose("plate", {}, "c"), Ids{ "c" });
  expectRefused(StatusCode::NOT_FOUND, "stored: a, b, c, d", "plate", {}, "a");
}

TEST_F(SessionChoice, ObjectWithoutSession)
{
  expectRefused(StatusCode::NOT_FOUND, "stored: none", "plate");
}

TEST_F(SessionChoice, UnknownSession)
{
  addAll();
  expectRefused(StatusCode::NOT_FOUND, "'x'", "mug", { "a", "x" });
}

TEST_F(SessionChoice, SessionTwice)
{
  addAll();
  expectRefused(StatusCode::INVALID_ARGUMENT, "twice: a", "mug", { "a", "b", "a" });
}

TEST_F(SessionChoice, SessionWithoutKeyframes)
{
  addAll();
  expectRefused(StatusCode::FAILED_PRECONDITION, "'d'", "cup");
}

TEST(CheckId, ObjectIds)
{
  for (const std::string bad : { "", "a/b", ".hidden", "-x", "mug\n", "m g" })
    EXPECT_THROW(checkId("object id", bad), base::Error) << bad;
  EXPECT_THROW(checkId("object id", std::string(65, 'x')), base::Error);
  EXPECT_NO_THROW(checkId("object id", std::string(64, 'x')));
}

}  // namespace object_modelling::nodes
