#include "object_modelling/segmentation/object_mask_propagator.h"

#include <algorithm>
#include <limits>

#include "low_holes.h"
#include "object_modelling/base/options.h"
#include "object_volume.h"
#include "object_modelling/segmentation/smooth_clustering.h"
#include "support_around.h"

namespace object_modelling::segmentation
{
namespace
{
/// Surroundings of the known volume that are looked at: an object's unseen part, and table to refine the support on.
constexpr double SURROUNDINGS_M = 0.10;

std::string describeKeyframe(const rgbd::Keyframe& keyframe)
{
  return "keyframe " + std::to_string(keyframe.id);
}

}  // namespace

class ObjectMaskPropagator::Implementation
{
public:
  explicit Implementation(const ObjectMaskPropagatorOptions& options)
      : options_(base::checked(options)), volume_(options.voxel_size_m)
  {
  }

  base::Status start(const rgbd::Keyframe& keyframe, const SceneSegmentation& segmentation, int hypothesis)
  {
    if (segmentation.support_plane < 0 || segmentation.support_plane >= static_cast<int>(segmentation.planes.size()))
      return { base::StatusCode::FAILED_PRECONDITION, "the segmentation of " + describeKeyframe(keyframe) +
                                                          " has no support plane: " + segmentation.status.message };
    if (hypothesis < 0 || hypothesis >= static_cast<int>(segmentation.hypotheses.size()))
      return { base::StatusCode::INVALID_ARGUMENT, "hypothesis " + std::to_string(hypothesis) + " is not among the " +
                                                       std::to_string(segmentation.hypotheses.size()) + " of " +
                                                       describeKeyframe(keyframe) };
    const cv::Mat& mask = segmentation.hypotheses[hypothesis].mask;
    if (mask.size() != keyframe.frame.depth_m.size())
      return { base::StatusCode::INVALID_ARGUMENT,
               "the segmentation is of another image size than " + describeKeyframe(keyframe) };
    volume_.clear();
    volume_.add(keyframe, mask);
    support_moments_ = {};
    support_session_ =
        geometry::transformed(keyframe.T_session_camera, segmentation.planes[segmentation.support_plane].plane_camera);
    const cv::Rect area = volume_.areaInView(keyframe, SURROUNDINGS_M);
    if (const auto local = refineSupport(keyframe.frame, supportIn(keyframe), area, mask))
      addSupport(keyframe, *local);
    return {};
  }

  bool started() const { return !volume_.empty(); }

  base::Result<cv::Mat> propagate(const rgbd::Keyframe& keyframe)
  {
    const View view = look(keyframe);
    if (!view.status.ok())
      return { view.status, {} };
    if (view.support)
      addSupport(keyframe, *view.support);
    volume_.add(keyframe, view.mask);
    volume_.removeContradicted(keyframe, view.others);
    return { {}, withinVolume(keyframe, view.mask) };
  }

  base::Result<cv::Mat> mask(const rgbd::Keyframe& keyframe) const
  {
    const View view = look(keyframe);
    if (!view.status.ok())
      return { view.status, {} };
    return { {}, withinVolume(keyframe, view.mask) };
  }

  /// Votes of all keyframes anew, now that the volume is complete.
  void recount(const std::vector<rgbd::Keyframe>& keyframes)
  {
    std::vector<View> views;
    for (const rgbd::Keyframe& keyframe : keyframes)
      views.push_back(look(keyframe));
    volume_.clearVotes();
    for (std::size_t i = 0; i < keyframes.size(); ++i)
      if (views[i].status.ok())
      {
        volume_.add(keyframes[i], views[i].mask);
        volume_.removeContradicted(keyframes[i], views[i].others);
      }
  }

  std::optional<geometry::Plane> supportPlane() const
  {
    return started() ? std::optional<geometry::Plane>(support_session_) : std::nullopt;
  }

private:
  struct View
  {
    base::Status status;
    std::optional<LocalSupport> support;
    cv::Mat mask;    ///< what belongs to the object here, by clusters
    cv::Mat others;  ///< what stands on the support and does not
  };

  geometry::Plane supportIn(const rgbd::Keyframe& keyframe) const
  {
    return geometry::transformed(keyframe.T_session_camera.inverse(), support_session_);
  }

  void addSupport(const rgbd::Keyframe& keyframe, const LocalSupport& support)
  {
    support_moments_.add(support.moments.transformed(keyframe.T_session_camera));
    support_moments_.fit(keyframe.T_session_camera.translation(), &support_session_);
  }

  View look(const rgbd::Keyframe& keyframe) const
  {
    View view;
    const rgbd::Frame& frame = keyframe.frame;
    const cv::Rect area = volume_.areaInView(keyframe, SURROUNDINGS_M);
    if (!started() || area.area() == 0)
    {
      view.status = started() ? base::Status(base::StatusCode::NO_RESULT,
                                             "the object is out of the view of " + describeKeyframe(keyframe))
                              : base::Status(base::StatusCode::FAILED_PRECONDITION,
                                             "no object has been chosen yet; call start() with a hypothesis first");
      return view;
    }
    geometry::Plane plane_camera = supportIn(keyframe);
    view.support = refineSupport(frame, plane_camera, area, {});
    const SceneSegmenterOptions& segmenter = options_.segmenter;
    HeightLimits limits{ segmenter.min_height_m, segmenter.height_noise_sigmas, segmenter.max_height_m,
                         std::numeric_limits<double>::infinity() };
    if (view.support)
    {
      plane_camera = view.support->plane_camera;
      limits.noise_sigmas *= view.support->noise_scale;
    }
    const double area_ratio = frame.depth_m.total() / (640.0 * 480.0);
    const int min_piece_px = std::max(1, static_cast<int>(segmenter.min_cluster_px * area_ratio / 10));
    const cv::Mat above = pixelsAbove(frame, plane_camera, limits, segmenter.cluster_depth_step_ratio, area);
    const Clusters clusters = clusterSmooth(frame, above, segmenter.cluster_depth_step_ratio, min_piece_px);
    chooseClusters(keyframe, plane_camera, clusters, &view);
    const double noise_scale = view.support ? view.support->noise_scale : 1;
    fillLowHoles(frame, plane_camera, noise_scale * segmenter.min_height_m, segmenter.max_height_m, area, &view.mask);
    if (cv::countNonZero(view.mask) < min_piece_px)
      view.status = { base::StatusCode::NO_RESULT,
                      "nothing of the object is seen in " + describeKeyframe(keyframe) + ": hidden, or without depth" };
    return view;
  }

  struct Part
  {
    cv::Mat mask;
    cv::Mat inside;  // the volume
    int inside_count = 0;
    double votes = 0;
    bool candidate = false;
  };

  /// Those clusters are the object that lie in its volume to a fair share, but for neighbours: clusters that stand on
  /// the support by themselves and have far fewer votes, since they came into the volume by touching the object in
  /// a view.
  void chooseClusters(const rgbd::Keyframe& keyframe, const geometry::Plane& plane_camera, const Clusters& clusters,
                      View* view) const
  {
    constexpr double MIN_SHARE_OF_OBJECT = 0.3;
    constexpr double NEIGHBOR_VOTES_RATIO = 0.75;
    std::vector<Part> parts;
    int inside_total = 0;
    double most_votes = 0;
    for (const Cluster& cluster : clusters.clusters)
    {
      Part part;
      part.mask = clusters.mask(cluster);
      part.inside = withinVolume(keyframe, part.mask);
      part.inside_count = cv::countNonZero(part.inside);
      part.candidate = part.inside_count >= options_.min_cluster_overlap_ratio * cluster.pixel_count;
      inside_total += part.inside_count;
      part.votes = part.candidate ? volume_.meanVotes(keyframe, part.inside) : 0;
      if (part.candidate && cluster.pixel_count >= MIN_SHARE_OF_OBJECT * clusters.clusters.front().pixel_count)
        most_votes = std::max(most_votes, part.votes);
      parts.push_back(part);
    }
    view->mask = cv::Mat::zeros(keyframe.frame.depth_m.size(), CV_8UC1);
    view->others = view->mask.clone();
    for (const Part& part : parts)
    {
      const bool neighbor = part.candidate && part.votes < NEIGHBOR_VOTES_RATIO * most_votes &&
                            standsOn(keyframe.frame, plane_camera, part.mask);
      if (part.candidate && !neighbor)
        view->mask |= part.mask;
      else if (!neighbor && part.inside_count >= MIN_SHARE_OF_OBJECT * inside_total)
        view->mask |= part.inside;  // the object has run together with something larger
      else
        view->others |= part.mask;
    }
  }

  /// Whether the lowest pixels of a mask are at the support.
  static bool standsOn(const rgbd::Frame& frame, const geometry::Plane& plane_camera, const cv::Mat& mask)
  {
    constexpr double MAX_FOOT_M = 0.015;
    constexpr double MIN_RATIO = 0.02;
    int count = 0, low = 0;
    for (int v = 0; v < mask.rows; ++v)
      for (int u = 0; u < mask.cols; ++u)
        if (mask.at<std::uint8_t>(v, u) != 0)
        {
          ++count;
          low += plane_camera.signedDistance_m(frame.point(u, v).cast<double>()) < MAX_FOOT_M;
        }
    return low > MIN_RATIO * count;
  }

  cv::Mat withinVolume(const rgbd::Keyframe& keyframe, const cv::Mat& mask) const
  {
    cv::Mat inside = cv::Mat::zeros(mask.size(), CV_8UC1);
    for (int v = 0; v < mask.rows; ++v)
    {
      const auto* from = mask.ptr<std::uint8_t>(v);
      auto* to = inside.ptr<std::uint8_t>(v);
      for (int u = 0; u < mask.cols; ++u)
        if (from[u] != 0 && volume_.contains(keyframe.T_session_camera * keyframe.frame.point(u, v).cast<double>()))
          to[u] = 255;
    }
    return inside;
  }

  ObjectMaskPropagatorOptions options_;
  ObjectVolume volume_;
  geometry::Plane support_session_;
  PlaneMoments support_moments_;  // in the session frame
};

std::vector<std::string> ObjectMaskPropagatorOptions::violations() const
{
  base::OptionsCheck check("object_mask_propagator");
  check.include(segmenter.violations());
  check.inRange("voxel_size_m", voxel_size_m, 0.001, 0.1);
  check.inRange("min_cluster_overlap_ratio", min_cluster_overlap_ratio, 0.0, 1.0);
  return check.violations();
}

ObjectMaskPropagator::ObjectMaskPropagator(const ObjectMaskPropagatorOptions& options)
    : implementation_(std::make_unique<Implementation>(options))
{
}
ObjectMaskPropagator::~ObjectMaskPropagator() = default;
ObjectMaskPropagator::ObjectMaskPropagator(ObjectMaskPropagator&&) noexcept = default;

base::Status ObjectMaskPropagator::start(const rgbd::Keyframe& keyframe, const SceneSegmentation& segmentation,
                                         int hypothesis)
{
  return implementation_->start(keyframe, segmentation, hypothesis);
}
bool ObjectMaskPropagator::started() const
{
  return implementation_->started();
}
base::Result<cv::Mat> ObjectMaskPropagator::propagate(const rgbd::Keyframe& keyframe)
{
  return implementation_->propagate(keyframe);
}
base::Result<cv::Mat> ObjectMaskPropagator::mask(const rgbd::Keyframe& keyframe) const
{
  return implementation_->mask(keyframe);
}
void ObjectMaskPropagator::recount(const std::vector<rgbd::Keyframe>& keyframes)
{
  implementation_->recount(keyframes);
}
std::optional<geometry::Plane> ObjectMaskPropagator::supportPlane() const
{
  return implementation_->supportPlane();
}

}  // namespace object_modelling::segmentation
