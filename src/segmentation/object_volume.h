#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::segmentation
{
/// The voxels of the session frame in which the object's surface was seen, with the views that speak for and against
/// each. A stray pixel at a silhouette, or a neighbour that touched the object in one view, is outvoted by the others.
class ObjectVolume
{
public:
  explicit ObjectVolume(double voxel_size_m) : voxel_size_m_(voxel_size_m) {}

  bool empty() const { return voxels_.empty(); }
  void clear();
  /// Forgets the votes, keeps the voxels.
  void clearVotes();

  /// One vote for every voxel that the mask's pixels fall into; makes the voxels that are new.
  void add(const rgbd::Keyframe& keyframe, const cv::Mat& mask);
  /// Mean balance of the votes under a mask's pixels: how sure the views are that this is the object.
  double meanVotes(const rgbd::Keyframe& keyframe, const cv::Mat& mask) const;
  /// One vote against every voxel that this view sees through, or sees as part of `others` (CV_8UC1, may be empty), but
  /// for those that it voted for itself: to be called after add() of the same view.
  void removeContradicted(const rgbd::Keyframe& keyframe, const cv::Mat& others);

  /// Whether the point lies in an occupied voxel or next to one.
  bool contains(const Eigen::Vector3d& p_session) const;

  Eigen::Vector3d centroid() const;  ///< of the occupied voxels
  /// Bounding rectangle of the occupied voxels in the image, grown by `margin_m`; empty if out of view.
  cv::Rect areaInView(const rgbd::Keyframe& keyframe, double margin_m) const;

private:
  struct Voxel
  {
    Eigen::Vector3i index;
    int votes_for = 0;
    int votes_against = 0;
    int last_view = -1;
    bool occupied() const { return votes_for > votes_against; }
  };

  static std::uint64_t key(const Eigen::Vector3i& index);
  Eigen::Vector3i indexOf(const Eigen::Vector3d& p_session) const;
  Eigen::Vector3d centerOf(const Voxel& voxel) const;
  bool occupied(const Eigen::Vector3i& index) const;

  double voxel_size_m_;
  int views_ = 0;
  std::vector<Voxel> voxels_;  // in the order of their making
  std::unordered_map<std::uint64_t, int> lookup_;
};

}  // namespace object_modelling::segmentation
