#include "object_modelling/alignment/session_alignment.h"

#include "object_modelling/base/status.h"

namespace object_modelling::alignment
{
AlignmentResult alignSessions(const std::vector<keyframes::Session>& sessions, base::JobControl& control)
{
  control.report("align", 0, sessions.size());
  AlignmentResult result;
  if (sessions.empty())
  {
    result.status = { base::StatusCode::INVALID_ARGUMENT, "no sessions to align; name at least one" };
    return result;
  }
  if (sessions.size() > 1)
  {
    std::string names;
    for (const keyframes::Session& session : sessions)
      names += (names.empty() ? "'" : ", '") + session.id + "'";
    result.status = { base::StatusCode::NO_RESULT, std::to_string(sessions.size()) + " sessions given (" + names +
                                                       "), and no relation between two sessions can be measured yet; "
                                                       "build the object from one of them" };
    return result;
  }
  result.placements.push_back({ sessions.front().id, Eigen::Isometry3d::Identity() });
  control.report("align", 1, 1);
  return result;
}

}  // namespace object_modelling::alignment
