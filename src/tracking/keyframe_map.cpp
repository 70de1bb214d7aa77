#include "keyframe_map.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "object_modelling/rgbd/depth_units.h"

namespace object_modelling::tracking
{
namespace
{
constexpr double MAX_REFERENCE_ANGLE_RAD = 1.0;  // a view turned further shares no patch that could be recognised
constexpr double DISTRUST_RAD = 0.35;            // as good as a trusted view that much further round
const cv::Size THUMBNAIL_SIZE(40, 30);
constexpr double COMPACT_DEPTH_UNIT_M = 0.00025;  // sensors resolve no finer; reaches 16 m

double viewAngle_rad(const Eigen::Isometry3d& T_a, const Eigen::Isometry3d& T_b)
{
  return std::acos(std::clamp(T_a.linear().col(2).dot(T_b.linear().col(2)), -1.0, 1.0));
}

double distanceRatio(const MapKeyframe& keyframe, const Eigen::Isometry3d& T_session_camera)
{
  return (keyframe.T_session_camera.translation() - T_session_camera.translation()).norm() / keyframe.median_depth_m;
}
}  // namespace

const WideBaselineFeatures& MapKeyframe::features(FeatureKind kind) const
{
  std::optional<WideBaselineFeatures>& features = features_[static_cast<std::size_t>(kind)];
  if (!features)
    features = detectWideBaselineFeatures(wholeFrame(), kind);
  return *features;
}

const registration::DenseReference& MapKeyframe::dense() const
{
  if (!dense_)
    dense_.emplace(registration::DensePyramid(wholeFrame(), pyramid));
  return *dense_;
}

void MapKeyframe::compact()
{
  frame.color_bgr.release();
  if (!pyramid.empty() && pyramid.front().size() == frame.gray.size())
    frame.gray = pyramid.front();
  if (frame.depth_m.empty())
    return;
  compact_depth_ = rgbd::depthAs16Bit(frame.depth_m, COMPACT_DEPTH_UNIT_M);
  frame.depth_m.release();
}

rgbd::Frame MapKeyframe::wholeFrame() const
{
  rgbd::Frame whole = frame;
  if (!compact_depth_.empty())
    whole.depth_m = rgbd::depthInMeters(compact_depth_, COMPACT_DEPTH_UNIT_M);
  return whole;
}

cv::Mat makeThumbnail(const cv::Mat& gray)
{
  cv::Mat small, thumbnail;
  cv::resize(gray, small, THUMBNAIL_SIZE, 0, 0, cv::INTER_AREA);
  small.convertTo(thumbnail, CV_32F);
  cv::GaussianBlur(thumbnail, thumbnail, cv::Size(0, 0), 1.5);
  thumbnail -= cv::mean(thumbnail)[0];
  const double norm = cv::norm(thumbnail);
  if (norm > 0)
    thumbnail /= norm;
  return thumbnail;
}

void KeyframeMap::clear()
{
  keyframes_.clear();
}

const MapKeyframe& KeyframeMap::add(MapKeyframe keyframe)
{
  keyframe.compact();
  keyframe.thumbnail = makeThumbnail(keyframe.frame.gray);
  keyframes_.push_back(std::make_unique<MapKeyframe>(std::move(keyframe)));
  return *keyframes_.back();
}

std::vector<const MapKeyframe*> KeyframeMap::nearestViews(const Eigen::Isometry3d& T_session_camera, std::size_t count,
                                                          bool trusted_only) const
{
  std::vector<std::pair<double, const MapKeyframe*>> scored;
  for (const auto& keyframe : keyframes_)
  {
    if (trusted_only && !keyframe->trusted)
      continue;
    const double angle_rad = viewAngle_rad(keyframe->T_session_camera, T_session_camera);
    if (angle_rad < MAX_REFERENCE_ANGLE_RAD)
      scored.emplace_back(
          angle_rad + distanceRatio(*keyframe, T_session_camera) + (keyframe->trusted ? 0 : DISTRUST_RAD),
          keyframe.get());
  }
  std::stable_sort(scored.begin(), scored.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const MapKeyframe*> nearest;
  for (std::size_t i = 0; i < std::min(count, scored.size()); ++i)
    nearest.push_back(scored[i].second);
  return nearest;
}

bool KeyframeMap::isNewView(const Eigen::Isometry3d& T_session_camera, double angle_rad, double distance_ratio) const
{
  return std::none_of(keyframes_.begin(), keyframes_.end(),
                      [&](const auto& keyframe)
                      {
                        return viewAngle_rad(keyframe->T_session_camera, T_session_camera) < angle_rad &&
                               distanceRatio(*keyframe, T_session_camera) < distance_ratio;
                      });
}

std::vector<const MapKeyframe*> KeyframeMap::similarImages(const cv::Mat& thumbnail, std::size_t count) const
{
  std::vector<std::pair<double, const MapKeyframe*>> scored;
  for (const auto& keyframe : keyframes_)
    if (keyframe->trusted)
      scored.emplace_back(-thumbnail.dot(keyframe->thumbnail), keyframe.get());
  std::stable_sort(scored.begin(), scored.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const MapKeyframe*> similar;
  for (std::size_t i = 0; i < std::min(count, scored.size()); ++i)
    similar.push_back(scored[i].second);
  return similar;
}

}  // namespace object_modelling::tracking
