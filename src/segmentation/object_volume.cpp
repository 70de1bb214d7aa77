#include "object_volume.h"

#include <algorithm>
#include <cmath>

#include "noise_table.h"
#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::segmentation
{
namespace
{
/// Votes of a view in which a neighbour is separate from the object; a view in which they touch has one vote.
constexpr int NEIGHBOR_VOTES = 2;
}  // namespace

void ObjectVolume::clear()
{
  voxels_.clear();
  lookup_.clear();
  views_ = 0;
}

void ObjectVolume::clearVotes()
{
  for (Voxel& voxel : voxels_)
    voxel.votes_for = voxel.votes_against = 0;
}

void ObjectVolume::add(const rgbd::Keyframe& keyframe, const cv::Mat& mask)
{
  ++views_;
  for (int v = 0; v < mask.rows; ++v)
  {
    const auto* on = mask.ptr<std::uint8_t>(v);
    for (int u = 0; u < mask.cols; ++u)
    {
      if (on[u] == 0 || !std::isfinite(keyframe.frame.depthAt_m(u, v)))
        continue;
      const Eigen::Vector3i index = indexOf(keyframe.T_session_camera * keyframe.frame.point(u, v).cast<double>());
      const auto [entry, is_new] = lookup_.emplace(key(index), static_cast<int>(voxels_.size()));
      if (is_new)
        voxels_.push_back({ index, 0, 0, -1 });
      Voxel& voxel = voxels_[entry->second];
      if (voxel.last_view != views_)
      {
        voxel.last_view = views_;
        ++voxel.votes_for;
      }
    }
  }
}

double ObjectVolume::meanVotes(const rgbd::Keyframe& keyframe, const cv::Mat& mask) const
{
  double votes = 0;
  int count = 0;
  for (int v = 0; v < mask.rows; ++v)
  {
    const auto* on = mask.ptr<std::uint8_t>(v);
    for (int u = 0; u < mask.cols; ++u)
    {
      if (on[u] == 0)
        continue;
      ++count;
      const auto entry =
          lookup_.find(key(indexOf(keyframe.T_session_camera * keyframe.frame.point(u, v).cast<double>())));
      if (entry != lookup_.end())
        votes += voxels_[entry->second].votes_for - voxels_[entry->second].votes_against;
    }
  }
  return count > 0 ? votes / count : 0;
}

void ObjectVolume::removeContradicted(const rgbd::Keyframe& keyframe, const cv::Mat& others)
{
  const rgbd::Frame& frame = keyframe.frame;
  const std::shared_ptr<const NoiseTable> noise = NoiseTable::of(frame.noise_model);
  const Eigen::Isometry3d T_camera_session = keyframe.T_session_camera.inverse();
  for (Voxel& voxel : voxels_)
  {
    const Eigen::Vector3d p_camera = T_camera_session * centerOf(voxel);
    if (voxel.last_view == views_)
      continue;
    const geometry::Projection<double> at = geometry::projectionOf(frame.camera, p_camera, 0);
    if (!at.inside)
      continue;
    const double tolerance_m = 2 * voxel_size_m_ + 3 * noise->sigma_m(static_cast<float>(at.z_m), 0.7F);
    const rgbd::Visibility seen = rgbd::visibilityOf(at, frame.depth_m, tolerance_m);
    const bool seen_as_other =
        seen == rgbd::Visibility::ON && !others.empty() && others.at<std::uint8_t>(at.row, at.column) != 0;
    voxel.votes_against += seen_as_other ? NEIGHBOR_VOTES : seen == rgbd::Visibility::IN_FRONT ? 1 : 0;
  }
}

bool ObjectVolume::contains(const Eigen::Vector3d& p_session) const
{
  const Eigen::Vector3i center = indexOf(p_session);
  if (occupied(center))
    return true;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if ((x != 0 || y != 0 || z != 0) && occupied(center + Eigen::Vector3i(x, y, z)))
          return true;
  return false;
}

Eigen::Vector3d ObjectVolume::centroid() const
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Voxel& voxel : voxels_)
    if (voxel.occupied())
    {
      sum += centerOf(voxel);
      ++count;
    }
  return count > 0 ? (sum / count).eval() : sum;
}

cv::Rect ObjectVolume::areaInView(const rgbd::Keyframe& keyframe, double margin_m) const
{
  const rgbd::Frame& frame = keyframe.frame;
  const Eigen::Isometry3d T_camera_session = keyframe.T_session_camera.inverse();
  const Eigen::Vector2d focal_px(frame.camera.fx, frame.camera.fy);
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (const Voxel& voxel : voxels_)
  {
    if (!voxel.occupied())
      continue;
    const Eigen::Vector3d p_camera = T_camera_session * centerOf(voxel);
    if (p_camera.z() <= margin_m)
      continue;
    const Eigen::Vector2d pixel = frame.camera.project(p_camera);
    const Eigen::Vector2d margin_px = focal_px * (margin_m / p_camera.z());
    low = low.cwiseMin(pixel - margin_px);
    high = high.cwiseMax(pixel + margin_px);
  }
  const cv::Rect image(0, 0, frame.depth_m.cols, frame.depth_m.rows);
  low = low.cwiseMax(-1.0).cwiseMin(1e5);
  high = high.cwiseMin(1e5).cwiseMax(-1.0);
  if (low.x() >= high.x() || low.y() >= high.y())
    return {};
  const cv::Point corner(static_cast<int>(std::floor(low.x())), static_cast<int>(std::floor(low.y())));
  const cv::Point opposite(static_cast<int>(std::ceil(high.x())) + 1, static_cast<int>(std::ceil(high.y())) + 1);
  return cv::Rect(corner, opposite) & image;
}

std::uint64_t ObjectVolume::key(const Eigen::Vector3i& index)
{
  constexpr int OFFSET = 1 << 20;  // 21 bits per axis: +-5 km at 5 mm
  const auto bits = [](int i) { return static_cast<std::uint64_t>(i + OFFSET) & 0x1FFFFF; };
  return bits(index.x()) << 42 | bits(index.y()) << 21 | bits(index.z());
}

Eigen::Vector3i ObjectVolume::indexOf(const Eigen::Vector3d& p_session) const
{
  return (p_session / voxel_size_m_).array().floor().cast<int>();
}

Eigen::Vector3d ObjectVolume::centerOf(const Voxel& voxel) const
{
  return (voxel.index.cast<double>().array() + 0.5) * voxel_size_m_;
}

bool ObjectVolume::occupied(const Eigen::Vector3i& index) const
{
  const auto entry = lookup_.find(key(index));
  return entry != lookup_.end() && voxels_[entry->second].occupied();
}

}  // namespace object_modelling::segmentation
