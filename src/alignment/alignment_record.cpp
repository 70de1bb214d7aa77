#include "object_modelling/alignment/alignment_record.h"

#include <algorithm>
#include <cmath>

#include <yaml-cpp/yaml.h>

#include "object_modelling/base/status.h"
#include "object_modelling/base/yaml_number.h"
#include "object_modelling/geometry/transform.h"
#include "object_modelling/registration/pair_figures.h"

namespace object_modelling::alignment
{
namespace
{
constexpr std::size_t KEPT_CANDIDATES = 8;  // enough to find again the poses that score alike
constexpr char SAME_OBJECT[] = "same_object_probability";
constexpr double MAX_ROTATION_ERROR = 1e-6;

const Decision DECISIONS[] = { Decision::AUTOMATIC, Decision::ACCEPTED, Decision::REFUSED };
const ProposalKind KINDS[] = { ProposalKind::FEATURES, ProposalKind::STABLE_PLANE, ProposalKind::SHAPE,
                               ProposalKind::BY_HAND, ProposalKind::CYCLE };

std::string pairText(const keyframes::AlignmentRecord& record)
{
  return "alignment of sessions '" + record.session_a + "' and '" + record.session_b + "'";
}

template <typename Value, std::size_t COUNT>
Value named(const Value (&values)[COUNT], const YAML::Node& node)
{
  const auto name = node.as<std::string>();
  for (const Value value : values)
    if (nameOf(value) == name)
      return value;
  throw base::Error(base::StatusCode::BAD_INPUT, "'" + name + "' is not known");
}

double finite(const YAML::Node& node)
{
  const auto value = node.as<double>();
  if (!std::isfinite(value))
    throw base::Error(base::StatusCode::BAD_INPUT, "a number is not finite");
  return value;
}

void emit(YAML::Emitter& out, const PairCandidate& candidate)
{
  out << YAML::BeginMap << YAML::Key << "kind" << YAML::Value << nameOf(candidate.kind);
  out << YAML::Key << "a_from_b" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      out << base::yamlNumber(candidate.T_a_b.matrix()(row, column));
  out << YAML::EndSeq;
  out << YAML::Key << SAME_OBJECT << YAML::Value << base::yamlNumber(candidate.same_object_probability);
  for (const registration::PairFigure& figure : registration::pairFigures())
    out << YAML::Key << figure.name << YAML::Value << base::yamlNumber(candidate.quality.*figure.value);
  out << YAML::EndMap;
}

PairCandidate candidateFrom(const YAML::Node& node)
{
  PairCandidate candidate;
  candidate.kind = named(KINDS, node["kind"]);
  const YAML::Node pose = node["a_from_b"];
  if (!pose.IsSequence() || pose.size() != 12)
    throw base::Error(base::StatusCode::BAD_INPUT, "a_from_b has not 12 numbers");
  for (int i = 0; i < 12; ++i)
    candidate.T_a_b.matrix()(i / 4, i % 4) = finite(pose[i]);
  const Eigen::Matrix3d R = candidate.T_a_b.linear();
  if (!(R * R.transpose()).isIdentity(MAX_ROTATION_ERROR) || R.determinant() < 0)
    throw base::Error(base::StatusCode::BAD_INPUT, "a_from_b is no rigid motion");
  if (node[SAME_OBJECT])
  {
    candidate.same_object_probability = finite(node[SAME_OBJECT]);
    if (candidate.same_object_probability < 0 || candidate.same_object_probability > 1)
      throw base::Error(base::StatusCode::BAD_INPUT, std::string("has a ") + SAME_OBJECT + " outside 0 to 1");
  }
  for (const registration::PairFigure& figure : registration::pairFigures())
    if (figure.required || node[figure.name])
      candidate.quality.*figure.value = finite(node[figure.name]);
  return candidate;
}

AlignmentEdge parsed(const keyframes::AlignmentRecord& record)
{
  const YAML::Node node = YAML::Load(record.findings);
  AlignmentEdge edge;
  edge.session_a = record.session_a;
  edge.session_b = record.session_b;
  edge.decision = named(DECISIONS, node["decision"]);
  edge.accepted = node["accepted"].as<bool>();
  edge.reason = node["reason"].as<std::string>();
  for (const YAML::Node& candidate : node["candidates"])
    edge.candidates.push_back(candidateFrom(candidate));
  // Older records do not contain which poses make the same object.
  if (!edge.candidates.empty() && !node["candidates"][0][SAME_OBJECT])
    edge.candidates.front().same_object_probability = 1;
  if (edge.accepted && edge.candidates.empty())
    throw base::Error(base::StatusCode::BAD_INPUT, "is accepted, but has no pose");
  return edge;
}
}  // namespace

keyframes::AlignmentRecord recordOf(const AlignmentEdge& edge)
{
  YAML::Emitter out;
  out << YAML::BeginMap << YAML::Key << "decision" << YAML::Value << nameOf(edge.decision);
  out << YAML::Key << "accepted" << YAML::Value << edge.accepted;
  out << YAML::Key << "reason" << YAML::Value << YAML::DoubleQuoted << edge.reason;
  out << YAML::Key << "candidates" << YAML::Value << YAML::BeginSeq;
  for (std::size_t i = 0; i < std::min(KEPT_CANDIDATES, edge.candidates.size()); ++i)
    emit(out, edge.candidates[i]);
  out << YAML::EndSeq << YAML::EndMap;
  return { edge.session_a, edge.session_b, std::string(out.c_str()) + "\n" };
}

AlignmentEdge edgeFrom(const keyframes::AlignmentRecord& record)
{
  try
  {
    return parsed(record);
  }
  catch (const std::exception& error)  // yaml-cpp's, and those above
  {
    throw base::Error(base::StatusCode::BAD_INPUT,
                      pairText(record) + ": " + error.what() + "; forget it (session_aligner/forget) and align again");
  }
}

}  // namespace object_modelling::alignment
