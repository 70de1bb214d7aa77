#include "object_modelling/alignment/alignment_record.h"

#include <gtest/gtest.h>

#include "object_modelling/base/status.h"
#include "object_modelling/registration/pair_figures.h"

namespace object_modelling::alignment
{
namespace
{
AlignmentEdge edge()
{
  PairCandidate candidate;
  candidate.kind = ProposalKind::BY_HAND;
  candidate.T_a_b =
      Eigen::Translation3d(0.1, -1.0 / 3, 2e-9) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  double value = 4.1e-4;
  for (const registration::PairFigure& figure : registration::pairFigures())
    candidate.quality.*figure.value = value *= -1.7;
  candidate.quality.probability = 0.975;
  AlignmentEdge result;
  result.session_a = "mug_1";
  result.session_b = "mug_2";
  result.decision = Decision::ACCEPTED;
  result.accepted = true;
  result.reason = "left out: \"a\" says 3 %\nand more: - x";
  result.candidates = { candidate, PairCandidate() };
  result.candidates[0].same_object_probability = 1.0 / 3;
  result.candidates[1].same_object_probability = 1;
  return result;
}

std::string refusal(const std::string& findings)
{
  try
  {
    edgeFrom({ "mug_1", "mug_2", findings });
  }
  catch (const base::Error& error)
  {
    EXPECT_EQ(error.code(), base::StatusCode::BAD_INPUT);
    return error.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}
}  // namespace

TEST(AlignmentRecord, KeepsEverything)
{
  const AlignmentEdge before = edge(), after = edgeFrom(recordOf(before));
  EXPECT_EQ(after.session_a, before.session_a);
  EXPECT_EQ(after.session_b, before.session_b);
  EXPECT_EQ(after.decision, before.decision);
  EXPECT_TRUE(after.accepted);
  EXPECT_EQ(after.reason, before.reason);
  ASSERT_EQ(after.candidates.size(), 2u);
  const PairCandidate &was = before.candidates[0], &is = after.candidates[0];
  EXPECT_EQ(is.kind, was.kind);
  EXPECT_EQ(is.T_a_b.matrix(), was.T_a_b.matrix());
  for (const registration::PairFigure& figure : registration::pairFigures())
    EXPECT_EQ(is.quality.*figure.value, was.quality.*figure.value) << figure.name;
}

TEST(AlignmentRecord, ReadsOneThatLacksWhatWasAddedSince)
{
  for (const registration::PairFigure& figure : registration::pairFigures())
  {
    const std::string all = recordOf(edge()).findings;
    const auto from = all.find(std::string("    ") + figure.name + ":");
    ASSERT_NE(from, std::string::npos) << figure.name;
    const std::string without = all.substr(0, from) + all.substr(all.find('\n', from) + 1);
    if (figure.required)
    {
      EXPECT_FALSE(refusal(without).empty()) << figure.name;
      continue;
    }
    const registration::PairQuality quality = edgeFrom({ "mug_1", "mug_2", without }).candidates.front().quality;
    EXPECT_EQ(quality.*figure.value, registration::PairQuality().*figure.value) << figure.name;
    EXPECT_EQ(quality.probability, 0.975);
  }
}

TEST(AlignmentRecord, KeepsWhichCandidatesMakeTheSameObject)
{
  AlignmentEdge before = edge();
  const AlignmentEdge after = edgeFrom(recordOf(before));
  EXPECT_EQ(after.candidates[0].same_object_probability, 1.0 / 3);
  EXPECT_EQ(after.candidates[1].same_object_probability, 1) << "it leads, though another was put first";
  std::string older = recordOf(before).findings;
  const std::string name = "    same_object_probability:";
  for (std::size_t from = older.find(name); from != std::string::npos; from = older.find(name))
    older.erase(from, older.find('\n', from) + 1 - from);
  const AlignmentEdge unknown = edgeFrom({ "mug_1", "mug_2", older });
  ASSERT_EQ(unknown.candidates.size(), 2u);
  EXPECT_EQ(unknown.candidates[0].same_object_probability, 1);
  EXPECT_EQ(unknown.candidates[1].same_object_probability, 0);
}

TEST(AlignmentRecord, KeepsARefusalWithoutPoses)
{
  AlignmentEdge refused;
  refused.session_a = "mug_1";
  refused.session_b = "mug_2";
  refused.reason = "no pose";
  const AlignmentEdge after = edgeFrom(recordOf(refused));
  EXPECT_EQ(after.decision, Decision::AUTOMATIC);
  EXPECT_FALSE(after.accepted);
  EXPECT_EQ(after.reason, "no pose");
  EXPECT_TRUE(after.candidates.empty());
}

TEST(AlignmentRecord, NamesWhatIsWrong)
{
  const std::string good = recordOf(edge()).findings;
  EXPECT_TRUE(refusal(good).empty());
  for (const std::string& bad :
       { std::string(), std::string("["), std::string("decision: accepted"), replaced(good, "by_hand", "by_magic"),
         replaced(good, "decision: accepted", "decision: perhaps"), replaced(good, "probability: 0.975", "p: 1"),
         replaced(good, "0.975", ".nan"), replaced(good, "same_object_probability: 1", "same_object_probability: x"),
         replaced(good, "[1, 0, 0, 0", "[1, 0, 0"), replaced(good, "[1, 0, 0, 0", "[3, 0, 0, 0"),
         good.substr(0, good.size() / 2) })
    EXPECT_NE(refusal(bad).find("'mug_1' and 'mug_2'"), std::string::npos) << bad;
  EXPECT_NE(refusal(replaced(good, "by_hand", "by_magic")).find("'by_magic'"), std::string::npos);
}

}  // namespace object_modelling::alignment
