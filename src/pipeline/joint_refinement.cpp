#include "joint_refinement.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "object_modelling/multi_view_icp/multi_view_icp.h"

namespace object_modelling::pipeline
{
namespace
{
constexpr double AFTER_ALIGNMENT_M = 0.003;  // how far the surfaces of aligned sessions are off, at most
constexpr int MAX_PARTNERS = 3;              // of each view: few unknowns need few of many pairs

bool isIn(const std::vector<std::string>& session_ids, const std::string& id)
{
  return std::find(session_ids.begin(), session_ids.end(), id) != session_ids.end();
}

/// Sessions that stayed where alignment placed them; empty if none did.
std::string leftOutText(const std::vector<std::string>& session_ids, const std::vector<rgbd::View>& views,
                        const std::vector<int>& left_out_views)
{
  std::vector<std::string> left_out;
  for (const int k : left_out_views)
  {
    const std::string& session_id = session_ids.at(static_cast<std::size_t>(views[k].session_index));
    if (!isIn(left_out, session_id))
      left_out.push_back(session_id);
  }
  std::string names;
  for (const std::string& id : left_out)
    names += (names.empty() ? "'" : ", '") + id + "'";
  return names.empty() ? names
                       : "placed as aligned, not refined together with the others, whose keyframes have no surface in "
                         "common with theirs: " +
                             names;
}

std::string unconvergedText(const multi_view_icp::MultiViewIcpResult& refined)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "the sessions' places against each other are not settled: after "
       << refined.iterations << " iterations they still moved by " << 1e3 * refined.last_step_m << " mm and "
       << refined.last_step_rad * 180 / M_PI << " deg, and are left where they fitted best";
  return text.str();
}
}  // namespace

std::string refineJointly(const std::vector<std::string>& session_ids, std::vector<rgbd::View>* views,
                          base::JobControl& control)
{
  multi_view_icp::MultiViewIcpOptions options;
  options.object_only = true;
  options.start_error_m = AFTER_ALIGNMENT_M;
  options.color_weight = 0;
  options.max_partners = MAX_PARTNERS;
  options.sessions_as_bodies = true;
  const multi_view_icp::MultiViewIcpResult refined = multi_view_icp::refineByMultiViewIcp(*views, options, control);
  if (!refined.status.ok())
    return "sessions are placed as aligned, not refined together: " + refined.status.message;
  for (std::size_t i = 0; i < views->size(); ++i)
  {
    (*views)[i].T_world_camera = refined.T_world_camera[i];
    (*views)[i].covariance = refined.covariance[i];
  }
  const std::string left_out = leftOutText(session_ids, *views, refined.left_out);
  const std::string left = refined.converged ? "" : unconvergedText(refined);
  return left_out + (left_out.empty() || left.empty() ? "" : "; ") + left;
}

}  // namespace object_modelling::pipeline
