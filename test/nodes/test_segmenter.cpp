// The segmenter over real topics and services, looking at a synthetic table with two boxes.
#include <actionlib/client/simple_action_client.h>
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <object_modelling/ClearSelection.h>
#include <object_modelling/Keyframe.h>
#include <object_modelling/ObjectMask.h>
#include <object_modelling/Segment.h>
#include <object_modelling/SegmentSessionAction.h>
#include <object_modelling/SelectHypothesis.h>
#include <object_modelling/SetRoi.h>
#include <object_modelling/Status.h>
#include <ros/ros.h>

#include "object_modelling/ros_bridge/frame_publisher.h"
#include "object_modelling/ros_bridge/image_conversion.h"
#include "object_modelling/ros_bridge/keyframe_conversion.h"
#include "service_call.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::nodes
{
namespace
{
using test_support::SyntheticScene;

const char* const FRAME_ID = "camera_optical";
const Eigen::Vector3d TARGET(0, 0, 0.06);
constexpr double PATIENCE_S = 10;

SyntheticScene twoBoxes()
{
  SyntheticScene scene;
  scene.objects = { test_support::standingBox({ 0.08, 0.08, 0.14 }, 0, 0.12),
                    test_support::standingBox({ 0.1, 0.06, 0.1 }, 0, -0.12, 0.3, 7) };
  return scene;
}

rgbd::Frame viewOf(const SyntheticScene& scene, double azimuth_rad = 0)
{
  rgbd::Frame frame = test_support::renderFrame(scene, test_support::vgaCamera(),
                                                test_support::orbitPose(TARGET, 0.7, azimuth_rad, 0.7));
  frame.object_mask.release();
  return frame;
}

class SegmenterTest : public ::testing::Test
{
protected:
  SegmenterTest() : publisher_(node_, FRAME_ID)
  {
    EXPECT_TRUE(ros::service::waitForService("segmenter/segment", ros::Duration(20)));
  }
  ~SegmenterTest() override
  {
    object_modelling::SetRoi off;
    call("set_roi", off);
    object_modelling::ClearSelection clear;
    call("clear", clear);
  }

  template <typename Service>
  int call(const std::string& name, Service& service)
  {
    EXPECT_TRUE(callService("segmenter/" + name, service)) << name;
    message_ = service.response.status.message;
    return service.response.status.code;
  }

  /// Shows a view to the segmenter until it has it.
  void show(const SyntheticScene& scene)
  {
    const rgbd::Frame frame = viewOf(scene);
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(PATIENCE_S);
    object_modelling::Segment segment;
    const ros::Time first = ros::Time::now();
    do
    {
      const ros::Time stamp = ros::Time::now();
      publisher_.publish(frame, stamp, stamp, frame.camera);
      ros::WallDuration(0.1).sleep();
      call("segment", segment);
    } while (segment.response.hypotheses.header.stamp < first && ros::WallTime::now() < end);
    ASSERT_GE(segment.response.hypotheses.header.stamp, first) << segment.response.status.message;
    hypotheses_ = segment.response.hypotheses;
  }

  object_modelling::SelectHypothesis by(std::uint8_t method)
  {
    object_modelling::SelectHypothesis select;
    select.request.method = method;
    return select;
  }

  ros::NodeHandle node_;
  ros_bridge::FramePublisher publisher_;
  object_modelling::Hypotheses hypotheses_;
  std::string message_;
};

using Request = object_modelling::SelectHypothesis::Request;
using object_modelling::Status;
}  // namespace

TEST_F(SegmenterTest, ANoFrame)  // first, before anything is published
{
  object_modelling::Segment segment;
  EXPECT_EQ(call("segment", segment), Status::FAILED_PRECONDITION);
  EXPECT_NE(message_.find("/rgb/image_rect_color"), std::string::npos) << message_;
  EXPECT_NE(message_.find("/rgb/camera_info"), std::string::npos) << message_;
  object_modelling::SelectHypothesis select = by(Request::BY_ID);
  EXPECT_EQ(call("select", select), Status::FAILED_PRECONDITION);
  EXPECT_NE(message_.find("call segment first"), std::string::npos) << message_;
}

TEST_F(SegmenterTest, FindsBothBoxes)
{
  show(twoBoxes());
  ASSERT_EQ(hypotheses_.status.code, Status::OK) << hypotheses_.status.message;
  ASSERT_EQ(hypotheses_.hypotheses.size(), 2u);
  EXPECT_EQ(hypotheses_.header.frame_id, FRAME_ID);
  EXPECT_TRUE(hypotheses_.has_support_plane);
  EXPECT_EQ(hypotheses_.selected_id, -1);
  for (const object_modelling::ObjectHypothesis& hypothesis : hypotheses_.hypotheses)
  {
    EXPECT_NEAR(hypothesis.centroid.z, 0.7, 0.15);
    EXPECT_NEAR(hypothesis.box_size_m.z, 0.12, 0.03);
    EXPECT_EQ(static_cast<int>(hypothesis.cloud.width), hypothesis.pixel_count);
  }
}

TEST_F(SegmenterTest, SelectsByEachMethod)
{
  show(twoBoxes());
  ASSERT_EQ(hypotheses_.hypotheses.size(), 2u);
  for (const object_modelling::ObjectHypothesis& wanted : hypotheses_.hypotheses)
  {
    object_modelling::SelectHypothesis id = by(Request::BY_ID);
    id.request.id = wanted.id;
    EXPECT_EQ(call("select", id), Status::OK) << message_;

    object_modelling::SelectHypothesis point = by(Request::BY_POINT);
    point.request.point.header.frame_id = FRAME_ID;
    point.request.point.point = wanted.centroid;
    EXPECT_EQ(call("select", point), Status::OK) << message_;
    EXPECT_EQ(point.response.hypothesis.pixel_count, wanted.pixel_count);

    const geometry::PinholeCamera camera = test_support::vgaCamera();
    const Eigen::Vector2d pixel = camera.project({ wanted.centroid.x, wanted.centroid.y, wanted.centroid.z });
    object_modelling::SelectHypothesis at = by(Request::BY_PIXEL);
    at.request.u_px = static_cast<int>(pixel.x());
    at.request.v_px = static_cast<int>(pixel.y());
    EXPECT_EQ(call("select", at), Status::OK) << message_;
    EXPECT_EQ(at.response.hypothesis.pixel_count, wanted.pixel_count);
  }
  object_modelling::SelectHypothesis automatic = by(Request::AUTOMATIC);
  EXPECT_EQ(call("select", automatic), Status::OK) << message_;
  object_modelling::Segment segment;
  call("segment", segment);
  EXPECT_EQ(segment.response.hypotheses.selected_id, automatic.response.hypothesis.id);
}

TEST_F(SegmenterTest, WrongChoicesAreRefused)
{
  show(twoBoxes());
  object_modelling::SelectHypothesis id = by(Request::BY_ID);
  id.request.id = 9;
  EXPECT_EQ(call("select", id), Status::NOT_FOUND);
  object_modelling::SelectHypothesis pixel = by(Request::BY_PIXEL);  // the table's far corner
  EXPECT_NE(call("select", pixel), Status::OK);
  pixel.request.u_px = 100000;
  EXPECT_NE(call("select", pixel), Status::OK);
  object_modelling::SelectHypothesis point = by(Request::BY_POINT);
  EXPECT_EQ(call("select", point), Status::INVALID_ARGUMENT);
  EXPECT_NE(message_.find("frame_id is empty"), std::string::npos) << message_;
  point.request.point.header.frame_id = "nowhere";
  EXPECT_EQ(call("select", point), Status::FAILED_PRECONDITION);
  EXPECT_NE(message_.find("nowhere"), std::string::npos) << message_;
  point.request.point.header.frame_id = FRAME_ID;
  point.request.point.point.z = 5;
  EXPECT_EQ(call("select", point), Status::NO_RESULT);
  object_modelling::SelectHypothesis method = by(17);
  EXPECT_EQ(call("select", method), Status::INVALID_ARGUMENT);
}

TEST_F(SegmenterTest, NoPlaneAndNoObject)
{
  SyntheticScene floating = twoBoxes();
  floating.has_table = false;
  floating.objects = { test_support::standingSphere(0.15) };
  show(floating);
  EXPECT_EQ(hypotheses_.status.code, Status::NO_RESULT);
  EXPECT_FALSE(hypotheses_.status.message.empty());
  object_modelling::SelectHypothesis automatic = by(Request::AUTOMATIC);
  EXPECT_EQ(call("select", automatic), Status::NO_RESULT);

  SyntheticScene empty = twoBoxes();
  empty.objects.clear();
  show(empty);
  EXPECT_EQ(hypotheses_.status.code, Status::NO_RESULT);
  EXPECT_TRUE(hypotheses_.has_support_plane);
}

TEST_F(SegmenterTest, RegionOfInterest)
{
  show(twoBoxes());
  ASSERT_EQ(hypotheses_.hypotheses.size(), 2u);
  object_modelling::SetRoi roi;
  roi.request.enabled = true;
  roi.request.box.header.frame_id = FRAME_ID;
  roi.request.box.pose.position = hypotheses_.hypotheses[1].centroid;
  roi.request.box.pose.orientation.w = 1;
  EXPECT_EQ(call("set_roi", roi), Status::INVALID_ARGUMENT) << "no size";
  roi.request.size_m.x = roi.request.size_m.y = roi.request.size_m.z = 0.15;
  ASSERT_EQ(call("set_roi", roi), Status::OK) << message_;
  object_modelling::Segment segment;
  EXPECT_EQ(call("segment", segment), Status::OK);
  ASSERT_EQ(segment.response.hypotheses.hypotheses.size(), 1u);
  EXPECT_EQ(segment.response.hypotheses.hypotheses[0].pixel_count, hypotheses_.hypotheses[1].pixel_count);

  roi.request.box.pose.position.z = 4;
  ASSERT_EQ(call("set_roi", roi), Status::OK) << message_;
  EXPECT_EQ(call("segment", segment), Status::NO_RESULT);
  EXPECT_NE(message_.find("region of interest"), std::string::npos) << message_;
  roi.request.enabled = false;
  ASSERT_EQ(call("set_roi", roi), Status::OK);
  EXPECT_EQ(call("segment", segment), Status::OK);
}

TEST_F(SegmenterTest, ClickedPointSelectsAndIsShown)
{
  show(twoBoxes());
  ASSERT_EQ(hypotheses_.hypotheses.size(), 2u);
  ros::Publisher clicked = node_.advertise<geometry_msgs::PointStamped>("/clicked_point", 1);
  object_modelling::Hypotheses shown;
  const ros::Subscriber subscriber = node_.subscribe<object_modelling::Hypotheses>(
      "segmenter/hypotheses", 5, [&](const object_modelling::HypothesesConstPtr& message) { shown = *message; });
  geometry_msgs::PointStamped point;
  point.header.frame_id = FRAME_ID;
  point.point = hypotheses_.hypotheses[1].centroid;
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(PATIENCE_S);
  while (shown.selected_id != 1 && ros::WallTime::now() < end)
  {
    clicked.publish(point);
    ros::WallDuration(0.2).sleep();
    ros::spinOnce();
  }
  EXPECT_EQ(shown.selected_id, 1);
}

TEST_F(SegmenterTest, MasksFollowTheChosenObjectThroughKeyframes)
{
  const SyntheticScene scene = twoBoxes();
  ros::Publisher keyframes = node_.advertise<object_modelling::Keyframe>("keyframe", 10);
  std::vector<object_modelling::ObjectMask> masks;
  const ros::Subscriber subscriber = node_.subscribe<object_modelling::ObjectMask>(
      "segmenter/mask", 10, [&](const object_modelling::ObjectMaskConstPtr& mask) { masks.push_back(*mask); });
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(3 * PATIENCE_S);
  while ((keyframes.getNumSubscribers() == 0 || subscriber.getNumPublishers() == 0) && ros::WallTime::now() < end)
    ros::WallDuration(0.05).sleep();

  const Eigen::Isometry3d T_world_session = test_support::orbitPose(TARGET, 0.7, 0, 0.7);
  std::vector<cv::Mat> truth;
  for (int id = 0; id < 3; ++id)
  {
    const Eigen::Isometry3d T_world_camera = test_support::orbitPose(TARGET, 0.7, 0.2 * id, 0.7);
    const test_support::SceneImage image = test_support::renderScene(scene, test_support::vgaCamera(), T_world_camera);
    rgbd::Keyframe keyframe;
    keyframe.id = id;
    keyframe.frame = image.frame;
    keyframe.frame.object_mask.release();
    keyframe.frame.stamp_s = 100 + id;
    keyframe.T_session_camera = T_world_session.inverse() * T_world_camera;
    keyframes.publish(ros_bridge::toMessage(keyframe, "live", FRAME_ID));
    truth.push_back(image.instances);
  }
  while (masks.size() < 3 && ros::WallTime::now() < end)
  {
    ros::WallDuration(0.05).sleep();
    ros::spinOnce();
  }
  ASSERT_EQ(masks.size(), 3u);
  int instance = 0;
  for (const object_modelling::ObjectMask& message : masks)
  {
    EXPECT_EQ(message.session_id, "live");
    const cv::Mat mask = ros_bridge::maskFromMessage(message.mask) > 0;
    if (instance == 0)
      instance = cv::countNonZero(mask & (truth[0] == 1)) > cv::countNonZero(mask & (truth[0] == 2)) ? 1 : 2;
    const cv::Mat object = truth[static_cast<std::size_t>(message.keyframe_id)] == instance;
    EXPECT_GT(cv::countNonZero(mask & object), 0.9 * cv::countNonZero(mask | object)) << message.keyframe_id;
  }
}

TEST_F(SegmenterTest, StoreThatIsDownIsNamed)
{
  actionlib::SimpleActionClient<object_modelling::SegmentSessionAction> client("segmenter/segment_session", true);
  ASSERT_TRUE(client.waitForServer(ros::Duration(PATIENCE_S)));
  object_modelling::SegmentSessionGoal goal;
  goal.session_id = "s";
  client.sendGoalAndWait(goal, ros::Duration(PATIENCE_S));
  ASSERT_TRUE(client.getResult());
  EXPECT_EQ(client.getResult()->status.code, Status::TIMEOUT);
  EXPECT_NE(client.getResult()->status.message.find("keyframe_store"), std::string::npos);
}

}  // namespace object_modelling::nodes

int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_segmenter");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
