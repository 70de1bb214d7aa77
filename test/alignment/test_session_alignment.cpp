#include "object_modelling/alignment/session_alignment.h"

#include <gtest/gtest.h>

namespace object_modelling::alignment
{
namespace
{
registration::PartialModel part(const std::string& id)
{
  registration::PartialModel result;
  result.session_id = id;
  return result;
}

AlignmentEdge edge(const std::string& a, const std::string& b, const Eigen::Vector3d& t, double probability,
                   bool accepted = true)
{
  PairCandidate candidate;
  candidate.T_a_b.translation() = t;
  candidate.quality.probability = probability;
  return { a, b, Decision::AUTOMATIC, accepted, false, accepted ? "" : "overlap 3 % below 12 %", { candidate } };
}

AlignmentResult place(const std::vector<registration::PartialModel>& parts, const std::vector<AlignmentEdge>& edges)
{
  return placeSessions(parts, 0.57, edges);
}

AlignmentResult align(const std::vector<registration::PartialModel>& parts)
{
  base::JobControl control;
  return alignSessions(parts, {}, {}, control);
}

TEST(SessionAlignment, PlacesOneSessionAtIdentity)
{
  const AlignmentResult result = align({ part("mug_1") });
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  ASSERT_EQ(result.placements.size(), 1u);
  EXPECT_EQ(result.placements[0].session_id, "mug_1");
  EXPECT_TRUE(result.placements[0].T_reference_session.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(result.edges.empty());
}

TEST(SessionAlignment, PlacesByTheMostProbableEdges)
{
  // The direct edge from a to c is off by 4 mm, which the cycle allows, and is the least probable.
  const AlignmentResult result = place(
      { part("a"), part("b"), part("c") },
      { edge("a", "b", { 1, 0, 0 }, 0.9), edge("a", "c", { 1.004, 2, 0 }, 0.6), edge("b", "c", { 0, 2, 0 }, 0.8) });
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.status.message.empty()) << result.status.message;
  ASSERT_EQ(result.placements.size(), 3u);
  EXPECT_TRUE(result.placements[2].T_reference_session.translation().isApprox(Eigen::Vector3d(1, 2, 0)));
  EXPECT_TRUE(result.edges[0].used);
  EXPECT_FALSE(result.edges[1].used);
  EXPECT_TRUE(result.edges[2].used);
}

TEST(SessionAlignment, LeavesOutWhatConnectsToNothingAndSaysWhy)
{
  const AlignmentResult result = place({ part("a"), part("b"), part("c") },
                                       { edge("a", "b", { 1, 0, 0 }, 0.9), edge("a", "c", { 1, 0, 0 }, 0.1, false),
                                         edge("b", "c", { 1, 0, 0 }, 0.1, false) });
  EXPECT_TRUE(result.status.ok());
  EXPECT_EQ(result.placements.size(), 2u);
  EXPECT_EQ(result.left_out, std::vector<std::string>{ "c" });
  EXPECT_NE(result.status.message.find("'c'"), std::string::npos) << result.status.message;
  EXPECT_NE(result.status.message.find("overlap 3 % below 12 %"), std::string::npos) << result.status.message;
}

TEST(SessionAlignment, TakesTheLargestConnectedPart)
{
  const AlignmentResult result = place({ part("a"), part("b"), part("c") },
                                       { edge("a", "b", { 1, 0, 0 }, 0.1, false),
                                         edge("a", "c", { 1, 0, 0 }, 0.1, false), edge("b", "c", { 3, 0, 0 }, 0.9) });
  ASSERT_EQ(result.placements.size(), 2u);
  EXPECT_EQ(result.placements[0].session_id, "b");
  EXPECT_TRUE(result.placements[0].T_reference_session.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_EQ(result.left_out, std::vector<std::string>{ "a" });
}

TEST(SessionAlignment, RefusesWhereNoTwoConnect)
{
  const AlignmentResult result = place({ part("a"), part("b") }, { edge("a", "b", { 1, 0, 0 }, 0.1, false) });
  EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(result.status.message.find("overlap 3 % below 12 %"), std::string::npos) << result.status.message;
  EXPECT_TRUE(result.placements.empty()) << "unaligned sessions must not be placed";
}

TEST(SessionAlignment, LeavesOutTheEdgeThatContradictsCertainOnes)
{
  const AlignmentResult result =
      place({ part("a"), part("b"), part("c") },
            { edge("a", "b", { 1, 0, 0 }, 0.99), edge("a", "c", { 5, 0, 0 }, 0.6), edge("b", "c", { 0, 2, 0 }, 0.98) });
  EXPECT_EQ(result.placements.size(), 3u);
  EXPECT_NE(result.edges[1].reason.find("contradicts"), std::string::npos) << result.edges[1].reason;
}

TEST(SessionAlignment, DoesNotTrustAWeakEdgeThatAnotherContradicts)
{
  const AlignmentResult result =
      place({ part("a"), part("b"), part("c") },
            { edge("a", "b", { 1, 0, 0 }, 0.99), edge("a", "c", { 5, 0, 0 }, 0.6), edge("b", "c", { 0, 2, 0 }, 0.7) });
  EXPECT_EQ(result.placements.size(), 2u) << "one of the two edges to c is wrong, and neither is certain";
  EXPECT_EQ(result.left_out, std::vector<std::string>{ "c" });
}

TEST(SessionAlignment, MeasuresCyclesWhereTheObjectIs)
{
  // One degree is 17 mm at the camera, 1 m away, and nothing at the object.
  std::vector<registration::PartialModel> parts = { part("a"), part("b"), part("c") };
  parts[2].points = { { -0.05F, 0, 1 }, { 0.05F, 0, 1 } };
  AlignmentEdge turned = edge("a", "c", { 0, 0, 0 }, 0.6);
  turned.candidates[0].T_a_b = Eigen::Translation3d(0, 0, 1) * Eigen::AngleAxisd(0.0175, Eigen::Vector3d::UnitX()) *
                               Eigen::Translation3d(0, 0, -1);
  const AlignmentResult result =
      place(parts, { edge("a", "b", { 0, 0, 0 }, 0.8), turned, edge("b", "c", { 0, 0, 0 }, 0.7) });
  EXPECT_EQ(result.placements.size(), 3u) << result.status.message;
}

TEST(SessionAlignment, LetsACycleCloseByAnEquivalentPose)
{
  // As of a plain can: the direct edge holds half a turn for as good as none, and took the other one.
  AlignmentEdge ambiguous = edge("a", "c", { 0, 0, 0 }, 0.6);
  ambiguous.candidates.push_back(ambiguous.candidates[0]);
  ambiguous.candidates[0].T_a_b.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const std::vector<AlignmentEdge> edges = { edge("a", "b", { 0, 0, 0 }, 0.8), ambiguous,
                                             edge("b", "c", { 0, 0, 0 }, 0.7) };
  EXPECT_EQ(place({ part("a"), part("b"), part("c") }, edges).placements.size(), 3u);
  std::vector<AlignmentEdge> decided = edges;
  decided[1].candidates[1].quality.probability = 0.001;
  EXPECT_EQ(place({ part("a"), part("b"), part("c") }, decided).placements.size(), 2u);
}

TEST(SessionAlignment, LetsTwoRefusedPairsCarryEachOther)
{
  // Neither is certain enough alone, but it would be chance if they agreed and were wrong.
  const std::vector<AlignmentEdge> edges = { edge("a", "b", { 1, 0, 0 }, 0.95), edge("a", "c", { 1, 2, 0 }, 0.4, false),
                                             edge("b", "c", { 0, 2, 0 }, 0.3, false) };
  const AlignmentResult agreeing = place({ part("a"), part("b"), part("c") }, edges);
  ASSERT_EQ(agreeing.placements.size(), 3u) << agreeing.status.message;
  EXPECT_TRUE(agreeing.placements[2].T_reference_session.translation().isApprox(Eigen::Vector3d(1, 2, 0)));
  EXPECT_TRUE(agreeing.edges[1].accepted);
  EXPECT_TRUE(agreeing.edges[1].reason.empty()) << agreeing.edges[1].reason;
  std::vector<AlignmentEdge> apart = edges;
  apart[2].candidates[0].T_a_b.translation().y() = 3;
  EXPECT_EQ(place({ part("a"), part("b"), part("c") }, apart).placements.size(), 2u);
}

TEST(SessionAlignment, TakesTheOtherPoseOfAPairThatTwoOthersContradict)
{
  // The pair of a and b is sure of a wrong pose; what it holds for hardly possible closes the cycle.
  AlignmentEdge wrong = edge("a", "b", { 5, 0, 0 }, 0.97);
  wrong.candidates.push_back(edge("a", "b", { 1, 0, 0 }, 0.02).candidates[0]);
  const AlignmentResult result = place({ part("a"), part("b"), part("c") },
                                       { wrong, edge("a", "c", { 1, 2, 0 }, 0.96), edge("b", "c", { 0, 2, 0 }, 0.95) });
  ASSERT_EQ(result.placements.size(), 3u) << result.status.message;
  EXPECT_TRUE(result.placements[1].T_reference_session.translation().isApprox(Eigen::Vector3d(1, 0, 0)));
  EXPECT_TRUE(result.edges[0].best()->T_a_b.translation().isApprox(Eigen::Vector3d(1, 0, 0))) << "it is right by that";
}

TEST(SessionAlignment, FindsTheWrongPairAmongFourSessions)
{
  std::vector<AlignmentEdge> edges;
  const std::vector<std::string> ids = { "a", "b", "c", "d" };
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      edges.push_back(edge(ids[i], ids[j], { j - i + 0.0, 0, 0 }, 0.9));
  for (AlignmentEdge& wrong : edges)
  {
    const AlignmentEdge right = wrong;
    wrong.candidates[0].T_a_b.translation().z() = 4;
    wrong.candidates[0].quality.probability = 0.99;
    const AlignmentResult result = place({ part("a"), part("b"), part("c"), part("d") }, edges);
    ASSERT_EQ(result.placements.size(), 4u) << wrong.session_a << wrong.session_b;
    for (int i = 0; i < 4; ++i)
      EXPECT_TRUE(result.placements[i].T_reference_session.translation().isApprox(Eigen::Vector3d(i, 0, 0), 1e-9));
    wrong = right;
  }
}

TEST(SessionAlignment, LetsAPersonDecide)
{
  // Against a certain edge, and with figures that speak against it.
  AlignmentEdge accepted = edge("a", "c", { 5, 0, 0 }, 0.01);
  accepted.decision = Decision::ACCEPTED;
  const AlignmentResult result =
      place({ part("a"), part("b"), part("c") },
            { edge("a", "b", { 1, 0, 0 }, 0.99), accepted, edge("b", "c", { 0, 2, 0 }, 0.98) });
  ASSERT_EQ(result.placements.size(), 3u);
  EXPECT_EQ(result.placements[2].T_reference_session.translation(), Eigen::Vector3d(5, 0, 0));
  EXPECT_NE(result.edges[2].reason.find("contradicts"), std::string::npos) << result.edges[2].reason;
}

TEST(SessionAlignment, TakesKnownEdgesInEitherOrderAndForgetsTheirOldReasons)
{
  AlignmentEdge known = edge("b", "a", { -1, 0, 0 }, 0.9);
  known.reason = "left out: contradicts something";
  const AlignmentResult result = place({ part("a"), part("b") }, { known });
  ASSERT_EQ(result.placements.size(), 2u);
  EXPECT_TRUE(result.placements[1].T_reference_session.translation().isApprox(Eigen::Vector3d(1, 0, 0)));
  EXPECT_TRUE(result.edges[0].reason.empty()) << result.edges[0].reason;
}

TEST(SessionAlignment, RefusesNoSessionAndOneTwice)
{
  EXPECT_EQ(align({}).status.code, base::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(align({ part("a"), part("a") }).status.code, base::StatusCode::INVALID_ARGUMENT);
}

TEST(SessionAlignment, StopsWhenCancelled)
{
  base::JobControl control;
  control.cancel();
  EXPECT_THROW(alignSessions({ part("mug_1") }, {}, {}, control), base::Cancelled);
}

}  // namespace
}  // namespace object_modelling::alignment
