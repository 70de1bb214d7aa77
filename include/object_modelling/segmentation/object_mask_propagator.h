#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "object_modelling/rgbd/keyframe.h"
#include "object_modelling/segmentation/scene_segmenter.h"

namespace object_modelling::segmentation
{
struct ObjectMaskPropagatorOptions
{
  SceneSegmenterOptions segmenter;
  double voxel_size_m = 0.005;  ///< of the object's volume grown over the views
  double min_cluster_overlap_ratio =
      0.3;  ///< of a cluster's points inside the object's volume, to belong to the object
  std::vector<std::string> violations() const;
};

/// The chosen object, followed by geometry through the keyframes of one session: never picked anew. Poses must be
/// metric and consistent. Not thread safe.
class ObjectMaskPropagator
{
public:
  explicit ObjectMaskPropagator(const ObjectMaskPropagatorOptions& options = {});
  ~ObjectMaskPropagator();
  ObjectMaskPropagator(ObjectMaskPropagator&&) noexcept;

  /// Starts (again) from the chosen hypothesis of a keyframe. Fails with the reason where that segmentation has no
  /// support plane.
  base::Status start(const rgbd::Keyframe& keyframe, const SceneSegmentation& segmentation, int hypothesis);
  bool started() const;

  /// Mask (CV_8UC1) of the object in another keyframe; grows the object's volume by what connects to it there.
  /// NO_RESULT where the object is not in view.
  base::Result<cv::Mat> propagate(const rgbd::Keyframe& keyframe);
  /// The same without growing anything: the mask by the volume as it is now.
  base::Result<cv::Mat> mask(const rgbd::Keyframe& keyframe) const;
  /// Lets all keyframes vote again on the volume as it has become: what single views put there and others see through,
  /// or see as part of a neighbour, goes. For a session that is complete.
  void recount(const std::vector<rgbd::Keyframe>& keyframes);

  /// Support plane in the session frame, normal up; refined over all keyframes seen so far.
  std::optional<geometry::Plane> supportPlane() const;

private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

struct SessionMasks
{
  base::Status status;
  std::vector<cv::Mat> masks;  ///< per keyframe, empty Mat where the object is not in view
  std::optional<geometry::Plane> support_plane_session;
};

/// All keyframes of a finished session, two passes, so that early masks profit from later views. `seed_point_session`
/// names the object; without one it is chosen automatically in the keyframe where it is clearest. Masks that a keyframe
/// brings (turntable recordings) are kept, and only the support plane is looked for.
SessionMasks segmentSession(const std::vector<rgbd::Keyframe>& keyframes,
                            const std::optional<Eigen::Vector3d>& seed_point_session,
                            const ObjectMaskPropagatorOptions& options = {});

}  // namespace object_modelling::segmentation
