#include "joint_refinement.h"

#include "object_modelling/refinement/multi_view_icp.h"

namespace object_modelling::pipeline
{
namespace
{
constexpr double AFTER_ALIGNMENT_M = 0.003;  // how far the surfaces of aligned sessions are off, at most
}

std::string refineJointly(const Eigen::Vector2d& color_offset_px, std::vector<rgbd::Keyframe>* keyframes,
                          base::JobControl& control)
{
  refinement::MultiViewIcpOptions options;
  options.object_only = true;
  options.start_error_m = AFTER_ALIGNMENT_M;
  options.color_offset_px = color_offset_px;
  const refinement::MultiViewIcpResult refined = refinement::refineByMultiViewIcp(*keyframes, options, control);
  if (!refined.status.ok())
    return "sessions are placed as aligned, not refined together: " + refined.status.message;
  for (std::size_t i = 0; i < keyframes->size(); ++i)
    (*keyframes)[i].T_session_camera = refined.T_session_camera[i];
  return {};
}

}  // namespace object_modelling::pipeline
