#include "object_modelling/source/trajectory_correction.h"

#include <algorithm>
#include <string>

#include "object_modelling/base/status.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::source
{
namespace
{
void checkInput(const std::vector<double>& stamps_s, std::size_t before_count, std::size_t after_count)
{
  const std::size_t count = stamps_s.size();
  if (before_count != count || after_count != count)
  {
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "trajectory correction: " + std::to_string(count) +
                                                              " keyframe stamps but " + std::to_string(before_count) +
                                                              " old and " + std::to_string(after_count) +
                                                              " new poses; give as many of each");
  }
  for (std::size_t i = 1; i < count; ++i)
  {
    if (!(stamps_s[i] > stamps_s[i - 1]))
    {
      throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                        "trajectory correction: keyframe stamp " + std::to_string(stamps_s[i]) + " s follows " +
                            std::to_string(stamps_s[i - 1]) + " s; sort the keyframes by time");
    }
  }
}

/// The way from a to b at `share` in [0, 1], rotation (slerp) and translation apart.
Eigen::Isometry3d between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double share)
{
  const Eigen::Quaterniond R_a(a.linear()), R_b(b.linear());
  return geometry::isometryFrom(R_a.slerp(share, R_b), (1 - share) * a.translation() + share * b.translation());
}

}  // namespace

std::vector<source::StampedPose> correctTrajectory(const std::vector<source::StampedPose>& live,
                                                   const std::vector<double>& keyframe_stamps_s,
                                                   const std::vector<Eigen::Isometry3d>& before,
                                                   const std::vector<Eigen::Isometry3d>& after)
{
  checkInput(keyframe_stamps_s, before.size(), after.size());
  if (keyframe_stamps_s.empty())
    return live;
  std::vector<source::StampedPose> corrected = live;
  for (source::StampedPose& frame : corrected)
  {
    // The frame's pose relative to a keyframe is the live one; so is its place behind the refined keyframe.
    const auto relative_to = [&](std::size_t k) { return after[k] * (before[k].inverse() * frame.T_map_camera); };
    const auto next = std::upper_bound(keyframe_stamps_s.begin(), keyframe_stamps_s.end(), frame.stamp_s);
    const std::size_t right = static_cast<std::size_t>(next - keyframe_stamps_s.begin());
    if (right == 0)
      frame.T_map_camera = relative_to(0);
    else if (right == keyframe_stamps_s.size())
      frame.T_map_camera = relative_to(right - 1);
    else
    {
      const double begin_s = keyframe_stamps_s[right - 1], end_s = keyframe_stamps_s[right];
      frame.T_map_camera =
          between(relative_to(right - 1), relative_to(right), (frame.stamp_s - begin_s) / (end_s - begin_s));
    }
  }
  return corrected;
}

}  // namespace object_modelling::source
