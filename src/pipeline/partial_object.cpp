#include "object_modelling/pipeline/partial_object.h"

#include <algorithm>
#include <utility>

namespace object_modelling::pipeline
{
namespace
{
using alignment::AlignmentEdge;
using alignment::AlignmentResult;

bool isLeftOut(const AlignmentResult& aligned, const std::string& id)
{
  return std::find(aligned.left_out.begin(), aligned.left_out.end(), id) != aligned.left_out.end();
}

void append(const std::string& part, std::string* text)
{
  *text += (text->empty() ? "" : "; ") + part;
}

/// How well a session serves alone: first whether the object's model has it already, then the surface seen in m2.
std::pair<bool, double> worthAlone(keyframes::SessionStore& store, const registration::PartialModel& part)
{
  const double area_m2 = static_cast<double>(part.points.size()) * part.spacing_m * part.spacing_m;
  return { store.session(part.session_id).T_model_session.has_value(), area_m2 };
}

void placeBestAlone(keyframes::SessionStore& store, const std::vector<registration::PartialModel>& parts,
                    AlignmentResult* aligned)
{
  std::pair<bool, double> best_worth;
  const registration::PartialModel* best = nullptr;
  for (const registration::PartialModel& part : parts)
  {
    const std::pair<bool, double> worth = worthAlone(store, part);
    if (best != nullptr && worth <= best_worth)
      continue;
    best = &part;
    best_worth = worth;
  }
  aligned->status.code = base::StatusCode::OK;
  append("session '" + best->session_id + "' is taken alone, since " +
             (best_worth.first ? "it is in a model already" : "it saw most of the object"),
         &aligned->status.message);
  aligned->placements = { { best->session_id, Eigen::Isometry3d::Identity() } };
  aligned->left_out.erase(std::find(aligned->left_out.begin(), aligned->left_out.end(), best->session_id));
}
}  // namespace

void require(Required required, keyframes::SessionStore& store, const std::vector<registration::PartialModel>& parts,
             AlignmentResult* aligned)
{
  const bool none_fit = aligned->status.code == base::StatusCode::NO_RESULT && aligned->placements.empty();
  if (required == Required::ONE && none_fit)
    placeBestAlone(store, parts, aligned);
  if (required == Required::ALL && aligned->status.ok() && !aligned->left_out.empty())
    aligned->status = { base::StatusCode::NO_RESULT,
                        "all sessions were required to fit each other: " + aligned->status.message };
}

std::vector<database::LeftOutSession> leftOutOf(const AlignmentResult& aligned)
{
  std::vector<database::LeftOutSession> sessions;
  for (const std::string& id : aligned.left_out)
  {
    std::string reason;
    for (const AlignmentEdge& edge : aligned.edges)
      if ((edge.session_a == id || edge.session_b == id) && !edge.reason.empty())
        append("with '" + (edge.session_a == id ? edge.session_b : edge.session_a) + "': " + edge.reason, &reason);
    sessions.push_back({ id, reason });
  }
  return sessions;
}

const AlignmentEdge* joiningPair(const AlignmentResult& aligned)
{
  const AlignmentEdge* best = nullptr;
  for (const AlignmentEdge& edge : aligned.edges)
  {
    const bool joins =
        aligned.placements.empty() || isLeftOut(aligned, edge.session_a) != isLeftOut(aligned, edge.session_b);
    if (!joins || edge.candidates.empty())
      continue;
    if (best == nullptr || edge.best()->quality.probability > best->best()->quality.probability)
      best = &edge;
  }
  return best;
}

}  // namespace object_modelling::pipeline
