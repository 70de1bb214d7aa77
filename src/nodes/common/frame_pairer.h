#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

namespace object_modelling::nodes
{
/// Messages of one instant; `object_mask` is null where none is wanted.
struct FrameMessages
{
  sensor_msgs::Image::ConstPtr color, depth, object_mask;
  sensor_msgs::CameraInfo::ConstPtr info;
};

/// Joins the streams of a camera: colour with the depth nearest in stamp, the newest camera_info, and the mask of the
/// same stamp if masks are wanted. Unlike message_filters' ApproximateTime it gives a frame as soon as its last part is
/// there, not once the next frame has come: nothing waits for a frame longer than needed, and a recording can be played
/// frame by frame. Not thread safe.
class FramePairer
{
public:
  FramePairer(double max_stamp_difference_s, bool with_masks);

  /// Whether frames wait for their masks from now on.
  void setWithMasks(bool with_masks) { with_masks_ = with_masks; }

  /// Each gives the frame that this message completes, if any.
  std::optional<FrameMessages> addColor(const sensor_msgs::Image::ConstPtr& message);
  std::optional<FrameMessages> addDepth(const sensor_msgs::Image::ConstPtr& message);
  std::optional<FrameMessages> addInfo(const sensor_msgs::CameraInfo::ConstPtr& message);
  std::optional<FrameMessages> addMask(const sensor_msgs::Image::ConstPtr& message);

  /// Pairs that were given up because a later one was complete, since the last call.
  std::size_t takeSkippedCount();
  /// Pairs that wait for their mask or for a camera_info.
  std::size_t waitingCount() const { return waiting_.size(); }
  /// Stamp difference of the nearest colour and depth that did not pair; negative before there was one.
  double unpairedDifference_s() const { return unpaired_difference_s_; }

private:
  using Images = std::deque<sensor_msgs::Image::ConstPtr>;

  void pair(const sensor_msgs::Image::ConstPtr& message, bool is_color);
  std::optional<FrameMessages> takeComplete();
  sensor_msgs::Image::ConstPtr maskOf(const FrameMessages& frame) const;

  double max_stamp_difference_s_;
  bool with_masks_;
  Images colors_, depths_, masks_;
  sensor_msgs::CameraInfo::ConstPtr info_;
  std::deque<FrameMessages> waiting_;  ///< oldest first
  std::size_t skipped_count_ = 0;
  double unpaired_difference_s_ = -1;
};

}  // namespace object_modelling::nodes
