#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "object_modelling/registration/dense_pyramid.h"
#include "object_modelling/rgbd/keyframe.h"
#include "wide_baseline_features.h"

namespace object_modelling::tracking
{
/// A landmark as one keyframe sees it. A landmark found again in a later keyframe has a sighting there too, with the
/// same id.
struct Sighting
{
  std::uint64_t landmark_id = 0;
  Eigen::Vector2f pixel;
  Eigen::Vector3d p_keyframe;  ///< optical frame of that keyframe
  Eigen::Vector3d n_keyframe;  ///< surface normal, towards that camera
};

/// What tracking keeps of a keyframe.
struct MapKeyframe
{
  int id = -1;
  Eigen::Isometry3d T_session_camera = Eigen::Isometry3d::Identity();
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  ///< of T_session_camera
  double median_depth_m = 1;
  /// Whether the pose rests on a good fit to other trusted keyframes. One that does not (blurred, in a hurry, next to
  /// nothing in view) carries the tracking on, but is not what a lost camera is placed by.
  bool trusted = true;
  std::vector<cv::Mat> pyramid;  ///< grey, full resolution first
  std::vector<Sighting> sightings;
  rgbd::Frame frame;  ///< without colour, and without depth once it is in the map: wholeFrame() has it
  cv::Mat thumbnail;  ///< CV_32FC1, small, zero mean, unit norm: finds similar views quickly
  /// Descriptors, made when first asked for: most keyframes are never relocalised against.
  const WideBaselineFeatures& features(FeatureKind kind) const;
  bool hasFeatures(FeatureKind kind) const { return features_[static_cast<std::size_t>(kind)].has_value(); }
  /// Points for dense alignment, made when first asked for.
  const registration::DenseReference& dense() const;

  /// Halves what a keyframe keeps in memory: depth goes to 16 bits, the full-resolution image is shared.
  void compact();
  rgbd::Frame wholeFrame() const;

private:
  cv::Mat compact_depth_;                                                // CV_16UC1
  mutable std::array<std::optional<WideBaselineFeatures>, 2> features_;  // by kind
  mutable std::optional<registration::DenseReference> dense_;
};

/// Small normalised image of a view for MapKeyframe::thumbnail.
cv::Mat makeThumbnail(const cv::Mat& gray);

/// Keyframes of one session and the queries of tracking. Not thread safe.
class KeyframeMap
{
public:
  void clear();
  bool empty() const { return keyframes_.empty(); }
  const MapKeyframe& add(MapKeyframe keyframe);
  const std::vector<std::unique_ptr<MapKeyframe>>& keyframes() const { return keyframes_; }

  /// Keyframes by predicted likeness of their view to a pose, the most alike first, trusted ones before others that are
  /// little nearer; those that look elsewhere left out.
  std::vector<const MapKeyframe*> nearestViews(const Eigen::Isometry3d& T_session_camera, std::size_t count,
                                               bool trusted_only = false) const;

  /// Whether no keyframe looks from within both an angle and a distance (as a share of its depth).
  bool isNewView(const Eigen::Isometry3d& T_session_camera, double angle_rad, double distance_ratio) const;

  /// Trusted keyframes by likeness of the image, for when no pose is known.
  std::vector<const MapKeyframe*> similarImages(const cv::Mat& thumbnail, std::size_t count) const;

private:
  std::vector<std::unique_ptr<MapKeyframe>> keyframes_;
};

}  // namespace object_modelling::tracking
