#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "object_modelling/segmentation/scene_segmenter.h"

namespace object_modelling::segmentation
{
class JointMotion;

struct ObjectFollowerOptions
{
  SceneSegmenterOptions segmenter;
  /// A part of the support that ends with a step down all round and is no larger is taken to be a turntable, which
  /// turns with the object, until the image shows that it does not; 0: never.
  double max_turntable_size_m = 0.6;
  std::vector<std::string> violations() const;
};

/// Where the object is in one frame.
struct FollowedObject
{
  base::Status status;  ///< NO_RESULT with the reason where the object cannot be segmented
  cv::Mat mask;         ///< CV_8UC1, 255 on the object; empty unless ok
  cv::Mat turntable;    ///< CV_8UC1, 255 on what turns with it; empty where there is none

  /// Both together: what a camera may be tracked against.
  cv::Mat moving() const { return turntable.empty() ? mask : cv::Mat(mask | turntable); }
};

/// The turntable (CV_8UC1) under the object of `frame.object_mask`, by this frame alone; empty where there is none.
cv::Mat findTurntable(const rgbd::Frame& frame, double max_size_m = ObjectFollowerOptions().max_turntable_size_m);

/// Finds one object that moves with respect to the camera in each frame of a stream, without known poses: chosen
/// automatically in the first frame, then what stands on the support and overlaps the last mask most. A mask that a
/// frame brings is kept; where others bring none, what turns with the object goes on to count. Not thread safe.
class ObjectFollower
{
public:
  explicit ObjectFollower(const ObjectFollowerOptions& options = {});
  ~ObjectFollower();

  FollowedObject follow(const rgbd::Frame& frame);
  /// Forgets the object: it is chosen anew in the next frame.
  void reset();

private:
  struct Support
  {
    geometry::Plane plane_camera;
    double noise_scale = 1;
  };

  /// Looks round the last mask only, with the support as it was. Empty where nothing overlaps that mask.
  cv::Mat lookNear(const rgbd::Frame& frame);
  base::Result<cv::Mat> lookEverywhere(const rgbd::Frame& frame);
  /// What stands on the plane if that is the top of a turntable, which the hypothesis takes for a part of the object.
  cv::Mat lookOnTurntable(const rgbd::Frame& frame, const SupportedPlane& plane, const cv::Mat& hypothesis);
  cv::Mat turntableUnder(const rgbd::Frame& frame, const Support& support, const cv::Mat& object) const;
  static Support supportRound(const rgbd::Frame& frame, const geometry::Plane& plane_camera, const cv::Mat& object);

  ObjectFollowerOptions options_;
  SceneSegmenter segmenter_;
  cv::Mat last_mask_;
  std::optional<Support> support_;
  bool on_turntable_ = false;
  std::unique_ptr<JointMotion> joint_motion_;  ///< of object and turntable
  int misses_ = 0;                             ///< frames in a row without the object
};

}  // namespace object_modelling::segmentation
