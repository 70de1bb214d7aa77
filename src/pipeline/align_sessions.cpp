#include "object_modelling/pipeline/align_sessions.h"

#include <algorithm>

#include <glog/logging.h>

#include "object_modelling/alignment/alignment_record.h"
#include "object_modelling/alignment/session_part.h"
#include "object_modelling/base/options.h"
#include "session_loading.h"

namespace object_modelling::pipeline
{
namespace
{
using alignment::AlignmentEdge;
using base::Error;
using base::StatusCode;

bool isOf(const keyframes::AlignmentRecord& record, const std::string& session_a, const std::string& session_b)
{
  return (record.session_a == session_a && record.session_b == session_b) ||
         (record.session_a == session_b && record.session_b == session_a);
}

std::string pairText(const std::string& session_a, const std::string& session_b)
{
  return "sessions '" + session_a + "' and '" + session_b + "'";
}

/// Those of the parts' sessions. One that cannot be read costs the work of finding it again, no more.
std::vector<AlignmentEdge> knownEdges(keyframes::SessionStore& store,
                                      const std::vector<registration::PartialModel>& parts)
{
  const auto given = [&](const std::string& id)
  { return std::any_of(parts.begin(), parts.end(), [&](const auto& part) { return part.session_id == id; }); };
  std::vector<AlignmentEdge> edges;
  for (const keyframes::AlignmentRecord& record : store.alignments())
    if (given(record.session_a) && given(record.session_b))
      try
      {
        edges.push_back(alignment::edgeFrom(record));
      }
      catch (const Error& error)
      {
        LOG(WARNING) << "not used: " << error.what();
      }
  return edges;
}

void keep(keyframes::SessionStore& store, const std::vector<AlignmentEdge>& edges)
{
  std::vector<keyframes::AlignmentRecord> records;
  for (const AlignmentEdge& edge : edges)
    records.push_back(alignment::recordOf(edge));
  store.updateAlignments(records);
}

AlignmentEdge accepted(keyframes::SessionStore& store, AlignmentEdge edge)
{
  edge.decision = alignment::Decision::ACCEPTED;
  edge.accepted = true;
  edge.reason.clear();
  keep(store, { edge });
  return edge;
}
}  // namespace

std::vector<std::string> AlignOptions::violations() const
{
  base::OptionsCheck check("align_sessions");
  check.include(part.violations());
  check.include(pair.violations());
  return check.violations();
}

std::vector<std::string> sessionsOf(keyframes::SessionStore& store, const std::string& object_id)
{
  std::vector<std::string> ids;
  for (const keyframes::Session& session : store.listSessions())
    if (session.object_id == object_id)
      ids.push_back(session.id);
  return ids;
}

std::vector<registration::PartialModel> loadParts(keyframes::SessionStore& store,
                                                  const std::vector<std::string>& session_ids,
                                                  const alignment::PartialModelOptions& options,
                                                  base::JobControl& control)
{
  base::checked(options);
  std::vector<keyframes::Session> sessions;
  for (const std::string& id : session_ids)  // a name that is not known must not cost the work on the others
    sessions.push_back(store.session(id));
  std::vector<registration::PartialModel> parts;
  for (const keyframes::Session& session : sessions)
  {
    const std::vector<rgbd::Keyframe> keyframes = loadReported(store, session.id, control);
    if (keyframes.empty())
    {
      const base::Status status = noKeyframes(session.id);
      throw Error(status.code, status.message);
    }
    control.report("fuse", parts.size(), sessions.size());
    parts.push_back(alignment::makePartialModel(session, keyframes, options, control));
  }
  return parts;
}

alignment::AlignmentResult alignStoredParts(keyframes::SessionStore& store,
                                            const std::vector<registration::PartialModel>& parts,
                                            const AlignOptions& options, base::JobControl& control)
{
  base::checked(options);
  std::vector<AlignmentEdge> known = knownEdges(store, parts);
  if (!options.use_known)
    known.erase(
        std::remove_if(known.begin(), known.end(),
                       [](const AlignmentEdge& edge) { return edge.decision == alignment::Decision::AUTOMATIC; }),
        known.end());
  alignment::AlignmentResult result = alignment::alignSessions(parts, known, options.pair, control);
  try
  {
    keep(store, result.edges);
  }
  catch (const Error& error)
  {
    std::string& message = result.status.message;
    message += (message.empty() ? "" : "; ") + std::string("the alignments could not be kept: ") + error.what();
  }
  require(options.required, store, parts, &result);
  return result;
}

alignment::AlignmentResult alignStoredSessions(keyframes::SessionStore& store,
                                               const std::vector<std::string>& session_ids, const AlignOptions& options,
                                               base::JobControl& control)
{
  base::checked(options);
  if (session_ids.size() == 1)
  {
    store.session(session_ids.front());
    control.report("align", 1, 1);
    alignment::AlignmentResult alone;
    alone.placements.push_back({ session_ids.front(), Eigen::Isometry3d::Identity() });
    return alone;
  }
  return alignStoredParts(store, loadParts(store, session_ids, options.part, control), options, control);
}

AlignmentEdge knownAlignment(keyframes::SessionStore& store, const std::string& session_a, const std::string& session_b)
{
  for (const std::string& id : { session_a, session_b })
    store.session(id);  // NOT_FOUND names it
  for (const keyframes::AlignmentRecord& record : store.alignments())
    if (isOf(record, session_a, session_b))
      return alignment::edgeFrom(record);
  AlignmentEdge edge;
  edge.session_a = session_a;
  edge.session_b = session_b;
  return edge;
}

AlignmentEdge acceptAlignment(keyframes::SessionStore& store, const std::string& session_a,
                              const std::string& session_b, std::size_t candidate)
{
  AlignmentEdge edge = knownAlignment(store, session_a, session_b);
  if (edge.candidates.empty())
    throw Error(StatusCode::FAILED_PRECONDITION,
                pairText(session_a, session_b) + " have no candidate poses: align them first, or by points");
  if (candidate >= edge.candidates.size())
    throw Error(StatusCode::INVALID_ARGUMENT,
                pairText(session_a, session_b) + " have " + std::to_string(edge.candidates.size()) +
                    " candidates, counted from 0: there is none with number " + std::to_string(candidate) +
                    "; align them by points where none is right");
  std::rotate(edge.candidates.begin(), edge.candidates.begin() + static_cast<std::ptrdiff_t>(candidate),
              edge.candidates.begin() + static_cast<std::ptrdiff_t>(candidate) + 1);
  return accepted(store, edge);
}

AlignmentEdge refuseAlignment(keyframes::SessionStore& store, const std::string& session_a,
                              const std::string& session_b)
{
  AlignmentEdge edge = knownAlignment(store, session_a, session_b);
  edge.decision = alignment::Decision::REFUSED;
  edge.accepted = false;
  edge.reason = "refused by a person";
  keep(store, { edge });
  return edge;
}

void forgetAlignment(keyframes::SessionStore& store, const std::string& session_a, const std::string& session_b)
{
  store.updateAlignments({ { session_a, session_b, "" } });
}

AlignmentEdge acceptByPoints(keyframes::SessionStore& store, const registration::PartialModel& a,
                             const registration::PartialModel& b, const std::vector<alignment::PointPair>& pairs,
                             const AlignOptions& options, base::JobControl& control)
{
  AlignmentEdge edge = knownAlignment(store, a.session_id, b.session_id);
  alignment::PairCandidate candidate = alignment::alignByPoints(a, b, pairs, options.pair, control);
  if (edge.session_a != a.session_id)
    candidate.T_a_b = candidate.T_a_b.inverse();
  edge.candidates.insert(edge.candidates.begin(), candidate);
  return accepted(store, edge);
}

}  // namespace object_modelling::pipeline
