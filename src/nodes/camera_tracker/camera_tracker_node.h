#pragma once

#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <object_modelling/ResetTracking.h>
#include <object_modelling/StartTracking.h>
#include <object_modelling/StopTracking.h>
#include <ros/node_handle.h>

#include "input_watch.h"
#include "newest_slot.h"
#include "robot_motion.h"
#include "tracking_publisher.h"

namespace object_modelling::nodes
{
/// The camera_tracker node: one callback thread pairs messages and answers services, a thread of its own tracks the
/// newest frame.
class CameraTrackerNode
{
public:
  CameraTrackerNode(ros::NodeHandle& node, ros::NodeHandle& private_node, const CameraTrackerNodeOptions& options);
  ~CameraTrackerNode();

private:
  /// `needed`: its silence is a problem.
  template <typename Message>
  ros::Subscriber subscribe(ros::NodeHandle& node, const char* topic,
                            std::optional<FrameMessages> (FramePairer::*add)(const boost::shared_ptr<const Message>&),
                            bool needed);
  template <typename Service>
  void serve(ros::NodeHandle& node, const char* name,
             void (CameraTrackerNode::*handler)(const typename Service::Request&, typename Service::Response&));

  void start(const StartTracking::Request& request, StartTracking::Response& response);
  void stop(const StopTracking::Request& request, StopTracking::Response& response);
  void reset(const ResetTracking::Request& request, ResetTracking::Response& response);

  /// Whether a frame is of no use without a mask from outside.
  bool waitsForMasks() const;
  void watchInputs();
  std::string inputProblem(const ros::WallTime& now) const;
  void trackFrames();

  CameraTrackerNodeOptions options_;
  ros_bridge::RemoteSessionStore store_;
  TrackingPublisher publisher_;
  SessionRecord record_;
  Recording recording_;
  RobotMotion robot_;
  FramePairer pairer_;
  InputWatch watch_;
  std::string last_problem_;
  ros::Time newest_stamp_;
  NewestSlot<FrameMessages> slot_;
  std::thread worker_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Subscriber mask_subscriber_;  ///< in object mode
  std::vector<ros::ServiceServer> servers_;
  ros::WallTimer watch_timer_;
};

}  // namespace object_modelling::nodes
