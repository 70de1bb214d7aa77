#include "frame_pairer.h"

#include <algorithm>
#include <cmath>

namespace object_modelling::nodes
{
namespace
{
/// Images that wait for a partner: as many as a subscriber's queue holds, since each topic has its own connection and a
/// burst of one may come before that of the other.
constexpr std::size_t MAX_UNPAIRED = 30;
/// Pairs that wait for their mask, which a segmenter makes from them.
constexpr std::size_t MAX_WAITING = 30;

double difference_s(const sensor_msgs::Image::ConstPtr& a, const sensor_msgs::Image::ConstPtr& b)
{
  return std::abs((a->header.stamp - b->header.stamp).toSec());
}

void dropUpTo(const ros::Time& stamp, std::deque<sensor_msgs::Image::ConstPtr>* images)
{
  images->erase(
      std::remove_if(images->begin(), images->end(), [&](const auto& image) { return image->header.stamp <= stamp; }),
      images->end());
}
}  // namespace

FramePairer::FramePairer(double max_stamp_difference_s, bool with_masks)
    : max_stamp_difference_s_(max_stamp_difference_s), with_masks_(with_masks)
{
}

std::optional<FrameMessages> FramePairer::addColor(const sensor_msgs::Image::ConstPtr& message)
{
  pair(message, true);
  return takeComplete();
}

std::optional<FrameMessages> FramePairer::addDepth(const sensor_msgs::Image::ConstPtr& message)
{
  pair(message, false);
  return takeComplete();
}

std::optional<FrameMessages> FramePairer::addInfo(const sensor_msgs::CameraInfo::ConstPtr& message)
{
  info_ = message;
  return takeComplete();
}

std::optional<FrameMessages> FramePairer::addMask(const sensor_msgs::Image::ConstPtr& message)
{
  masks_.push_back(message);
  if (masks_.size() > MAX_WAITING)
    masks_.pop_front();
  return takeComplete();
}

std::size_t FramePairer::takeSkippedCount()
{
  const std::size_t count = skipped_count_;
  skipped_count_ = 0;
  return count;
}

void FramePairer::pair(const sensor_msgs::Image::ConstPtr& message, bool is_color)
{
  Images& own = is_color ? colors_ : depths_;
  Images& others = is_color ? depths_ : colors_;
  const auto partner = std::min_element(others.begin(), others.end(),
                                        [&](const auto& a, const auto& b)
                                        { return difference_s(a, message) < difference_s(b, message); });
  // The rounding of stamps in seconds is below a microsecond.
  if (partner == others.end() || difference_s(*partner, message) > max_stamp_difference_s_ + 1e-6)
  {
    if (partner != others.end())
      unpaired_difference_s_ = difference_s(*partner, message);
    own.push_back(message);
    if (own.size() > MAX_UNPAIRED)
      own.pop_front();
    return;
  }
  FrameMessages frame;
  frame.color = is_color ? message : *partner;
  frame.depth = is_color ? *partner : message;
  dropUpTo(frame.color->header.stamp, &colors_);
  dropUpTo(frame.depth->header.stamp, &depths_);
  waiting_.push_back(frame);
  if (waiting_.size() > MAX_WAITING)
  {
    waiting_.pop_front();
    ++skipped_count_;
  }
}

sensor_msgs::Image::ConstPtr FramePairer::maskOf(const FrameMessages& frame) const
{
  const auto found = std::find_if(masks_.begin(), masks_.end(),
                                  [&](const auto& mask) { return mask->header.stamp == frame.color->header.stamp; });
  return found == masks_.end() ? sensor_msgs::Image::ConstPtr() : *found;
}

std::optional<FrameMessages> FramePairer::takeComplete()
{
  if (!info_)
    return {};
  for (std::size_t i = waiting_.size(); i-- > 0;)
  {
    FrameMessages frame = waiting_[i];
    if (with_masks_)
      frame.object_mask = maskOf(frame);
    if (with_masks_ && !frame.object_mask)
      continue;
    frame.info = info_;
    skipped_count_ += i;
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    dropUpTo(frame.color->header.stamp, &masks_);
    return frame;
  }
  return {};
}

}  // namespace object_modelling::nodes
