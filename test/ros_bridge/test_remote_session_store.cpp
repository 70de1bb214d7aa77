#include <algorithm>

#include <gtest/gtest.h>
#include <object_modelling/GetEncodedKeyframe.h>
#include <object_modelling/ListSessions.h>
#include <ros/ros.h>
#include <opencv2/imgproc.hpp>

#include "object_modelling/ros_bridge/noise_model_conversion.h"
#include "object_modelling/ros_bridge/remote_session_store.h"
#include "object_modelling/ros_bridge/session_conversion.h"
#include "support/temp_dir.h"
#include "support/thrown_status.h"

namespace object_modelling::ros_bridge
{
namespace
{
rgbd::Keyframe keyframeOf(int id)
{
  rgbd::Keyframe keyframe;
  keyframe.id = id;
  keyframe.frame.stamp_s = 100 + id;
  keyframe.frame.camera.width = 32;
  keyframe.frame.camera.height = 24;
  keyframe.frame.camera.fx = keyframe.frame.camera.fy = 30;
  keyframe.frame.camera.cx = 15.5;
  keyframe.frame.camera.cy = 11.5;
  keyframe.frame.color_bgr = cv::Mat(24, 32, CV_8UC3, cv::Scalar::all(10 + id));
  cv::cvtColor(keyframe.frame.color_bgr, keyframe.frame.gray, cv::COLOR_BGR2GRAY);
  keyframe.frame.depth_m = cv::Mat(24, 32, CV_32FC1, cv::Scalar(0.5));
  keyframe.frame.moving_mask = cv::Mat(24, 32, CV_8UC1, cv::Scalar(255));
  keyframe.T_session_camera.translation().x() = 0.1 * id;
  keyframe.observations = { { 1, { 2, 3 }, 0.5f } };
  return keyframe;
}

class RemoteSessionStoreTest : public ::testing::Test
{
protected:
  RemoteSessionStoreTest() : store_(node_, { "keyframe_store", 10, 20 })
  {
    keyframes::Session session;
    session.id = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    session.camera_frame_id = "cam";
    id_ = session.id;
    store_.createSession(session);
  }

  base::StatusCode codeOf(const std::function<void()>& body)
  {
    const base::Status status = test_support::statusOf(body);
    EXPECT_EQ(status.message.empty(), status.code == base::StatusCode::OK);
    return status.code;
  }

  ros::NodeHandle node_;
  RemoteSessionStore store_;
  std::string id_;
};

TEST_F(RemoteSessionStoreTest, KeyframesComeBack)
{
  EXPECT_TRUE(store_.available());
  store_.addKeyframe(id_, keyframeOf(0));
  store_.addKeyframe(id_, keyframeOf(1));
  EXPECT_EQ((std::vector<int>{ 0, 1 }), store_.keyframeIds(id_));
  const rgbd::Keyframe keyframe = store_.keyframe(id_, 1);
  EXPECT_EQ(11, keyframe.frame.color_bgr.at<cv::Vec3b>(5, 5)[1]);
  EXPECT_NEAR(0.5, keyframe.frame.depthAt_m(5, 5), 1e-4);
  EXPECT_NEAR(0.1, keyframe.T_session_camera.translation().x(), 1e-12);
  EXPECT_EQ(1u, keyframe.observations.size());
  EXPECT_EQ(2, store_.session(id_).keyframe_count);
}

TEST_F(RemoteSessionStoreTest, Updates)
{
  store_.addKeyframe(id_, keyframeOf(0));
  Eigen::Isometry3d T_session_camera = Eigen::Isometry3d::Identity();
  T_session_camera.translation().z() = 0.25;
  store_.update(id_, keyframes::SessionChange::ofPoses({ { 0, T_session_camera, geometry::Matrix6d::Identity() } }));
  store_.update(id_, keyframes::SessionChange::ofMasks({ { 0, cv::Mat(24, 32, CV_8UC1, cv::Scalar(255)) } }));
  const rgbd::Keyframe keyframe = store_.keyframe(id_, 0);
  EXPECT_EQ(24 * 32, cv::countNonZero(keyframe.frame.moving_mask));
  EXPECT_EQ(0.25, keyframe.T_session_camera.translation().z());
  EXPECT_EQ(24 * 32, cv::countNonZero(keyframe.frame.object_mask));

  keyframes::Session session = store_.session(id_);
  EXPECT_EQ("cam", session.camera_frame_id);
  session.object_id = "mug";
  session.closed = true;
  session.T_model_session = T_session_camera;
  session.calibration.noise_model.axial_constant_m = 0.002;
  session.refinement_report = "refined";
  session.support_plane_session = geometry::Plane();
  store_.update(session.id, keyframes::SessionChange::toAllOf(session));
  session = store_.session(id_);
  EXPECT_EQ("mug", session.object_id);
  EXPECT_TRUE(session.closed && session.T_model_session && session.support_plane_session);
  EXPECT_EQ(0.002, session.calibration.noise_model.axial_constant_m);
  EXPECT_EQ("refined", session.refinement_report);
  EXPECT_EQ(0.002, store_.keyframe(id_, 0).frame.noise_model.axial_constant_m);
}

TEST_F(RemoteSessionStoreTest, ChangesWhatIsSetAndAllOfIt)
{
  store_.addKeyframe(id_, keyframeOf(0));
  keyframes::SessionChange change;
  change.poses = { { 0, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.5)), geometry::Matrix6d::Identity() } };
  change.masks = { { 0, cv::Mat(24, 32, CV_8UC1, cv::Scalar(255)) } };
  change.support_plane_session = geometry::Plane{ Eigen::Vector3d(0, 0, -1), 0.7 };
  change.refined = keyframes::StageMark{ "both", "{}" };
  change.segmented = keyframes::StageMark{ keyframes::stage_mark::BY_HAND, "" };
  store_.update(id_, change);
  keyframes::Session session = store_.session(id_);
  EXPECT_EQ("both", session.refined.by);
  EXPECT_EQ("{}", session.refined.options);
  EXPECT_EQ(keyframes::stage_mark::BY_HAND, session.segmented.by);
  ASSERT_TRUE(session.support_plane_session);
  EXPECT_EQ(0.7, session.support_plane_session->offset_m);
  EXPECT_EQ("cam", session.camera_frame_id);
  EXPECT_EQ(0.5, store_.keyframe(id_, 0).T_session_camera.translation().z());
  EXPECT_EQ(24 * 32, cv::countNonZero(store_.keyframe(id_, 0).frame.object_mask));

  keyframes::SessionChange taken_away;
  taken_away.support_plane_session = std::optional<geometry::Plane>();
  taken_away.refined = keyframes::StageMark();
  store_.update(id_, taken_away);
  session = store_.session(id_);
  EXPECT_FALSE(session.support_plane_session || session.refined.done());
  EXPECT_TRUE(session.segmented.done());

  change.poses.push_back({ 7, Eigen::Isometry3d::Identity(), geometry::Matrix6d::Identity() });
  EXPECT_EQ(base::StatusCode::NOT_FOUND, codeOf([&] { store_.update(id_, change); }));
  EXPECT_FALSE(store_.session(id_).refined.done());
}

TEST_F(RemoteSessionStoreTest, PosesKeepTheirLastDigit)
{
  for (int id = 0; id < 5; ++id)
    store_.addKeyframe(id_, keyframeOf(id));
  std::vector<keyframes::PoseUpdate> poses;
  for (int id = 0; id < 5; ++id)
  {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(0.1 + id / 7.0, Eigen::Vector3d(1, id, -0.3).normalized()).toRotationMatrix();
    T.translation() = Eigen::Vector3d(1.0 / 3, 2.0 / 7, id / 11.0);
    poses.push_back({ id, T, geometry::Matrix6d::Constant(1.0 / 9) });
  }
  store_.update(id_, keyframes::SessionChange::ofPoses(poses));
  const std::vector<rgbd::Keyframe> loaded = keyframes::loadKeyframes(store_, id_);
  ASSERT_EQ(loaded.size(), poses.size());
  for (std::size_t i = 0; i < loaded.size(); ++i)
  {
    EXPECT_EQ(loaded[i].id, static_cast<int>(i));
    EXPECT_EQ(loaded[i].T_session_camera.matrix(), poses[i].T_session_camera.matrix());
    EXPECT_EQ(loaded[i].covariance, poses[i].covariance);
  }
  object_modelling::SessionChange sheared = toMessage(keyframes::SessionChange::ofPoses(poses));
  sheared.poses[1].session_from_camera[0] += 0.1;
  EXPECT_EQ(base::StatusCode::INVALID_ARGUMENT, codeOf([&] { fromMessage(sheared); }));
}

TEST_F(RemoteSessionStoreTest, ErrorsKeepTheirCode)
{
  keyframes::Session session;
  session.id = id_;
  EXPECT_EQ(base::StatusCode::FAILED_PRECONDITION, codeOf([&] { store_.createSession(session); }));
  session.id = "../x";
  EXPECT_EQ(base::StatusCode::INVALID_ARGUMENT, codeOf([&] { store_.createSession(session); }));
  EXPECT_EQ(base::StatusCode::NOT_FOUND, codeOf([&] { store_.session("nobody"); }));
  EXPECT_EQ(base::StatusCode::NOT_FOUND, codeOf([&] { store_.keyframe(id_, 99); }));
  EXPECT_EQ(base::StatusCode::NOT_FOUND, codeOf([&] { store_.addKeyframe("nobody", keyframeOf(0)); }));
  store_.addKeyframe(id_, keyframeOf(0));
  EXPECT_EQ(base::StatusCode::FAILED_PRECONDITION, codeOf([&] { store_.addKeyframe(id_, keyframeOf(0)); }));
}

TEST_F(RemoteSessionStoreTest, ExportDeleteImport)
{
  const test_support::TempDir folder;
  const std::string file = folder.path("session.sqlite");
  store_.addKeyframe(id_, keyframeOf(0));
  store_.exportSession(id_, file);
  store_.deleteSession(id_);
  EXPECT_EQ(base::StatusCode::NOT_FOUND, codeOf([&] { store_.session(id_); }));
  EXPECT_EQ(id_, store_.importSession(file));
  EXPECT_EQ(1, store_.session(id_).keyframe_count);
  const std::vector<keyframes::Session> sessions = store_.listSessions();
  EXPECT_TRUE(std::any_of(sessions.begin(), sessions.end(), [&](const auto& session) { return session.id == id_; }));
}

TEST_F(RemoteSessionStoreTest, AStoreThatIsNotThereIsATimeout)
{
  RemoteSessionStore nowhere(node_, { "no_such_node", 0.3, 1 });
  EXPECT_FALSE(nowhere.available());
  EXPECT_EQ(base::StatusCode::TIMEOUT, codeOf([&] { nowhere.listSessions(); }));
}

/// A store of its own that answers after a while; needs callbacks on another thread.
class SlowStore
{
public:
  SlowStore(ros::NodeHandle& node, double delay_s)
      : server_(node.advertiseService("slow_store/list_sessions",
                                      boost::function<bool(ListSessions::Request&, ListSessions::Response&)>(
                                          [delay_s](ListSessions::Request&, ListSessions::Response&)
                                          {
                                            ros::WallDuration(delay_s).sleep();
                                            return true;
                                          })))
  {
  }

private:
  ros::ServiceServer server_;
};

/// A store of its own with one keyframe of the given id.
class OtherStore
{
public:
  OtherStore(ros::NodeHandle& node, int keyframe_id)
      : server_(node.advertiseService(
            "other_store/get_encoded_keyframe",
            boost::function<bool(GetEncodedKeyframe::Request&, GetEncodedKeyframe::Response&)>(
                [keyframe_id](GetEncodedKeyframe::Request&, GetEncodedKeyframe::Response& response)
                {
                  response.keyframe.keyframe_id = keyframe_id;
                  response.keyframe.calibration = toMessage(rgbd::SensorCalibration());
                  return true;
                })))
  {
  }

private:
  ros::ServiceServer server_;
};

TEST_F(RemoteSessionStoreTest, AKeptConnectionOutlivesARestart)
{
  RemoteSessionStore remote(node_, { "other_store", 5, 5 });
  auto other = std::make_unique<OtherStore>(node_, 1);
  EXPECT_EQ(1, remote.encodedKeyframe("any", 0).id);
  EXPECT_EQ(1, remote.encodedKeyframe("any", 0).id);
  other.reset();
  other = std::make_unique<OtherStore>(node_, 2);
  EXPECT_EQ(2, remote.encodedKeyframe("any", 0).id);
}

TEST_F(RemoteSessionStoreTest, ASlowStoreIsATimeout)
{
  const SlowStore slow(node_, 2);
  RemoteSessionStore remote(node_, { "slow_store", 5, 0.3 });
  const ros::WallTime begin = ros::WallTime::now();
  EXPECT_EQ(base::StatusCode::TIMEOUT, codeOf([&] { remote.listSessions(); }));
  EXPECT_LT((ros::WallTime::now() - begin).toSec(), 1.8);
}

TEST_F(RemoteSessionStoreTest, ARestartedStoreIsFoundAgain)
{
  RemoteSessionStore remote(node_, { "slow_store", 0.5, 5 });
  {
    const SlowStore first(node_, 0);
    EXPECT_EQ(base::StatusCode::OK, codeOf([&] { remote.listSessions(); }));
  }
  EXPECT_EQ(base::StatusCode::TIMEOUT, codeOf([&] { remote.listSessions(); }));
  const SlowStore second(node_, 0);
  EXPECT_EQ(base::StatusCode::OK, codeOf([&] { remote.listSessions(); }));
}
}  // namespace
}  // namespace object_modelling::ros_bridge

int main(int argc, char** argv)
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_remote_session_store");
  const ros::NodeHandle node;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
