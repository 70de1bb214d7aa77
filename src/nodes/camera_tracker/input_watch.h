#pragma once

#include <string>
#include <vector>

#include <ros/time.h>

namespace object_modelling::nodes
{
/// Notices inputs that are silent and images that never pair. Times are of the wall clock, since the camera's may
/// stand still. Not thread safe.
class InputWatch
{
public:
  InputWatch(double timeout_s, const ros::WallTime& started);

  /// Watches a topic; the index stands for it from then on.
  std::size_t add(const std::string& topic);
  void heard(std::size_t topic, const ros::WallTime& now);
  void gotFrame(const ros::WallTime& now) { last_frame_ = now; }

  /// Names the topics that have been silent for longer than the timeout; empty if none.
  std::string silentTopics(const ros::WallTime& now) const;
  /// Whether a frame has come within the timeout. As long as they come, a silent topic is no problem (a camera_info
  /// that is published once).
  bool framesCome(const ros::WallTime& now) const { return now - last_frame_ <= timeout_; }

private:
  struct Topic
  {
    std::string name;
    ros::WallTime last;
    bool ever = false;
  };

  ros::WallDuration timeout_;
  ros::WallTime last_frame_;
  std::vector<Topic> topics_;
};

}  // namespace object_modelling::nodes
