#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace object_modelling::object_properties
{
struct RestingPose
{
  Eigen::Isometry3d T_support_model = Eigen::Isometry3d::Identity();  ///< z up, support at z = 0
  double probability = 0;  ///< of ending so when dropped in any orientation; 0: does not stay so by itself
  bool seen = false;       ///< recorded in it
};

struct RestingPoseOptions
{
  double max_coplanar_deg = 2;      ///< hull faces whose normals differ by less are one
  double max_barrier_ratio = 0.03;  ///< of the centre of mass's height: what it is tipped over by itself
  double max_seen_deg = 10;         ///< between the upward directions of a recorded pose and a computed one
  double min_probability = 0.01;    ///< rarer poses are left out unless they were recorded
  std::vector<std::string> violations() const;
};

/// How an object rests on a plane, most probable first; probabilities add up to 1. Faces of the convex hull over which
/// the centre of mass stands are stable; an object that lands on another one rolls to a neighbour, and without speed
/// (Goldberg et al., Part pose statistics, 1999): a face's probability is the solid angle of all that rolls to it.
/// Poses between which an object rolls freely (a can on its side) are one. A recorded pose stands for the computed one
/// that it is, whatever the turn about z; one that is none is kept. `points` are the object's vertices, model frame.
/// Recorded poses alone, equally probable, if the points have no volume. Throws base::Error (INVALID_ARGUMENT) for
/// broken options.
std::vector<RestingPose> restingPoses(const std::vector<Eigen::Vector3f>& points,
                                      const Eigen::Vector3d& center_of_mass_m,
                                      const std::vector<Eigen::Isometry3d>& recorded_T_support_model,
                                      const RestingPoseOptions& options = {});

}  // namespace object_modelling::object_properties
