#include "object_modelling/segmentation/object_follower.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "cropped_frame.h"
#include "joint_motion.h"
#include "low_holes.h"
#include "object_modelling/base/options.h"
#include "pedestal.h"
#include "object_modelling/segmentation/smooth_clustering.h"
#include "support_around.h"

namespace object_modelling::segmentation
{
namespace
{
// Below this the best candidate is taken to be another thing than the object of the last frame.
constexpr double MIN_MASK_OVERLAP_RATIO = 0.2;
// After so many frames without it the object is chosen anew; the tracker sees whether it is the same.
constexpr int MAX_MISSES = 15;

/// Intersection over union of two masks of one size.
double overlapRatio(const cv::Mat& a, const cv::Mat& b)
{
  const int both = cv::countNonZero(a & b);
  const int either = cv::countNonZero(a | b);
  return either > 0 ? static_cast<double>(both) / either : 0.0;
}

/// The rectangle of a mask and as much round it as an object moves between frames, with table to see the support by.
cv::Rect surroundings(const cv::Mat& mask)
{
  const cv::Rect rect = cv::boundingRect(mask);
  const int margin_px = 20 + std::max(rect.width, rect.height) / 2;
  return cv::Rect(rect.x - margin_px, rect.y - margin_px, rect.width + 2 * margin_px, rect.height + 2 * margin_px) &
         cv::Rect(0, 0, mask.cols, mask.rows);
}

/// Of what stands on a plane within `area`, that which overlaps `wanted` (of the whole frame) most; empty where nothing
/// overlaps it enough.
cv::Mat standingOn(const rgbd::Frame& frame, const geometry::Plane& plane_camera, double noise_scale,
                   const cv::Rect& area, const cv::Mat& wanted, const SceneSegmenterOptions& options)
{
  const rgbd::Frame crop = cropped(frame, area);
  const HeightLimits limits{ options.min_height_m, options.height_noise_sigmas * noise_scale, options.max_height_m,
                             options.max_distance_m };
  const double area_ratio = static_cast<double>(frame.depth_m.total()) / (640.0 * 480.0);
  const int min_pixels = std::max(1, static_cast<int>(std::lround(options.min_cluster_px * area_ratio)));
  const cv::Mat above = pixelsAbove(crop, plane_camera, limits, options.cluster_depth_step_ratio);
  const Clusters clusters = clusterSmooth(crop, above, options.cluster_depth_step_ratio, min_pixels);
  double best_ratio = MIN_MASK_OVERLAP_RATIO;
  cv::Mat best;
  for (const Cluster& cluster : clusters.clusters)
  {
    const cv::Mat mask = clusters.mask(cluster);
    const double ratio = overlapRatio(mask, wanted(area));
    if (ratio > best_ratio)
    {
      best_ratio = ratio;
      best = mask;
    }
  }
  if (best.empty())
    return {};
  fillLowHoles(crop, plane_camera, options.min_height_m * noise_scale, options.max_height_m,
               cv::Rect(0, 0, area.width, area.height), &best);
  cv::Mat mask = cv::Mat::zeros(frame.depth_m.size(), CV_8UC1);
  best.copyTo(mask(area));
  return mask;
}
}  // namespace

std::vector<std::string> ObjectFollowerOptions::violations() const
{
  base::OptionsCheck check("object_follower");
  check.include(segmenter.violations());
  check.inRange("max_turntable_size_m", max_turntable_size_m, 0.0, 5.0);
  return check.violations();
}

cv::Mat findTurntable(const rgbd::Frame& frame, double max_size_m)
{
  const auto support = findSupportAround(frame, frame.object_mask);
  if (!support)
    return {};
  PedestalOptions pedestal;
  pedestal.noise_scale = support->noise_scale;
  pedestal.max_size_m = max_size_m;
  return findPedestal(frame, support->plane_camera, frame.object_mask, pedestal);
}

ObjectFollower::ObjectFollower(const ObjectFollowerOptions& options)
    : options_(base::checked(options)), segmenter_(options.segmenter), joint_motion_(std::make_unique<JointMotion>())
{
}
ObjectFollower::~ObjectFollower() = default;

void ObjectFollower::reset()
{
  last_mask_.release();
  support_.reset();
  on_turntable_ = false;
  *joint_motion_ = {};
  misses_ = 0;
}

FollowedObject ObjectFollower::follow(const rgbd::Frame& frame)
{
  FollowedObject followed;
  if (last_mask_.size() != frame.depth_m.size())
    reset();
  if (!frame.object_mask.empty() && cv::countNonZero(frame.object_mask) == 0)
  {
    // Out of sight; where it was last is still where to look for it.
    followed.mask = frame.object_mask;
    return followed;
  }
  followed.mask = lookNear(frame);
  if (!frame.object_mask.empty())
  {
    const bool supported = !followed.mask.empty();
    last_mask_ = followed.mask = frame.object_mask;
    if (!supported)
    {
      // So it is where every frame brings its mask, and nothing has to be found.
      support_.reset();
      return followed;
    }
  }
  else if (followed.mask.empty())
  {
    const base::Result<cv::Mat> found = lookEverywhere(frame);
    followed.status = found.status;
    followed.mask = found.value;
  }
  if (!followed.status.ok())
  {
    if (++misses_ >= MAX_MISSES)
      reset();
    return followed;
  }
  misses_ = 0;
  last_mask_ = followed.mask;
  followed.turntable = turntableUnder(frame, *support_, last_mask_);
  on_turntable_ = !followed.turntable.empty();
  if (on_turntable_ && !joint_motion_->together(frame.gray, followed.mask, followed.turntable))
    followed.turntable.release();
  return followed;
}

cv::Mat ObjectFollower::lookNear(const rgbd::Frame& frame)
{
  if (!support_)
    return {};
  const cv::Rect area = surroundings(last_mask_);
  const auto local = refineSupport(cropped(frame, area), support_->plane_camera,
                                   cv::Rect(0, 0, area.width, area.height), last_mask_(area));
  if (!local)
    return {};
  cv::Mat mask = standingOn(frame, local->plane_camera, local->noise_scale, area, last_mask_, options_.segmenter);
  if (!mask.empty())
    support_ = Support{ local->plane_camera, local->noise_scale };
  return mask;
}

base::Result<cv::Mat> ObjectFollower::lookEverywhere(const rgbd::Frame& frame)
{
  const SceneSegmentation segmentation = segmenter_.segment(frame);
  if (!segmentation.status.ok())
    return { segmentation.status, {} };
  const Hypothesis* best = nullptr;
  if (last_mask_.empty())
  {
    const base::Result<int> chosen = selectAutomatically(segmentation, frame.camera);
    if (!chosen.ok())
      return { chosen.status, {} };
    best = &segmentation.hypotheses[static_cast<std::size_t>(chosen.value)];
  }
  else
  {
    double best_ratio = MIN_MASK_OVERLAP_RATIO;
    for (const Hypothesis& hypothesis : segmentation.hypotheses)
    {
      const double ratio = overlapRatio(hypothesis.mask, last_mask_);
      if (ratio > best_ratio)
      {
        best_ratio = ratio;
        best = &hypothesis;
      }
    }
    if (best == nullptr)
      return { { base::StatusCode::NO_RESULT,
                 "none of " + std::to_string(segmentation.hypotheses.size()) +
                     " hypotheses overlaps the object of the last frame: the object left the view or was covered" },
               {} };
  }
  const auto support = static_cast<std::size_t>(segmentation.support_plane);
  support_ = supportRound(frame, segmentation.planes[support].plane_camera, best->mask);
  for (std::size_t i = 0; i < segmentation.planes.size(); ++i)
  {
    const cv::Mat standing = i == support ? cv::Mat() : lookOnTurntable(frame, segmentation.planes[i], best->mask);
    if (!standing.empty())
      return { {}, standing };
  }
  return { {}, best->mask };
}

ObjectFollower::Support ObjectFollower::supportRound(const rgbd::Frame& frame, const geometry::Plane& plane_camera,
                                                     const cv::Mat& object)
{
  const auto local = refineSupport(frame, plane_camera, surroundings(object), object);
  return local ? Support{ local->plane_camera, local->noise_scale } : Support{ plane_camera, 1 };
}

cv::Mat ObjectFollower::lookOnTurntable(const rgbd::Frame& frame, const SupportedPlane& plane,
                                        const cv::Mat& hypothesis)
{
  constexpr double MIN_INSIDE_RATIO = 0.7;
  constexpr double MAX_TILT_COS = 0.985;  // 10 deg
  if (support_->plane_camera.normal.dot(plane.plane_camera.normal) < MAX_TILT_COS ||
      cv::countNonZero(plane.mask & hypothesis) < MIN_INSIDE_RATIO * plane.pixel_count)
    return {};
  const cv::Mat rest = hypothesis & ~plane.mask;
  const Support top = supportRound(frame, plane.plane_camera, rest);
  cv::Mat standing =
      standingOn(frame, top.plane_camera, top.noise_scale, surroundings(hypothesis), rest, options_.segmenter);
  if (standing.empty() || turntableUnder(frame, top, standing).empty())
    return {};
  support_ = top;
  return standing;
}

cv::Mat ObjectFollower::turntableUnder(const rgbd::Frame& frame, const Support& support, const cv::Mat& object) const
{
  // What has been seen to be a turntable stays one in the frame in which a hand hides half of its rim.
  constexpr double MAX_LEVEL_RATIO = 0.15;
  constexpr double MAX_LEVEL_RATIO_AGAIN = 0.4;
  if (options_.max_turntable_size_m <= 0)
    return {};
  PedestalOptions pedestal;
  pedestal.noise_scale = support.noise_scale;
  pedestal.max_size_m = options_.max_turntable_size_m;
  pedestal.max_level_ratio = on_turntable_ ? MAX_LEVEL_RATIO_AGAIN : MAX_LEVEL_RATIO;
  return findPedestal(frame, support.plane_camera, object, pedestal);
}

}  // namespace object_modelling::segmentation
