#include <filesystem>

#include <opencv2/imgproc.hpp>

#include "build_fixture.h"
#include "object_modelling/pipeline/align_sessions.h"
#include "object_modelling/pipeline/record_session.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "support/transform_matchers.h"

namespace object_modelling::pipeline
{
namespace
{
double largestError(const Eigen::Vector3d& size_m, const Eigen::Vector3d& truth_m)
{
  return (size_m - truth_m).cwiseAbs().cwiseQuotient(truth_m).maxCoeff();
}
}  // namespace

TEST(WholeChain, FromARecordingToAnObject)
{
  const Recording& recording = walkRoundBox(60, 2 * M_PI);
  const test_support::TempDir folder;
  const auto store = keyframes::openSqlStore(folder.path("store.db"));
  database::ObjectDatabase database(folder.path("objects"), true);
  base::JobControl control;
  MemorySource source(recording);
  const RecordReport recorded = recordSession(source, named("walk"), store.get(), {}, control);
  EXPECT_EQ(recorded.tracked_count, 60) << recorded.first_problem;
  const bundle_adjustment::BundleAdjustmentResult refined = refineStoredSession(*store, "walk", {}, control);
  EXPECT_TRUE(refined.status.ok()) << refined.status.message;
  const SegmentReport segmented = segmentStoredSession(*store, "walk", std::nullopt, {}, control);
  ASSERT_TRUE(segmented.status.ok()) << segmented.status.message;
  const alignment::AlignmentResult aligned = alignStoredSessions(*store, { "walk" }, {}, control);
  const BuildReport report = buildObject(*store, database, "carton", "A carton", aligned.placements, {}, control);
  ASSERT_TRUE(report.status.ok()) << report.status.message;

  EXPECT_LT(largestError(report.size_m, BOX_SIZE_M), 0.04) << report.size_m.transpose();
  EXPECT_NEAR(report.diameter_m, BOX_SIZE_M.norm(), 0.04 * BOX_SIZE_M.norm());
  const keyframes::Session session = store->session("walk");
  EXPECT_EQ(session.object_id, "carton");
  ASSERT_TRUE(session.T_model_session);
  // The object's frame in that of the true box: same centre, z up; the box looks the same after half a turn.
  const Eigen::Isometry3d T_object_model = recording.T_object_cameras[0] * session.T_model_session->inverse();
  EXPECT_LT(T_object_model.translation().norm(), 0.005);
  EXPECT_GT(T_object_model.linear()(2, 2), std::cos(0.03));
  EXPECT_GT(std::abs(T_object_model.linear()(1, 0)), std::cos(0.05));  // longer horizontal edge: y of the true box
}

TEST_F(BuildObject, WritesTheObjectInItsOwnFrame)
{
  std::vector<std::string> stages;
  base::JobControl control(
      [&stages](const base::Progress& progress)
      {
        if (stages.empty() || stages.back() != progress.stage)
          stages.push_back(progress.stage);
      });
  const BuildReport report = buildObject(*store_, database_, "carton", "A carton",
                                         { { "box", Eigen::Isometry3d::Identity() } }, coarse(), control);
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_EQ(stages.front(), "load");
  EXPECT_GE(stages.size(), 4u);
  EXPECT_LT(largestError(report.size_m, BOX_SIZE_M), 0.04) << report.size_m.transpose();
  EXPECT_GT(report.point_count, 1000u);
  EXPECT_GT(report.vertex_count, 1000u);
  EXPECT_GT(report.triangle_count, report.vertex_count);
  EXPECT_TRUE(std::filesystem::exists(report.preview_path)) << report.preview_path;
  EXPECT_EQ(report.object_folder, database_.root() + "/carton");
  EXPECT_EQ(stagesOf(report),
            (std::vector<std::string>{ "load", "fuse", "surface", "texture", "properties", "describe", "write" }));
  for (const std::string name : { "textured.obj", "textured.mtl", "textured.png", "textured.glb" })
    EXPECT_TRUE(std::filesystem::exists(report.object_folder + "/mesh/" + name)) << name;

  EXPECT_EQ(database_.check(), std::vector<std::string>());
  const database::ObjectEntry entry = database_.entry("carton");
  EXPECT_EQ(entry.name, "A carton");
  EXPECT_TRANSFORM_NEAR(entry.box_model.T_frame_box, Eigen::Isometry3d::Identity(), 1e-6, 1e-6);
  ASSERT_EQ(entry.T_support_model.size(), 1u);
  EXPECT_NEAR(entry.T_support_model[0].translation().z(), entry.size_m.z() / 2, 1e-6);
  EXPECT_NEAR(entry.T_support_model[0].linear()(2, 2), 1, 1e-9);
  ASSERT_EQ(entry.sessions.size(), 1u);
  EXPECT_EQ(entry.sessions[0].id, "box");
  EXPECT_EQ(entry.sessions[0].keyframe_count, 12);

  const keyframes::Session session = store_->session("box");
  EXPECT_EQ(session.object_id, "carton");
  ASSERT_TRUE(session.T_model_session);
  EXPECT_TRANSFORM_NEAR(*session.T_model_session, entry.sessions[0].T_model_session, 1e-9, 1e-7);
  // The session frame is the world: the box stands at its origin.
  EXPECT_LT((*session.T_model_session * Eigen::Vector3d(0, 0, 0.1)).norm(), 0.004);
  EXPECT_GT(session.T_model_session->linear()(2, 2), 1 - 1e-9);
}

TEST_F(BuildObject, ModelIsWrittenThoughItsTextureCannotBeMade)
{
  BuildOptions options = coarse();
  options.texture.max_atlas_px = 64;
  options.texture.padding_px = 64;
  const BuildReport report =
      buildObject(*store_, database_, "carton", "", { { "box", Eigen::Isometry3d::Identity() } }, options, control_);
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  EXPECT_NE(report.status.message.find("no texture"), std::string::npos) << report.status.message;
  EXPECT_NE(report.status.message.find("max_atlas_px"), std::string::npos) << report.status.message;
  EXPECT_TRUE(std::filesystem::exists(report.preview_path));
  EXPECT_TRUE(std::filesystem::exists(report.object_folder + "/mesh/mesh.ply"));
  EXPECT_FALSE(std::filesystem::exists(report.object_folder + "/mesh/textured.obj"));
  EXPECT_TRUE(database_.check().empty());
}

TEST_F(BuildObject, MakesTheSameObjectOfTheSameInput)
{
  ASSERT_TRUE(build({ "box" }).status.ok());
  const std::string first = contentHash();
  EXPECT_EQ(database_.entry("carton").name, "carton");  // where no name is given
  ASSERT_TRUE(build({ "box" }).status.ok());
  EXPECT_EQ(contentHash(), first);

  const auto store = keyframes::openSqlStore(folder_.path("again.db"));
  storeRenderedSession(*store, "box");
  database::ObjectDatabase database(folder_.path("again"), true);
  ASSERT_TRUE(
      buildObject(*store, database, "carton", "", { { "box", Eigen::Isometry3d::Identity() } }, coarse(), control_)
          .status.ok());
  EXPECT_EQ(database.entry("carton").content_hash, first);
}

TEST_F(BuildObject, KeepsTheFrameWhenItsSessionIsBuiltAgain)
{
  ASSERT_TRUE(build({ "box" }).status.ok());
  const std::string first = contentHash();
  const Eigen::Isometry3d T_model_session = *store_->session("box").T_model_session;

  // Without its upper half in every view the box would get another frame.
  std::vector<keyframes::MaskUpdate> updates;
  for (const rgbd::Keyframe& keyframe : keyframes::loadKeyframes(*store_, "box"))
  {
    cv::Mat mask = keyframe.frame.object_mask.clone();
    const cv::Rect box = cv::boundingRect(mask);
    mask(cv::Rect(0, 0, mask.cols, box.y + box.height / 2)).setTo(0);
    updates.push_back({ keyframe.id, mask });
  }
  store_->update("box", keyframes::SessionChange::ofMasks(updates));
  ASSERT_TRUE(build({ "box" }).status.ok());
  EXPECT_NE(contentHash(), first);
  const database::ObjectEntry entry = database_.entry("carton");
  EXPECT_LT(entry.size_m.z(), 0.9 * BOX_SIZE_M.z());
  EXPECT_LT(entry.box_model.T_frame_box.translation().z(), -0.01);
  EXPECT_TRANSFORM_NEAR(entry.sessions[0].T_model_session, T_model_session, 1e-9, 1e-7);
  EXPECT_TRANSFORM_NEAR(*store_->session("box").T_model_session, T_model_session, 1e-9, 1e-7);

  // Joined by another session of known placement the frame still stays.
  storeRenderedSession(*store_, "more", 4);
  ASSERT_TRUE(build({ "more", "box" }).status.ok());
  EXPECT_EQ(database_.entry("carton").sessions.size(), 2u);
  EXPECT_TRANSFORM_NEAR(*store_->session("box").T_model_session, T_model_session, 1e-9, 1e-7);
  EXPECT_TRANSFORM_NEAR(*store_->session("more").T_model_session, T_model_session, 1e-9, 1e-7);
}

TEST_F(BuildObject, LeavesToOthersWhatItDoesNotMake)
{
  const auto other = keyframes::openSqlStore(folder_.path("store.db"));
  keyframes::SessionChange meanwhile;
  meanwhile.refined = keyframes::StageMark{ "both", "" };
  meanwhile.support_plane_session = geometry::Plane{ Eigen::Vector3d(0, 0, -1), 0.123 };
  base::JobControl interrupted([&](const base::Progress&) { other->update("box", meanwhile); });
  const BuildReport report = buildObject(*store_, database_, "carton", "", { { "box", Eigen::Isometry3d::Identity() } },
                                         coarse(), interrupted);
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  const keyframes::Session session = store_->session("box");
  EXPECT_EQ(session.object_id, "carton");
  EXPECT_TRUE(session.T_model_session);
  EXPECT_EQ(session.refined.by, "both");
  EXPECT_EQ(session.support_plane_session->offset_m, 0.123);
}

}  // namespace object_modelling::pipeline
