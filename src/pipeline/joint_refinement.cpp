#include "joint_refinement.h"

#include <algorithm>

#include "object_modelling/alignment/alignment_record.h"
#include "object_modelling/refinement/multi_view_icp.h"

namespace object_modelling::pipeline
{
namespace
{
constexpr double AFTER_ALIGNMENT_M = 0.003;  // how far the surfaces of aligned sessions are off, at most
constexpr double MIN_COLOR_AGREEMENT = 0.5;  // correlation of colours; light moves with the object, print does not

bool isIn(const std::vector<std::string>& session_ids, const std::string& id)
{
  return std::find(session_ids.begin(), session_ids.end(), id) != session_ids.end();
}
}  // namespace

bool printHolds(keyframes::SessionStore& store, const std::vector<std::string>& session_ids)
{
  std::vector<std::string> held;
  for (const keyframes::AlignmentRecord& record : store.alignments())
  {
    if (!isIn(session_ids, record.session_a) || !isIn(session_ids, record.session_b))
      continue;
    try
    {
      const alignment::AlignmentEdge edge = alignment::edgeFrom(record);
      if (!edge.accepted || edge.best()->quality.color_agreement < MIN_COLOR_AGREEMENT)
        continue;
    }
    catch (const base::Error&)
    {
      continue;  // alignment says so when it meets it
    }
    held.push_back(record.session_a);
    held.push_back(record.session_b);
  }
  return std::all_of(session_ids.begin(), session_ids.end(), [&](const std::string& id) { return isIn(held, id); });
}

std::string refineJointly(const JointRefinement& joint, std::vector<rgbd::Keyframe>* keyframes,
                          base::JobControl& control)
{
  refinement::MultiViewIcpOptions options;
  options.object_only = true;
  options.start_error_m = AFTER_ALIGNMENT_M;
  options.color_offset_px = joint.color_offset_px;
  options.color_weight = joint.print_holds ? options.color_weight : 0;
  options.bodies = joint.sessions;
  const refinement::MultiViewIcpResult refined = refinement::refineByMultiViewIcp(*keyframes, options, control);
  if (!refined.status.ok())
    return "sessions are placed as aligned, not refined together: " + refined.status.message;
  for (std::size_t i = 0; i < keyframes->size(); ++i)
    (*keyframes)[i].T_session_camera = refined.T_session_camera[i];
  return {};
}

}  // namespace object_modelling::pipeline
