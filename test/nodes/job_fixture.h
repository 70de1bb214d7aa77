#pragma once

#include <atomic>
#include <string>
#include <vector>

#include <actionlib/client/simple_action_client.h>
#include <gtest/gtest.h>
#include <object_modelling/AlignAction.h>
#include <object_modelling/BuildAction.h>
#include <object_modelling/ListObjects.h>
#include <object_modelling/RefineAction.h>
#include <object_modelling/SegmentSessionAction.h>
#include <object_modelling/Status.h>
#include <ros/ros.h>

#include "object_modelling/ros_bridge/remote_session_store.h"
#include "service_call.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::nodes
{
using object_modelling::Status;

constexpr double PATIENCE_S = 20;
constexpr double JOB_S = 120;
const Eigen::Vector3d BOX_SIZE_M(0.08, 0.12, 0.2);

inline geometry::PinholeCamera smallCamera()
{
  return test_support::vgaCamera().scaled(0.5);
}

/// A session all round the first object of the scene, without masks.
inline void record(ros_bridge::RemoteSessionStore& store, const std::string& session_id, int keyframe_count,
                   const test_support::SyntheticScene& scene = test_support::boxOnTable(),
                   const std::string& object_id = "")
{
  keyframes::Session session;
  session.id = session_id;
  session.object_id = object_id;
  session.camera_frame_id = "camera_optical";
  store.createSession(session);
  if (keyframe_count == 0)
    return;
  for (rgbd::Keyframe& keyframe : test_support::renderKeyframes(
           scene, smallCamera(), test_support::orbitPoses(keyframe_count, { 0, 0, 0.1 }, 0.7, 0.6)))
  {
    keyframe.frame.object_mask.release();
    keyframe.frame.stamp_s = 100 + keyframe.id;
    store.addKeyframe(session_id, keyframe);
  }
}

template <typename Action>
class Job
{
public:
  ACTION_DEFINITION(Action)
  explicit Job(const std::string& name) : client_(name, true)
  {
    EXPECT_TRUE(client_.waitForServer(ros::Duration(PATIENCE_S))) << name;
  }
  Result run(const Goal& goal)
  {
    EXPECT_TRUE(client_.sendGoalAndWait(goal, ros::Duration(JOB_S)).isDone());
    const ResultConstPtr result = client_.getResult();
    EXPECT_TRUE(result);
    return result ? *result : Result();
  }
  void send(const Goal& goal)
  {
    client_.sendGoal(goal, {}, {}, [this](const FeedbackConstPtr&) { ++feedback_count; });
  }
  Result wait()
  {
    EXPECT_TRUE(client_.waitForResult(ros::Duration(JOB_S)));
    return *client_.getResult();
  }
  void cancel() { client_.cancelGoal(); }
  std::atomic<int> feedback_count{ 0 };

private:
  actionlib::SimpleActionClient<Action> client_;
};

inline object_modelling::BuildGoal buildGoal(const std::string& object_id, const std::string& session_id)
{
  object_modelling::BuildGoal goal;
  goal.object_id = object_id;
  goal.placements.resize(1);
  goal.placements[0].session_id = session_id;
  return goal;
}

class JobsTest : public ::testing::Test
{
protected:
  JobsTest() : store_(node_, { "keyframe_store", PATIENCE_S, PATIENCE_S }) {}

  object_modelling::SegmentSessionResult segment(const std::string& session_id)
  {
    object_modelling::SegmentSessionGoal goal;
    goal.session_id = session_id;
    return Job<object_modelling::SegmentSessionAction>("segmenter/segment_session").run(goal);
  }
  object_modelling::RefineResult refine(const std::vector<std::string>& session_ids,
                                        const std::string& node = "refiner",
                                        std::uint8_t method = object_modelling::RefineGoal::DEFAULT)
  {
    object_modelling::RefineGoal goal;
    goal.session_ids = session_ids;
    goal.method = method;
    return Job<object_modelling::RefineAction>(node + "/refine").run(goal);
  }
  object_modelling::AlignResult align(const std::vector<std::string>& session_ids)
  {
    object_modelling::AlignGoal goal;
    goal.session_ids = session_ids;
    return Job<object_modelling::AlignAction>("session_aligner/align").run(goal);
  }
  object_modelling::BuildResult build(const object_modelling::BuildGoal& goal,
                                      const std::string& node = "model_builder")
  {
    return Job<object_modelling::BuildAction>(node + "/build").run(goal);
  }
  object_modelling::ListObjects::Response list(const std::string& node = "model_builder")
  {
    object_modelling::ListObjects service;
    EXPECT_TRUE(ros::service::waitForService(node + "/list_objects", ros::Duration(PATIENCE_S)));
    EXPECT_TRUE(callService(node + "/list_objects", service));
    return service.response;
  }

  /// The response of one of the aligner's services.
  template <typename Service>
  const typename Service::Response& called(const std::string& name, Service& service)
  {
    EXPECT_TRUE(ros::service::waitForService("session_aligner/" + name, ros::Duration(PATIENCE_S)));
    EXPECT_TRUE(callService("session_aligner/" + name, service)) << name;
    return service.response;
  }

  ros::NodeHandle node_;
  ros_bridge::RemoteSessionStore store_;
};

#define EXPECT_STATUS(expected, part, actual)                             \
  EXPECT_EQ((actual).status.code, (expected)) << (actual).status.message; \
  EXPECT_NE((actual).status.message.find(part), std::string::npos) << (actual).status.message

}  // namespace object_modelling::nodes
