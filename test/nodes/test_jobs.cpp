// refiner, segmenter, session_aligner and model_builder over real actions, on a synthetic session in a real store.
#include <filesystem>

#include <gtest/gtest.h>
#include <object_modelling/Progress.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>

#include "job_fixture.h"

namespace object_modelling::nodes
{
TEST_F(JobsTest, SessionsThatAreNotThere)
{
  EXPECT_STATUS(Status::INVALID_ARGUMENT, "no session ids", refine({}));
  EXPECT_STATUS(Status::INVALID_ARGUMENT, "no session ids", align({}));
  EXPECT_STATUS(Status::NOT_FOUND, "missing", refine({ "missing" }));
  EXPECT_STATUS(Status::NOT_FOUND, "missing", align({ "missing" }));
  EXPECT_STATUS(Status::NOT_FOUND, "missing", segment("missing"));
  EXPECT_STATUS(Status::NOT_FOUND, "missing", build(buildGoal("box", "missing")));
}

TEST_F(JobsTest, SessionWithoutKeyframes)
{
  record(store_, "empty", 0);
  EXPECT_STATUS(Status::FAILED_PRECONDITION, "'empty' has no keyframes", refine({ "empty" }));
  EXPECT_STATUS(Status::FAILED_PRECONDITION, "'empty' has no keyframes", segment("empty"));
  EXPECT_STATUS(Status::FAILED_PRECONDITION, "'empty' has no keyframes", build(buildGoal("box", "empty")));
}

TEST_F(JobsTest, RefinesByTheMethodAskedFor)
{
  record(store_, "surfaces", 12);
  const auto result = refine({ "surfaces" }, "refiner", object_modelling::RefineGoal::MULTI_VIEW_ICP);
  ASSERT_EQ(result.status.code, Status::OK) << result.status.message;
  ASSERT_EQ(result.sessions.size(), 1U);
  const object_modelling::SessionRefinement& refined = result.sessions[0];
  EXPECT_EQ(refined.icp_residuals.size(), 12U);
  EXPECT_EQ(static_cast<int>(refined.icp_rmse_m.size()), refined.icp_iterations);
  EXPECT_TRUE(refined.residuals.empty());
  EXPECT_TRUE(refined.icp_left_out.empty());
  EXPECT_STATUS(Status::INVALID_ARGUMENT, "method 9", refine({ "surfaces" }, "refiner", 9));
}

TEST_F(JobsTest, StoreThatIsDownIsNamed)
{
  EXPECT_STATUS(Status::TIMEOUT, "no_such_store", refine({ "any" }, "lonely_refiner"));
}

TEST_F(JobsTest, BadBuildGoals)
{
  record(store_, "unmasked", 2);
  EXPECT_STATUS(Status::INVALID_ARGUMENT, "a/b", build(buildGoal("a/b", "unmasked")));
  object_modelling::BuildGoal without_sessions;
  without_sessions.object_id = "box";
  EXPECT_STATUS(Status::FAILED_PRECONDITION, "no session", build(without_sessions));
  EXPECT_STATUS(Status::FAILED_PRECONDITION, "unmasked", build(buildGoal("box", "unmasked")));
  object_modelling::BuildGoal zero_poses = buildGoal("box", "unmasked");
  zero_poses.placements.push_back(zero_poses.placements[0]);
  EXPECT_EQ(build(zero_poses).status.code, Status::INVALID_ARGUMENT);
  EXPECT_TRUE(list().objects.empty()) << "a refused build leaves nothing";
}

TEST_F(JobsTest, UnwritableDatabase)
{
  record(store_, "unwritable", 1);
  EXPECT_STATUS(Status::STORAGE, "/proc/object_modelling", build(buildGoal("box", "unwritable"), "unwritable_builder"));
  EXPECT_EQ(list("unwritable_builder").status.code, Status::OK) << "the node lives on";
}

TEST_F(JobsTest, FromSessionToObject)
{
  record(store_, "round", 14);
  const object_modelling::SegmentSessionResult segmented = segment("round");
  ASSERT_EQ(segmented.status.code, Status::OK) << segmented.status.message;
  EXPECT_EQ(segmented.keyframe_count, 14);
  EXPECT_EQ(segmented.masked_count, 14);
  EXPECT_TRUE(segmented.has_support_plane);

  const object_modelling::AlignResult aligned = align({ "round" });
  ASSERT_EQ(aligned.status.code, Status::OK) << aligned.status.message;
  ASSERT_EQ(aligned.placements.size(), 1u);
  EXPECT_EQ(aligned.placements[0].reference_from_session.orientation.w, 1);

  object_modelling::BuildGoal goal = buildGoal("box", "round");
  goal.name = "A box";
  goal.placements = aligned.placements;
  Job<object_modelling::BuildAction> job("model_builder/build");
  job.send(goal);
  const object_modelling::BuildResult result = job.wait();
  ASSERT_EQ(result.status.code, Status::OK) << result.status.message;
  EXPECT_GT(job.feedback_count, 0);
  EXPECT_NEAR(result.built.size_m.z, BOX_SIZE_M.z(), 0.01);
  EXPECT_NEAR(result.built.size_m.x, BOX_SIZE_M.y(), 0.01);
  EXPECT_NEAR(result.built.size_m.y, BOX_SIZE_M.x(), 0.01);
  EXPECT_GT(result.built.triangle_count, 1000u);
  EXPECT_GE(result.built.stages.size(), 3u);
  for (const std::string& path : { result.built.object_folder, result.built.mesh_path, result.built.preview_path })
    EXPECT_TRUE(std::filesystem::exists(path)) << path;

  const object_modelling::ListObjects::Response objects = list();
  ASSERT_EQ(objects.status.code, Status::OK) << objects.status.message;
  ASSERT_EQ(objects.objects.size(), 1u);
  EXPECT_EQ(objects.objects[0].object_id, "box");
  EXPECT_EQ(objects.objects[0].name, "A box");
  EXPECT_EQ(objects.objects[0].session_ids, std::vector<std::string>{ "round" });

  const auto preview =
      ros::topic::waitForMessage<sensor_msgs::PointCloud2>("model_builder/model", node_, ros::Duration(PATIENCE_S));
  ASSERT_TRUE(preview);
  EXPECT_EQ(preview->width, result.built.vertex_count);
  EXPECT_EQ(preview->header.frame_id, "session");

  record(store_, "other", 2);
  segment("other");
  const object_modelling::BuildResult again = build(buildGoal("box", "other"));
  ASSERT_EQ(again.status.code, Status::OK) << again.status.message;
  EXPECT_EQ(again.built.frame_by, "alignment") << "recorded anew, the same box keeps its frame";
  EXPECT_EQ(again.built.frame_version, result.built.frame_version);
}

TEST_F(JobsTest, AlignsTwoSessionsOfOneObjectAndRefusesOneWithoutMasks)
{
  record(store_, "first", 12);
  record(store_, "second", 10);
  ASSERT_EQ(segment("first").status.code, Status::OK);
  EXPECT_STATUS(Status::FAILED_PRECONDITION, "'second'", align({ "first", "second" }));
  ASSERT_EQ(segment("second").status.code, Status::OK);
  const object_modelling::AlignResult aligned = align({ "first", "second" });
  ASSERT_EQ(aligned.status.code, Status::OK) << aligned.status.message;
  ASSERT_EQ(aligned.placements.size(), 2u);
  EXPECT_EQ(aligned.placements[1].session_id, "second");
  EXPECT_TRUE(aligned.left_out.empty());
  ASSERT_EQ(aligned.edges.size(), 1u);
  EXPECT_TRUE(aligned.edges[0].accepted);
  EXPECT_TRUE(aligned.edges[0].used);
  ASSERT_GE(aligned.edges[0].candidates.size(), 1u);
  EXPECT_LE(aligned.edges[0].candidates.size(), 3u);
  EXPECT_GT(aligned.edges[0].candidates[0].probability, 0.5);
  EXPECT_GT(aligned.edges[0].candidates[0].overlap_ratio, 0.5);
}

TEST_F(JobsTest, SecondGoalIsRefusedAndCancelLeavesTheStoreAsItWas)
{
  // A job may end before its cancel comes: then once more, on a session twice as long.
  constexpr int ATTEMPTS = 4;
  object_modelling::SegmentSessionResult result;
  Status second;
  std::string id;
  for (int attempt = 0; attempt < ATTEMPTS && result.status.code != Status::CANCELLED; ++attempt)
  {
    id = "long_" + std::to_string(attempt);
    record(store_, id, 20 << attempt);
    object_modelling::SegmentSessionGoal goal;
    goal.session_id = id;
    Job<object_modelling::SegmentSessionAction> first("segmenter/segment_session");
    first.send(goal);
    while (first.feedback_count == 0)
      ros::WallDuration(0.01).sleep();
    second = segment(id).status;
    first.cancel();
    result = first.wait();
  }
  ASSERT_EQ(result.status.code, Status::CANCELLED) << "no cancel of " << ATTEMPTS << " came in time";
  EXPECT_EQ(second.code, Status::FAILED_PRECONDITION) << second.message;
  EXPECT_NE(second.message.find("busy with 'segment " + id + "'"), std::string::npos) << second.message;
  for (const int keyframe_id : store_.keyframeIds(id))
    EXPECT_TRUE(store_.keyframe(id, keyframe_id).frame.object_mask.empty());
  EXPECT_FALSE(store_.session(id).segmented.done());
  const auto progress =
      ros::topic::waitForMessage<object_modelling::Progress>("segmenter/progress", node_, ros::Duration(PATIENCE_S));
  ASSERT_TRUE(progress);
  EXPECT_FALSE(progress->active);
  EXPECT_EQ(progress->status.code, Status::CANCELLED);
}

}  // namespace object_modelling::nodes

int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_jobs");
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
