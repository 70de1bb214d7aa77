#pragma once

#include "object_modelling/recognition/object_knowledge.h"
#include "scene.h"

namespace object_modelling::recognition
{
struct RefinedPose
{
  Eigen::Isometry3d T_camera_model = Eigen::Isometry3d::Identity();
  /// Of T_camera_model, a small motion on its left (camera frame); what neither surface nor texture holds is bounded by
  /// the object's size.
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  int pairs = 0;     ///< of the last step
  double rms_m = 0;  ///< of them, along the normals
};

/// Projective point-to-plane ICP of the object's surface on the depth image, coarse to fine.
RefinedPose refine(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3d& T_camera_model_start,
                   double start_gate_m, int iterations, std::size_t step_points = 1);

/// The same, and the object's lightness on the image's: texture holds what shape leaves free. From a pose that is off
/// by a few pixels at most.
RefinedPose refineWithTexture(const Scene& scene, const ObjectKnowledge& object,
                              const Eigen::Isometry3d& T_camera_model_start, int iterations);

/// Correlation of the object's colours with the image's, over the points that are seen; 0 where few are.
float colorCorrelation(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3f& T_camera_model);

/// Share of the surface that faces the camera and is where the scene has one, less the share that the camera sees
/// through; by every `step`-th point. For many hypotheses.
float quickScore(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3f& T_camera_model, int step);

}  // namespace object_modelling::recognition
