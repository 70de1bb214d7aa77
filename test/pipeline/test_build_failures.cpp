#include <set>

#include "build_fixture.h"

// Whatever fails: the object of before stays, and so do the sessions.
namespace object_modelling::pipeline
{
using base::StatusCode;

TEST_F(BuildObject, RefusesHostileIds)
{
  for (const std::string id : { "", ".", "../carton", "a/b", "-x", "exports", "manifest.yaml" })
  {
    const BuildReport report = build({ "box" }, coarse(), id);
    EXPECT_EQ(report.status.code, StatusCode::INVALID_ARGUMENT) << id;
    EXPECT_TRUE(report.stages.empty()) << id << " is refused before any work";
  }
  EXPECT_TRUE(database_.list().empty());
  EXPECT_EQ(store_->session("box").object_id, "");
}

TEST_F(BuildObject, SaysWhatIsMissingAndKeepsTheOldObject)
{
  ASSERT_TRUE(build({ "box" }).status.ok());
  const std::string hash = contentHash();

  const BuildReport no_session = build({});
  EXPECT_EQ(no_session.status.code, StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(no_session.status.message.find("'carton' has no session"), std::string::npos);

  store_->createSession(named("empty"));
  const BuildReport no_keyframes = build({ "box", "empty" });
  EXPECT_EQ(no_keyframes.status.code, StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(no_keyframes.status.message.find("'empty' has no keyframes"), std::string::npos);
  EXPECT_EQ(store_->session("empty").object_id, "");

  EXPECT_EQ(statusOf([this] { build({ "unknown" }); }).code, StatusCode::NOT_FOUND);

  removeMasks("box");
  const std::string before = fingerprint(*store_, "box");
  const BuildReport no_masks = build({ "box" });
  EXPECT_EQ(no_masks.status.code, StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(no_masks.status.message.find("none of the 12 keyframes of session 'box'"), std::string::npos);

  // Masks that are there but show nothing.
  std::vector<keyframes::MaskUpdate> black;
  for (const int id : store_->keyframeIds("box"))
    black.push_back({ id, cv::Mat::zeros(240, 320, CV_8UC1) });
  store_->update("box", keyframes::SessionChange::ofMasks(black));
  EXPECT_EQ(build({ "box" }).status.code, StatusCode::NO_RESULT);
  removeMasks("box");

  EXPECT_EQ(fingerprint(*store_, "box"), before);
  EXPECT_EQ(contentHash(), hash);
  EXPECT_EQ(database_.check(), std::vector<std::string>());
}

TEST_F(BuildObject, RefusesOptionsThatCannotBe)
{
  BuildOptions options = coarse();
  options.fusion.resolution_m = 0;
  options.surface.resolution_m = -1;
  EXPECT_EQ(statusOf([&] { build({ "box" }, options); }).code, StatusCode::INVALID_ARGUMENT);
  EXPECT_TRUE(database_.list().empty());
}

TEST_F(BuildObject, LeavesEverythingAsItWasWhenCancelledInAnyStage)
{
  const std::vector<alignment::SessionPlacement> placements = { { "box", Eigen::Isometry3d::Identity() } };
  std::set<std::string> stages;
  base::JobControl watching([&stages](const base::Progress& progress) { stages.insert(progress.stage); });
  ASSERT_TRUE(buildObject(*store_, database_, "carton", "", placements, coarse(), watching).status.ok());
  const std::string hash = contentHash();
  keyframes::Session session = store_->session("box");
  session.object_id.clear();
  session.T_model_session.reset();
  store_->update(session.id, keyframes::SessionChange::toAllOf(session));
  const std::string before = fingerprint(*store_, "box");

  BuildOptions finer = coarse();
  finer.fusion.resolution_m = 0.003;
  for (const std::string& stage : stages)
  {
    base::JobControl* hand = nullptr;
    base::JobControl control(
        [&](const base::Progress& progress)
        {
          if (progress.stage == stage)
            hand->cancel();
        });
    hand = &control;
    EXPECT_THROW(buildObject(*store_, database_, "carton", "", placements, finer, control), base::Cancelled) << stage;
    EXPECT_EQ(contentHash(), hash) << stage;
    EXPECT_EQ(fingerprint(*store_, "box"), before) << stage;
    EXPECT_EQ(database_.check(), std::vector<std::string>()) << stage;
  }
}

}  // namespace object_modelling::pipeline
