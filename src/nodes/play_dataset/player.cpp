#include "player.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include <ros/init.h>

#include "object_modelling/ros_bridge/time_conversion.h"

namespace object_modelling::nodes
{
namespace
{
constexpr double POLL_PERIOD_S = 0.05;
// roscpp drops what is still in its queues when a node ends, and does not report when they are empty.
constexpr double LINGER_S = 0.5;

/// A player passes on what was recorded; only what is no frame at all is left out.
rgbd::FrameBuilderOptions passThrough(const PlayOptions& options)
{
  rgbd::FrameBuilderOptions builder;
  builder.max_stamp_difference_s = options.source.bag.max_stamp_difference_s;
  builder.min_depth_ratio = 0;
  builder.min_depth_m = 0;
  builder.max_depth_m = 100;
  return builder;
}
}  // namespace

Player::Player(ros::NodeHandle& node, const PlayOptions& options)
    : options_(options),
      source_(ros_bridge::openRecording(options.recording, options.source)),
      builder_(passThrough(options)),
      publisher_(node, source_->frameId())
{
  if (options.lossless)
    gate_ = std::make_unique<LosslessGate>(node, options.tracker_state);
}

void Player::waitForListeners()
{
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(options_.wait_s);
  const auto ready = [this] { return publisher_.connected() && (!gate_ || gate_->connected()); };
  // A listener that has connected to some of the topics only would never see the first frame whole.
  while (ros::ok() && !(ready() && publisher_.allConnected()) && ros::WallTime::now() < deadline)
    ros::WallDuration(POLL_PERIOD_S).sleep();
  if (ready() || !ros::ok())
    return;
  std::ostringstream waited;
  waited << " after " << options_.wait_s << " s; is the camera tracker running and remapped?";
  if (gate_)
    throw base::Error(base::StatusCode::TIMEOUT,
                      "--lossless: nobody takes the images or publishes " + gate_->topic() + waited.str());
  ROS_WARN("nobody takes the images%s Playing all the same.", waited.str().c_str());
}

void Player::waitUntilDue(double stamp_s)
{
  if (gate_ || first_stamp_s_ < 0)
    return;
  const ros::WallTime due = began_ + ros::WallDuration((stamp_s - first_stamp_s_) / options_.rate_ratio);
  while (ros::ok() && ros::WallTime::now() < due)
    ros::WallDuration(std::min(POLL_PERIOD_S, (due - ros::WallTime::now()).toSec())).sleep();
}

void Player::send(const rgbd::RawFrame& raw)
{
  const base::Result<rgbd::Frame> frame = builder_.build(raw);
  if (!frame.ok())
  {
    ++refused_count_;
    ROS_WARN("frame %.6f of %s is left out: %s", raw.stamp_s, source_->name().c_str(), frame.status.message.c_str());
    return;
  }
  const double stamp_s = raw.stamp_s + stamp_shift_s_;
  waitUntilDue(stamp_s);
  if (!ros::ok())
    return;
  if (first_stamp_s_ < 0)
    first_stamp_s_ = stamp_s;
  else if (played_count_ == 1)
    frame_period_s_ = stamp_s - last_stamp_s_;
  last_stamp_s_ = stamp_s;
  const ros::Time stamp = ros_bridge::toTime(stamp_s);
  publisher_.publish(frame.value, stamp, ros_bridge::toTime(raw.depth_stamp_s + stamp_shift_s_), raw.camera);
  ++played_count_;
  if (!gate_ || gate_->waitFor(stamp, options_.answer_timeout_s) || !ros::ok())
    return;
  std::ostringstream text;
  text << "--lossless: no answer on " << gate_->topic() << " to frame " << played_count_ << " (stamp " << stamp
       << ") within " << options_.answer_timeout_s << " s; in object mode the tracker needs a mask for each frame";
  throw base::Error(base::StatusCode::TIMEOUT, text.str());
}

void Player::playOnce()
{
  while (ros::ok())
  {
    const std::optional<rgbd::RawFrame> raw = source_->next();
    if (!raw)
      return;
    send(*raw);
  }
}

std::string Player::play()
{
  waitForListeners();
  began_ = ros::WallTime::now();
  playOnce();
  while (options_.loop && ros::ok() && played_count_ > 0)
  {
    source_ = ros_bridge::openRecording(options_.recording, options_.source);
    stamp_shift_s_ = last_stamp_s_ - first_stamp_s_ + frame_period_s_;
    playOnce();
  }
  const double played_s = (ros::WallTime::now() - began_).toSec();
  if (ros::ok())
    ros::WallDuration(LINGER_S).sleep();
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "played " << played_count_ << " frames of " << source_->name() << " in "
       << played_s << " s";
  if (refused_count_ > 0)
    text << ", left out " << refused_count_;
  return text.str();
}

}  // namespace object_modelling::nodes
