#include "object_modelling/pipeline/merge_objects.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "build_fixture.h"
#include "object_scenes.h"
#include "support/transform_matchers.h"

// Whether a new object is one that is there already, and making one object of two.
namespace object_modelling::pipeline
{
using base::StatusCode;

class Merge : public BuildObject
{
protected:
  void SetUp() override
  {
    BuildObject::SetUp();
    ASSERT_TRUE(build({ "box" }).status.ok());
    T_model_box_ = *store_->session("box").T_model_session;
  }
  BuildReport buildNew(const std::string& object_id, const test_support::SyntheticScene& scene)
  {
    storeRenderedSession(*store_, object_id + "_scan", 12, scene);
    return build({ object_id + "_scan" }, coarse(), object_id);
  }
  MergeReport merge(const std::string& keep, const std::string& drop, base::JobControl& control)
  {
    return mergeObjects(database_, keep, drop, coarse(), store_.get(), control);
  }
  void expectNothingChanged(const std::map<std::string, std::string>& before)
  {
    EXPECT_EQ(database_.contentHashes(), before);
    EXPECT_EQ(database_.check(), std::vector<std::string>());
  }

  Eigen::Isometry3d T_model_box_;
};

TEST_F(Merge, ANewObjectThatIsThereAlreadyIsRecognised)
{
  std::set<std::string> stages;
  base::JobControl watching([&](const base::Progress& progress) { stages.insert(progress.stage); });
  storeRenderedSession(*store_, "again", 12, moved(turned(1.1, 0.02, 0)));
  const BuildReport report =
      buildObject(*store_, database_, "packet", "", { { "again", Eigen::Isometry3d::Identity() } }, coarse(), watching);
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  ASSERT_EQ(report.looks_like.size(), 1u);
  EXPECT_EQ(report.looks_like[0].object_id, "carton");
  EXPECT_GE(report.looks_like[0].probability, 0.85);
  for (const char* words :
       { "'packet' looks like 'carton' (probability 0.", "object_modelling merge", "carton packet" })
    EXPECT_NE(report.status.message.find(words), std::string::npos) << report.status.message;
  EXPECT_EQ(stages.count("compare with 'carton'"), 1u);
  EXPECT_EQ(report.frame.by, "first");
  EXPECT_EQ(database_.list().size(), 2u);
}

TEST_F(Merge, AnotherObjectOfItsSizeIsNot)
{
  const BuildReport texture = buildNew("soap", withObject(test_support::standingBox({ 0.08, 0.12, 0.2 }, 0, 0, 0, 77)));
  ASSERT_TRUE(texture.status.ok()) << texture.status.message;
  EXPECT_EQ(stagesOf(texture)[4], "compare");
  EXPECT_TRUE(texture.looks_like.empty()) << texture.status.message;
  const BuildReport shape = buildNew("can", withObject(test_support::standingCylinder(0.11, 0.2)));
  ASSERT_TRUE(shape.status.ok()) << shape.status.message;
  EXPECT_TRUE(shape.looks_like.empty()) << shape.status.message;
  EXPECT_EQ(shape.status.message, "");
}

TEST_F(Merge, AnObjectOfAnotherSizeIsNotEvenCompared)
{
  const BuildReport report = buildNew("small", withObject(test_support::standingBox({ 0.06, 0.09, 0.15 })));
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  const std::vector<std::string> stages = stagesOf(report);
  EXPECT_EQ(std::count(stages.begin(), stages.end(), "compare"), 0);
}

TEST_F(Merge, OneObjectOfBothKeepsItsFrame)
{
  const Eigen::Isometry3d T = upsideDown(0.8, BOX_SIZE_M.z());
  ASSERT_TRUE(buildNew("packet", moved(T)).status.ok());
  const double unseen = database_.entry("carton").properties->unseen->ratio;
  const MergeReport report = merge("carton", "packet", control_);
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_TRUE(report.rebuilt);
  EXPECT_EQ(database_.check(), std::vector<std::string>());
  const std::vector<database::ObjectEntry> left = database_.list();
  ASSERT_EQ(left.size(), 1u);
  const database::ObjectEntry& entry = left[0];
  EXPECT_EQ(entry.id, "carton");
  EXPECT_EQ(entry.aliases, std::vector<std::string>{ "packet" });
  EXPECT_EQ(entry.frame_version, 1);
  ASSERT_EQ(entry.sessions.size(), 2u);
  EXPECT_TRANSFORM_NEAR(entry.sessions[0].T_model_session, T_model_box_, 1e-6, 1e-6);
  EXPECT_TRANSFORM_NEAR(entry.sessions[1].T_model_session, T_model_box_ * T.inverse(), 0.002, 0.0175);
  EXPECT_LE(entry.properties->unseen->ratio, unseen + 0.01);
  EXPECT_FALSE(entry.properties->unseen->bottom) << "the other one showed it";
  EXPECT_EQ(store_->session("packet_scan").object_id, "carton");
  EXPECT_TRANSFORM_NEAR(*store_->session("packet_scan").T_model_session, entry.sessions[1].T_model_session, 1e-6, 1e-6);
}

TEST_F(Merge, WhatIsNotOneObjectStaysTwo)
{
  ASSERT_TRUE(buildNew("can", withObject(test_support::standingCylinder(0.11, 0.2))).status.ok());
  const std::map<std::string, std::string> before = database_.contentHashes();
  const MergeReport report = merge("carton", "can", control_);
  EXPECT_EQ(report.status.code, StatusCode::FAILED_PRECONDITION);
  for (const char* words : { "'can'", "'carton'", "probability", "delete" })
    EXPECT_NE(report.status.message.find(words), std::string::npos) << report.status.message;
  expectNothingChanged(before);
  EXPECT_EQ(statusOf([&] { merge("carton", "carton", control_); }).code, StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(statusOf([&] { merge("carton", "none", control_); }).code, StatusCode::NOT_FOUND);
  EXPECT_EQ(statusOf([&] { database_.absorb("carton", "can", "stale"); }).code, StatusCode::FAILED_PRECONDITION);
  expectNothingChanged(before);
}

TEST_F(Merge, NothingIsLostWhenItIsCancelledOrBrokenOff)
{
  ASSERT_TRUE(buildNew("packet", moved(turned(2.1, 0.02, 0))).status.ok());
  const std::map<std::string, std::string> before = database_.contentHashes();
  for (const std::string stage : { "load", "properties", "write object 'carton'" })
  {
    base::JobControl* hand = nullptr;
    base::JobControl control(
        [&](const base::Progress& progress)
        {
          if (progress.stage == stage)
            hand->cancel();
        });
    hand = &control;
    EXPECT_THROW(merge("carton", "packet", control), base::Cancelled) << stage;
    expectNothingChanged(before);
  }
  // Broken off between the common model and the other one's end: both are there, and the same command goes on.
  const std::string backup = folder_.path("backup"), root = database_.root();
  std::filesystem::copy(root, backup, std::filesystem::copy_options::recursive);
  ASSERT_TRUE(merge("carton", "packet", control_).status.ok());
  database::ObjectDatabase other(backup, false);
  std::filesystem::remove_all(backup + "/carton");
  std::filesystem::copy(root + "/carton", backup + "/carton", std::filesystem::copy_options::recursive);
  const MergeReport again = mergeObjects(other, "carton", "packet", coarse(), nullptr, control_);
  ASSERT_TRUE(again.status.ok()) << again.status.message;
  EXPECT_FALSE(again.rebuilt);
  EXPECT_EQ(other.entry("carton").aliases, std::vector<std::string>{ "packet" });
  EXPECT_EQ(other.entry("carton").sessions.size(), 2u);
  EXPECT_EQ(other.contentHashes().size(), 1u);
}

TEST_F(Merge, RenamedObjectsTakeTheirSessionsAlong)
{
  EXPECT_EQ(renameObject(database_, "carton", "packet", store_.get(), control_), "");
  EXPECT_EQ(store_->session("box").object_id, "packet");
  EXPECT_EQ(database_.check(), std::vector<std::string>());
  const std::map<std::string, std::string> before = database_.contentHashes();
  ASSERT_TRUE(buildNew("can", withObject(test_support::standingCylinder(0.11, 0.2))).status.ok());
  EXPECT_EQ(statusOf([&] { renameObject(database_, "packet", "can", store_.get(), control_); }).code,
            StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(store_->session("box").object_id, "packet");
  EXPECT_EQ(database_.contentHashes().at("packet"), before.at("packet"));
}

}  // namespace object_modelling::pipeline
