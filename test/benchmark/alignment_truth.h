#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/alignment/pair_alignment.h"
#include "object_modelling/mesh/reference_surface.h"
#include "object_modelling/rgbd/keyframe.h"

// Where the object truly is in a session of a simulated sequence, and how far an alignment is off.
namespace object_modelling::benchmark_alignment
{
struct SessionTruth
{
  std::string object;  ///< its name
  std::string mesh;    ///< path
  Eigen::Isometry3d T_session_object = Eigen::Isometry3d::Identity();
  double camera_rmse_mm = 0;  ///< of the keyframes' positions, after the fit: what this truth is worth
};

/// From the folder's groundtruth.txt and objects.yaml, brought into the session's frame by its refined keyframes. Of
/// several objects the one that is named like `object_folder`. Throws base::Error.
SessionTruth sessionTruth(const std::string& folder, const std::string& object_folder,
                          const std::vector<rgbd::Keyframe>& keyframes);

/// Share of the smaller part's points that have, placed by the truth, a point of the other part near them that faces
/// the same way.
double trueOverlap(const registration::PartialModel& a, const registration::PartialModel& b,
                   const Eigen::Isometry3d& T_a_b);

/// Angle between what was up in the sessions, as the object lies; negative without support planes.
double trueTurn_rad(const registration::PartialModel& a, const registration::PartialModel& b,
                    const Eigen::Isometry3d& T_a_b);

/// Mean, of points of a session from the true mesh.
double meshDistance_mm(const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_object_session,
                       const mesh::ReferenceSurface& surface);

struct CandidateErrors
{
  double rotation_deg = 0;
  double translation_mm = 0;    ///< at the centre of part b
  double mesh_distance_mm = 0;  ///< mean, of the points of part b from the true mesh
};

CandidateErrors errorsOf(const Eigen::Isometry3d& T_a_b, const registration::PartialModel& b,
                         const SessionTruth& truth_a, const SessionTruth& truth_b,
                         const mesh::ReferenceSurface& surface);

/// With `surface_suffices` an alignment is right too that puts the surface where it belongs, turned by a symmetry.
bool isRight(const CandidateErrors& errors, bool surface_suffices);

}  // namespace object_modelling::benchmark_alignment
