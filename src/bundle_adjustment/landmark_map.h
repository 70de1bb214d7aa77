#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::bundle_adjustment
{
/// One sight of a landmark by one keyframe, both by index.
struct Sight
{
  int keyframe = -1;
  int landmark = -1;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double depth_m = 0;  ///< NaN where none
  double sigma_px = 0;
  Eigen::Vector2d depth_slope_m_px = Eigen::Vector2d::Zero();  ///< change of depth_m from pixel to pixel, x and y
};

/// Everything that bundle adjustment works on, in flat arrays. Sights are ordered by landmark.
struct LandmarkMap
{
  std::vector<Eigen::Vector3d> landmarks;  ///< session frame
  std::vector<Sight> sights;
};

/// Sights whose landmark ids are still those of their origin; gathered first, numbered later.
struct SightGroup
{
  std::vector<Sight> sights;  ///< of one landmark, at most one per keyframe
};

/// Landmarks of the keyframes' own observations: at most one sight per keyframe (the first counts; later ones of the
/// same id contradict it), only on the object mask if `object_only`, in the order of their ids. Observations that are
/// not finite or outside the image are skipped.
std::vector<SightGroup> trackedSights(const std::vector<rgbd::Keyframe>& keyframes, double sigma_px, bool object_only);

/// Places every landmark with at least `min_sights` sights: robust mean of its back-projected depths; without any
/// depth, the point nearest to its rays if they meet at an angle. Landmarks that cannot be placed, and sights behind
/// their camera, are left out. Of more than 30 sights of a landmark 30 are kept, evenly.
LandmarkMap placeLandmarks(const std::vector<SightGroup>& groups, const std::vector<rgbd::Keyframe>& keyframes,
                           const std::vector<Eigen::Isometry3d>& T_session_camera, int min_sights);

/// New places for the landmarks of a map, from other poses; those that cannot be placed stay.
void replaceLandmarks(const std::vector<rgbd::Keyframe>& keyframes,
                      const std::vector<Eigen::Isometry3d>& T_session_camera, LandmarkMap* map);

/// Fits the surface round every sight that has depth: depth_m and depth_slope_m_px are then the fit's. Where none fits,
/// the reading stays, and the slope is 0.
void fitDepths(const std::vector<rgbd::Keyframe>& keyframes, LandmarkMap* map);

/// Number of landmarks that each pair of keyframes shares, as a symmetric count matrix.
Eigen::MatrixXi sharedLandmarks(const std::vector<SightGroup>& groups, std::size_t keyframe_count);

}  // namespace object_modelling::bundle_adjustment
