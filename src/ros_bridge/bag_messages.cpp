#include "bag_messages.h"

#include <algorithm>
#include <vector>

namespace object_modelling::ros_bridge
{
namespace
{
/// Images held back while their partner has not come; more means that there is none (a gap in one topic).
constexpr std::size_t MAX_WAITING = 60;

ros::Duration distance(const ros::Time& a, const ros::Time& b)
{
  return a > b ? a - b : b - a;
}
}  // namespace

BagMessages::BagMessages(rosbag::Bag& bag, const BagTopics& topics, double max_stamp_difference_s)
    : topics_(topics), max_difference_(max_stamp_difference_s)
{
  std::vector<std::string> used = { topics.color, topics.depth, topics.camera_info };
  if (!topics.object_mask.empty())
    used.push_back(topics.object_mask);
  color_count_ = rosbag::View(bag, rosbag::TopicQuery(topics.color)).size();
  rosbag::View infos(bag, rosbag::TopicQuery(topics.camera_info));
  if (infos.size() > 0)
    info_ = infos.begin()->instantiate<sensor_msgs::CameraInfo>();
  view_ = std::make_unique<rosbag::View>(bag, rosbag::TopicQuery(used));
  position_ = view_->begin();
}

void BagMessages::readOne()
{
  const rosbag::MessageInstance instance = *position_;
  ++position_;
  if (instance.getTopic() == topics_.camera_info)
  {
    if (const auto info = instance.instantiate<sensor_msgs::CameraInfo>())
      info_ = info;
    return;
  }
  const auto image = instance.instantiate<sensor_msgs::Image>();
  if (!image)
    return;
  if (instance.getTopic() == topics_.color)
    colors_.push_back(image);
  else if (instance.getTopic() == topics_.depth)
    depths_.push_back(image);
  else
    masks_.push_back(image);
}

bool BagMessages::decided() const
{
  if (position_ == view_->end() || colors_.size() > MAX_WAITING || depths_.size() > MAX_WAITING)
    return true;
  // Receipt order is stamp order to within the latency of a driver: later images can no longer be the nearest.
  const auto passed = [](const auto& images, const ros::Time& stamp)
  { return !images.empty() && images.back()->header.stamp > stamp; };
  if (colors_.empty())
    return false;
  const ros::Time limit = colors_.front()->header.stamp + max_difference_;
  return passed(depths_, limit) && passed(colors_, limit);
}

sensor_msgs::Image::ConstPtr BagMessages::takeDepth(const ros::Time& stamp)
{
  const auto nearest = std::min_element(depths_.begin(), depths_.end(),
                                        [&](const auto& a, const auto& b) {
                                          return distance(a->header.stamp, stamp) < distance(b->header.stamp, stamp);
                                        });
  if (nearest == depths_.end() || distance((*nearest)->header.stamp, stamp) > max_difference_)
    return {};
  sensor_msgs::Image::ConstPtr depth = *nearest;
  depths_.erase(depths_.begin(), nearest + 1);
  return depth;
}

sensor_msgs::Image::ConstPtr BagMessages::takeMask(const ros::Time& stamp)
{
  while (!masks_.empty() && masks_.front()->header.stamp < stamp)
    masks_.pop_front();
  return !masks_.empty() && masks_.front()->header.stamp == stamp ? masks_.front() : sensor_msgs::Image::ConstPtr();
}

bool BagMessages::next(BagInstant* instant)
{
  while (true)
  {
    while (!decided())
      readOne();
    if (colors_.empty() && position_ == view_->end())
      return false;
    if (colors_.empty())
    {
      depths_.pop_front();
      continue;
    }
    instant->color = colors_.front();
    colors_.pop_front();
    instant->depth = takeDepth(instant->color->header.stamp);
    instant->object_mask = takeMask(instant->color->header.stamp);
    instant->info = info_;
    if (instant->depth)
      return true;
    while (!depths_.empty() && depths_.front()->header.stamp + max_difference_ < instant->color->header.stamp)
      depths_.pop_front();
  }
}

}  // namespace object_modelling::ros_bridge
