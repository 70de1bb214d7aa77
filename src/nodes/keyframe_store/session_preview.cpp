#include "session_preview.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "object_modelling/base/options.h"

namespace object_modelling::nodes
{
namespace
{
/// Samples kept of one keyframe; every stride-th pixel in both directions.
constexpr int SAMPLES_PER_KEYFRAME = 20000;

int strideFor(const cv::Mat& image)
{
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(image.total()) / SAMPLES_PER_KEYFRAME))));
}

std::uint64_t voxelOf(const Eigen::Vector3f& point, float voxel_size_m)
{
  constexpr int BITS = 21;
  constexpr std::int64_t HALF = std::int64_t(1) << (BITS - 1), MASK = (std::int64_t(1) << BITS) - 1;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key = (key << BITS) |
          static_cast<std::uint64_t>((static_cast<std::int64_t>(std::floor(point[axis] / voxel_size_m)) + HALF) & MASK);
  return key;
}
}  // namespace

std::vector<std::string> SessionPreviewOptions::violations() const
{
  base::OptionsCheck check("keyframe_store/preview");
  check.inRange("voxel_size_m", voxel_size_m, 0.0005, 0.1);
  check.positive("max_depth_m", max_depth_m);
  check.inRange("max_points", max_points, 1000, 10000000);
  check.inRange("max_keyframes", max_keyframes, 1, 10000);
  return check.violations();
}

SessionPreview::SessionPreview(const SessionPreviewOptions& options) : options_(base::checked(options))
{
}

void SessionPreview::show(const std::string& session_id)
{
  session_id_ = session_id;
  entries_.clear();
}

void SessionPreview::applyMask(const cv::Mat& object_mask, Entry* entry) const
{
  entry->masked = !object_mask.empty();
  if (entry->masked && (object_mask.cols != entry->view.camera.width || object_mask.rows != entry->view.camera.height))
    return;
  for (Sample& sample : entry->samples)
    sample.on_object = entry->masked && object_mask.at<std::uint8_t>(sample.v, sample.u) > 0;
}

void SessionPreview::add(const rgbd::Keyframe& keyframe)
{
  const rgbd::Frame& frame = keyframe.frame;
  Entry entry;
  entry.view = { frame.stamp_s, frame.camera, keyframe.T_session_camera };
  const int stride = strideFor(frame.depth_m);
  const bool sampled = static_cast<int>(entries_.size()) < options_.max_keyframes;
  for (int v = 0; sampled && v < frame.depth_m.rows; v += stride)
  {
    for (int u = 0; u < frame.depth_m.cols; u += stride)
    {
      if (!(frame.depthAt_m(u, v) <= options_.max_depth_m))
        continue;
      const cv::Vec3b& bgr = frame.color_bgr.at<cv::Vec3b>(v, u);
      entry.samples.push_back({ frame.point(u, v),
                                { bgr[2], bgr[1], bgr[0] },
                                static_cast<std::int16_t>(u),
                                static_cast<std::int16_t>(v),
                                false });
    }
  }
  applyMask(frame.object_mask, &entry);
  entries_[keyframe.id] = std::move(entry);
}

void SessionPreview::move(const std::vector<keyframes::PoseUpdate>& updates)
{
  for (const keyframes::PoseUpdate& update : updates)
  {
    const auto found = entries_.find(update.keyframe_id);
    if (found != entries_.end())
      found->second.view.T_session_camera = update.T_session_camera;
  }
}

void SessionPreview::mask(const std::vector<keyframes::MaskUpdate>& updates)
{
  for (const keyframes::MaskUpdate& update : updates)
  {
    const auto found = entries_.find(update.keyframe_id);
    if (found != entries_.end())
      applyMask(update.object_mask, &found->second);
  }
}

SessionPreview::Cloud SessionPreview::cloud() const
{
  const bool any_mask =
      std::any_of(entries_.begin(), entries_.end(), [](const auto& entry) { return entry.second.masked; });
  Cloud cloud;
  std::unordered_set<std::uint64_t> taken;
  for (const auto& [id, entry] : entries_)
  {
    const Eigen::Isometry3f T_session_camera = entry.view.T_session_camera.cast<float>();
    for (const Sample& sample : entry.samples)
    {
      if (any_mask && !sample.on_object)
        continue;
      const Eigen::Vector3f p_session = T_session_camera * sample.p_camera;
      if (!taken.insert(voxelOf(p_session, static_cast<float>(options_.voxel_size_m))).second)
        continue;
      if (static_cast<int>(cloud.points_session.size()) >= options_.max_points)
        return cloud;
      cloud.points_session.push_back(p_session);
      cloud.colors_rgb.push_back(sample.color_rgb);
    }
  }
  return cloud;
}

std::vector<SessionPreview::View> SessionPreview::views() const
{
  std::vector<View> views;
  for (const auto& entry : entries_)
    views.push_back(entry.second.view);
  return views;
}

}  // namespace object_modelling::nodes
