#include "surface_links.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "in_batches.h"
#include "link_consistency.h"
#include "object_modelling/base/statistics.h"
#include "object_modelling/bundle_adjustment/keyframe_linker.h"
#include "object_modelling/bundle_adjustment/pair_selection.h"
#include "object_modelling/registration/surface_alignment.h"
#include "object_modelling/rgbd/color_shift.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
constexpr double MIN_OVERLAP_RATIO = 0.4;
constexpr double MAX_VIEW_ANGLE_RAD = 0.7;
constexpr int MAX_PARTNERS = 4;
constexpr double OFFSET_STEP_PX = 1;  // beyond what interpolation and noise do
constexpr int DEPTH_STEP_PX = 16;
constexpr double PATCH_RATIO = 0.3;  // of the depth: half the field of view
// There and back again: more between them, and one of the two has slid.
constexpr double MAX_CONTRADICTION_M = 0.03;
constexpr double MAX_CONTRADICTION_RAD = 0.03;

std::vector<IndexPair> overlappingPairs(const std::vector<rgbd::Keyframe>& keyframes, bool object_only)
{
  KeyframeLinkerOptions options;
  options.object_only = object_only;
  options.max_view_angle_rad = MAX_VIEW_ANGLE_RAD;
  const int count = static_cast<int>(keyframes.size());
  std::vector<std::vector<std::pair<double, int>>> partners(keyframes.size());
  cv::parallel_for_(cv::Range(0, count),
                    [&](const cv::Range& range)
                    {
                      for (int a = range.start; a < range.end; ++a)
                        for (int b = 0; b < count; ++b)
                          if (a != b)
                            partners[a].emplace_back(-predictedOverlap(keyframes[a], keyframes[b], options), b);
                    });
  std::set<IndexPair> pairs;
  for (int a = 0; a < count; ++a)
  {
    if (a + 1 < count)
      pairs.insert({ a, a + 1 });
    std::sort(partners[a].begin(), partners[a].end());
    for (int i = 0; i < std::min<int>(MAX_PARTNERS, static_cast<int>(partners[a].size())); ++i)
      if (-partners[a][i].first >= MIN_OVERLAP_RATIO)
        pairs.insert(std::minmax(a, partners[a][i].second));
  }
  return { pairs.begin(), pairs.end() };
}

/// One pair in both directions; a link needs both to agree.
std::optional<SurfaceLink> linkPair(const std::vector<registration::SurfaceView>& views, const IndexPair& pair,
                                    const Eigen::Isometry3d& T_a_b_start, registration::SurfaceStart start)
{
  const auto [a, b] = pair;
  const auto forwards = registration::alignFrames(views[a], views[b], T_a_b_start, start);
  if (!forwards)
    return std::nullopt;
  const auto backwards = registration::alignFrames(views[b], views[a], T_a_b_start.inverse(), start);
  if (!backwards)
    return std::nullopt;
  const Eigen::Isometry3d round_trip = forwards->T_a_b * backwards->T_a_b;
  if (round_trip.translation().norm() > MAX_CONTRADICTION_M ||
      geometry::rotationAngle_rad(round_trip) > MAX_CONTRADICTION_RAD)
    return std::nullopt;
  // The mean of both. Their errors are strongly correlated, so its covariance is that of one; their difference is a
  // measure of the error that neither covariance contains.
  const geometry::Vector6d half =
      0.5 * geometry::vectorFromIsometry(backwards->T_a_b.inverse() * forwards->T_a_b.inverse());
  // The covariance grows by half half^T; in terms of the information, as that may leave directions free (Sherman and
  // Morrison).
  const geometry::Vector6d gain = forwards->information * half;
  SurfaceLink link;
  link.a = a;
  link.b = b;
  link.T_a_b = geometry::normalized(geometry::isometryFromVector(half) * forwards->T_a_b);
  link.information = forwards->information - gain * gain.transpose() / (1 + half.dot(gain));
  return link;
}

std::vector<registration::SurfaceView> viewsOf(const std::vector<rgbd::Keyframe>& keyframes,
                                               const Eigen::Vector2d& color_offset_px, bool object_only)
{
  std::vector<std::optional<registration::SurfaceView>> made(keyframes.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(keyframes.size())),
                    [&](const cv::Range& range)
                    {
                      for (int k = range.start; k < range.end; ++k)
                      {
                        rgbd::Frame frame = keyframes[k].frame;
                        if (!object_only)
                          frame.object_mask.release();
                        frame.gray = rgbd::ontoDepth(frame.gray, color_offset_px);
                        made[k].emplace(frame);
                      }
                    });
  std::vector<registration::SurfaceView> views;
  for (std::optional<registration::SurfaceView>& view : made)
    views.push_back(std::move(*view));
  return views;
}

/// Views with the colour images shifted to both sides along one axis.
struct ShiftedViews
{
  std::vector<registration::SurfaceView> back, forth;
};

/// Derivative of the link by the colour offset, by central differences: links of images shifted a little to both sides,
/// along x and along y. (Both sides, since interpolation smooths either alike.)
void findByColorOffset(const std::array<ShiftedViews, 2>& shifted, SurfaceLink* link)
{
  constexpr auto NEAR = registration::SurfaceStart::NEAR;
  for (int axis = 0; axis < 2; ++axis)
  {
    const std::optional<SurfaceLink> back = linkPair(shifted[axis].back, { link->a, link->b }, link->T_a_b, NEAR);
    const std::optional<SurfaceLink> forth = linkPair(shifted[axis].forth, { link->a, link->b }, link->T_a_b, NEAR);
    if (back && forth)
      link->by_color_offset.col(axis) =
          geometry::vectorFromIsometry(forth->T_a_b * back->T_a_b.inverse()) / (2 * OFFSET_STEP_PX);
  }
}
}  // namespace

std::vector<SurfaceLink> linkSurfaces(const std::vector<rgbd::Keyframe>& keyframes,
                                      const Eigen::Vector2d& color_offset_px, bool find_by_color_offset,
                                      bool object_only, base::JobControl& control)
{
  const auto usable = [](const rgbd::Keyframe& keyframe)
  { return !keyframe.frame.gray.empty() && keyframe.frame.gray.size() == keyframe.frame.depth_m.size(); };
  if (!std::all_of(keyframes.begin(), keyframes.end(), usable))
    return {};
  const std::vector<registration::SurfaceView> views = viewsOf(keyframes, color_offset_px, object_only);
  std::array<ShiftedViews, 2> shifted;
  for (int axis = 0; axis < 2 && find_by_color_offset; ++axis)
  {
    const Eigen::Vector2d step_px = OFFSET_STEP_PX * Eigen::Vector2d::Unit(axis);
    shifted[axis] = { viewsOf(keyframes, color_offset_px - step_px, object_only),
                      viewsOf(keyframes, color_offset_px + step_px, object_only) };
  }
  const std::vector<IndexPair> pairs = overlappingPairs(keyframes, object_only);
  std::vector<std::optional<SurfaceLink>> linked(pairs.size());
  const int count = static_cast<int>(pairs.size());
  inBatches("surface links", count, control,
            [&](int i)
            {
              const auto [a, b] = pairs[i];
              linked[i] =
                  linkPair(views, pairs[i], keyframes[a].T_session_camera.inverse() * keyframes[b].T_session_camera,
                           registration::SurfaceStart::ROUGH);
              if (!linked[i])
                return;
              linked[i]->color_offset_px = color_offset_px;
              if (find_by_color_offset)
                findByColorOffset(shifted, &*linked[i]);
            });
  std::vector<SurfaceLink> links;
  for (const std::optional<SurfaceLink>& link : linked)
    if (link)
      links.push_back(*link);
  return links;
}

PoseEdge edgeOfSurfaces(const SurfaceLink& link, const std::vector<rgbd::Keyframe>& keyframes)
{
  const rgbd::Frame& frame = keyframes[link.b].frame;
  std::vector<float> depths_m;
  for (int v = 0; v < frame.depth_m.rows; v += DEPTH_STEP_PX)
    for (int u = 0; u < frame.depth_m.cols; u += DEPTH_STEP_PX)
      if (frame.depthAt_m(u, v) > 0)
        depths_m.push_back(frame.depthAt_m(u, v));
  const double depth_m = depths_m.empty() ? 1 : base::median(&depths_m);
  PoseEdge edge;
  edge.a = link.a;
  edge.b = link.b;
  edge.T_a_b = link.T_a_b;
  edge.points_b = patchCorners(depth_m * Eigen::Vector3d::UnitZ(), PATCH_RATIO * depth_m);
  edge.sigma_m = DRIFT_RATIO * depth_m;
  return edge;
}

}  // namespace object_modelling::bundle_adjustment
