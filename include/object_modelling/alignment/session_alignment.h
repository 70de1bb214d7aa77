#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/keyframes/session.h"

namespace object_modelling::alignment
{
struct AlignmentEdge
{
  std::string session_a, session_b;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  double overlap_ratio = 0;  ///< [0, 1] share of the surface that both saw
  double fsv_ratio = 0;      ///< [0, 1] free-space violation
  double confidence = 0;     ///< [0, 1]
};

struct SessionPlacement
{
  std::string session_id;
  Eigen::Isometry3d T_reference_session = Eigen::Isometry3d::Identity();  ///< into the first session's frame
};

struct AlignmentResult
{
  base::Status status;
  std::vector<SessionPlacement> placements;
  std::vector<AlignmentEdge> edges;
};

/// Places the sessions of one object in the frame of the first. One session is placed at identity; several are refused
/// with NO_RESULT and the reason, never left at identity.
AlignmentResult alignSessions(const std::vector<keyframes::Session>& sessions, base::JobControl& control);

}  // namespace object_modelling::alignment
