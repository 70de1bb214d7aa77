#include <filesystem>

#include <yaml-cpp/yaml.h>

#include "build_fixture.h"
#include "model_match.h"
#include "object_scenes.h"
#include "support/transform_matchers.h"

// An object that is in the database is recorded again, in sessions that its model does not have.
namespace object_modelling::pipeline
{
using base::StatusCode;

namespace
{
constexpr double FRAME_M = 0.002, FRAME_RAD = 0.0175;  // 1 deg: 3.5 mm at the ends of the box

YAML::Node qualityOf(const BuildReport& report)
{
  return YAML::LoadFile(report.object_folder + "/quality.yaml");
}
}  // namespace

class Rescan : public BuildObject
{
protected:
  void SetUp() override
  {
    BuildObject::SetUp();
    ASSERT_TRUE(build({ "box" }).status.ok());
    T_model_box_ = *store_->session("box").T_model_session;
  }
  BuildReport rescan(const test_support::SyntheticScene& scene, bool replace = false)
  {
    const std::string id = "again" + std::to_string(store_->listSessions().size());
    storeRenderedSession(*store_, id, 12, scene);
    BuildOptions options = coarse();
    options.replace = replace;
    return build({ id }, options);
  }
  /// A point of the object has the same coordinates in the object frame as before it was moved by T.
  void expectFrameKept(const BuildReport& report, const Eigen::Isometry3d& T)
  {
    ASSERT_TRUE(report.status.ok()) << report.status.message;
    EXPECT_EQ(report.frame.by, "alignment");
    EXPECT_GE(report.frame.probability, 0.85);
    EXPECT_EQ(report.frame_version, 1);
    EXPECT_EQ(report.status.message, "");
    const database::ObjectEntry entry = database_.entry("carton");
    ASSERT_EQ(entry.sessions.size(), 1u);
    EXPECT_TRANSFORM_NEAR(entry.sessions[0].T_model_session, T_model_box_ * T.inverse(), FRAME_M, FRAME_RAD);
    EXPECT_EQ(entry.frame_version, 1);
    EXPECT_EQ(qualityOf(report)["frame"]["by"].as<std::string>(), "alignment");
    EXPECT_EQ(database_.check(), std::vector<std::string>());
  }

  Eigen::Isometry3d T_model_box_;
};

TEST_F(Rescan, FromAnotherStartKeepsTheFrame)
{
  for (const double yaw_rad : { 0.7, 2.9 })
  {
    const Eigen::Isometry3d T = turned(yaw_rad, 0.02, -0.03);
    expectFrameKept(rescan(moved(T)), T);
  }
}

TEST_F(Rescan, UpsideDownKeepsTheFrame)
{
  const Eigen::Isometry3d T = upsideDown(1.2, BOX_SIZE_M.z());
  expectFrameKept(rescan(moved(T)), T);
}

TEST_F(Rescan, WithReplaceKeepsTheFrameTooWhereItCan)
{
  const Eigen::Isometry3d T = turned(-1.9, 0, 0.02);
  expectFrameKept(rescan(moved(T), true), T);
}

TEST_F(Rescan, OfAnotherObjectIsRefused)
{
  const std::string before = contentHash();
  for (const test_support::SceneObject& other :
       { test_support::standingBox({ 0.08, 0.12, 0.2 }, 0, 0, 0, 77), test_support::standingBox({ 0.1, 0.1, 0.2 }),
         test_support::standingCylinder(0.1, 0.2) })
  {
    const BuildReport report = rescan(withObject(other));
    EXPECT_EQ(report.status.code, StatusCode::FAILED_PRECONDITION);
    for (const char* words : { "'carton' exists", "probability", "0.85", "another id", "replace" })
      EXPECT_NE(report.status.message.find(words), std::string::npos) << report.status.message;
    EXPECT_EQ(contentHash(), before);
  }
}

TEST_F(Rescan, OfAnotherObjectBeginsANewFrameOnRequest)
{
  const BuildReport report = rescan(withObject(test_support::standingCylinder(0.1, 0.2)), true);
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_EQ(report.frame.by, "new");
  EXPECT_LT(report.frame.probability, 0.85);
  EXPECT_EQ(report.frame_version, 2);
  for (const char* words : { "NEW FRAME", "'carton'", "version 2", "grasps", "probability" })
    EXPECT_NE(report.status.message.find(words), std::string::npos) << report.status.message;
  const database::ObjectEntry entry = database_.entry("carton");
  EXPECT_EQ(entry.frame_version, 2);
  EXPECT_TRANSFORM_NEAR(entry.box_model.T_frame_box, Eigen::Isometry3d::Identity(), 1e-6, 1e-6);
  const YAML::Node quality = qualityOf(report);
  EXPECT_EQ(quality["frame"]["version"].as<int>(), 2);
  ASSERT_EQ(quality["warnings"].size(), 1u);
  EXPECT_NE(quality["warnings"][0].as<std::string>().find("NEW FRAME"), std::string::npos);

  // The version stays with the object.
  ASSERT_TRUE(build({ entry.sessions[0].id }).status.ok());
  EXPECT_EQ(database_.entry("carton").frame_version, 2);
}

TEST_F(Rescan, BySessionsOfTheSameNameIsNoReasonToTakeTheirPlace)
{
  const Eigen::Isometry3d T = turned(0.9, 0.03, 0.01);
  const auto recorded = keyframes::openSqlStore(folder_.path("recorded.db"));
  storeRenderedSession(*recorded, "box", 12, moved(T));
  store_ = keyframes::openSqlStore(folder_.path("later.db"));
  store_->createSession(recorded->session("box"));
  for (rgbd::Keyframe keyframe : keyframes::loadKeyframes(*recorded, "box"))
  {
    keyframe.frame.stamp_s += 3600;
    store_->addKeyframe("box", keyframe);
  }
  expectFrameKept(build({ "box" }), T);
}

TEST(ModelMatch, AnotherPrintOfAShapeIsAnotherObject)
{
  registration::PairQuality quality;
  quality.texture = 0.2;
  quality.color_agreement = 0.1;
  quality.edge_agreement = 0.2;
  EXPECT_TRUE(texturesDiffer(quality));
  quality.edge_agreement = 0.8;  // under other light
  EXPECT_FALSE(texturesDiffer(quality));
  quality.edge_agreement = 0;
  quality.texture = 0.02;  // plain
  EXPECT_FALSE(texturesDiffer(quality));
}

TEST_F(Rescan, OfADamagedObjectSaysWhatIsWrong)
{
  std::filesystem::remove(database_.root() + "/carton/cloud.pcd");
  const BuildReport refused = rescan(test_support::boxOnTable());
  EXPECT_EQ(refused.status.code, StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(refused.status.message.find("cloud.pcd"), std::string::npos) << refused.status.message;
  const BuildReport replaced = rescan(test_support::boxOnTable(), true);
  ASSERT_TRUE(replaced.status.ok()) << replaced.status.message;
  EXPECT_EQ(database_.entry("carton").frame_version, 2);
}

}  // namespace object_modelling::pipeline
