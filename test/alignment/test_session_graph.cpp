#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "session_scene.h"
#include "support/transform_matchers.h"

namespace object_modelling::alignment
{
namespace
{
class SessionGraph : public SessionsOfAnObject
{
protected:
  /// All pairs, each in one of its two orders.
  std::vector<AlignmentEdge> allPairs(double probability) const
  {
    std::vector<AlignmentEdge> edges;
    for (int i = 0; i < static_cast<int>(parts_.size()); ++i)
      for (int j = i + 1; j < static_cast<int>(parts_.size()); ++j)
        edges.push_back((i + j) % 2 ? edge(i, j, probability) : edge(j, i, probability));
    return edges;
  }
  /// a to b, b to c, ... and back to a.
  std::vector<AlignmentEdge> ring(int count, double probability) const
  {
    std::vector<AlignmentEdge> edges;
    for (int i = 0; i < count; ++i)
      edges.push_back(edge(i, (i + 1) % count, probability));
    return edges;
  }

  AlignmentResult place(const std::vector<AlignmentEdge>& edges) const
  {
    return placeSessions(parts_, MIN_PROBABILITY, edges);
  }
  /// All that are placed are where they are in truth, in the frame of the first.
  void expectTruth(const AlignmentResult& result, std::size_t count) const
  {
    ASSERT_EQ(result.placements.size(), count) << result.status.message;
    const int reference = result.placements[0].session_id[0] - 'a';
    for (const SessionPlacement& placed : result.placements)
      EXPECT_TRANSFORM_NEAR(placed.T_reference_session, truth(reference, placed.session_id[0] - 'a'), 1e-9, 1e-9);
  }
};

TEST_F(SessionGraph, PlacesSixSessionsFromAllTheirPairs)
{
  const AlignmentResult result = place(allPairs(0.9));
  expectTruth(result, 6);
  EXPECT_EQ(result.placements[0].session_id, "a");
  EXPECT_EQ(std::count_if(result.edges.begin(), result.edges.end(), [](const AlignmentEdge& e) { return e.used; }), 5)
      << "a tree";
  for (const AlignmentEdge& edge : result.edges)
    EXPECT_TRUE(edge.accepted && edge.reason.empty()) << edge.reason;
}

TEST_F(SessionGraph, SessionInDoubtIsJoinedByAPersonAlone)
{
  parts_[2].doubt = "where the camera was is not known";
  std::vector<AlignmentEdge> edges = allPairs(0.95);
  for (AlignmentEdge& edge : edges)
    if (edge.session_a == "c" || edge.session_b == "c")
    {
      edge.accepted = false;
      edge.reason = parts_[2].doubt;
    }
  const AlignmentResult result = place(edges);
  expectTruth(result, 5);
  EXPECT_EQ(result.left_out, (std::vector<std::string>{ "c" })) << "though five pairs agree";
  EXPECT_NE(result.status.message.find(parts_[2].doubt), std::string::npos) << result.status.message;
  for (AlignmentEdge& edge : edges)
    if (edge.session_a == "c" && edge.session_b == "a")
      edge.decision = Decision::ACCEPTED;
  const AlignmentEdge* accepted = nullptr;
  for (const AlignmentEdge& edge : edges)
    if (edge.decision == Decision::ACCEPTED)
      accepted = &edge;
  ASSERT_TRUE(accepted);
  expectTruth(place(edges), 6);
}

TEST_F(SessionGraph, PlacesAChainThatNothingElseHolds)
{
  std::vector<AlignmentEdge> chain = ring(6, 0.8);
  chain.pop_back();
  expectTruth(place(chain), 6);
  chain[2].candidates[0].quality.probability = 0.5;
  const AlignmentResult broken = place(chain);
  expectTruth(broken, 3);
  EXPECT_EQ(broken.left_out.size(), 3u) << "the longer half alone is placed";
}

TEST_F(SessionGraph, FindsTheWrongPairAmongFifteen)
{
  const std::vector<AlignmentEdge> right = allPairs(0.9);
  for (std::size_t i = 0; i < right.size(); ++i)
  {
    std::vector<AlignmentEdge> edges = right;
    PairCandidate& wrong = edges[i].candidates[0];
    wrong.T_a_b = wrong.T_a_b * shifted(0.05) * turned(i % 2 ? 1.0 : 0.0);
    wrong.quality.probability = 0.99;
    const AlignmentResult result = place(edges);
    expectTruth(result, 6);
    EXPECT_FALSE(result.edges[i].used);
    EXPECT_NE(result.edges[i].reason.find("contradicts the more certain"), std::string::npos) << result.edges[i].reason;
  }
}

TEST_F(SessionGraph, OutvotesTwoPairsThatAgreeOnAWrongPose)
{
  // Two of the five pairs of f say that it is turned by 60 deg, each with more certainty than the three others.
  std::vector<AlignmentEdge> edges = allPairs(0.9);
  int wrong = 0;
  for (AlignmentEdge& edge : edges)
    if ((edge.session_a == "f" || edge.session_b == "f") && wrong < 2)
    {
      const bool first = edge.session_a == "f";
      const int other = (first ? edge.session_b : edge.session_a)[0] - 'a';
      edge = this->edge(other, 5, 0.95, turned(M_PI / 3));
      ++wrong;
    }
  expectTruth(place(edges), 6);
}

TEST_F(SessionGraph, OneWrongPairInTwoTriangles)
{
  // a to b is in both: c and d each bear witness against it.
  const std::vector<AlignmentEdge> edges = { edge(0, 1, 0.97, turned(1)), edge(0, 2, 0.95), edge(1, 2, 0.95),
                                             edge(0, 3, 0.95), edge(1, 3, 0.95) };
  parts_.resize(4);
  const AlignmentResult result = place(edges);
  expectTruth(result, 4);
  EXPECT_NE(result.edges[0].reason.find("contradicts"), std::string::npos) << result.edges[0].reason;
  EXPECT_NE(result.edges[0].reason.find("57 deg"), std::string::npos) << result.edges[0].reason;
}

TEST_F(SessionGraph, PlacesTheMoreProbableOfTwoHalves)
{
  std::vector<AlignmentEdge> edges = { edge(0, 1, 0.9), edge(2, 3, 0.9), edge(3, 4, 0.9), edge(2, 4, 0.9) };
  for (const int a : { 0, 1 })
    for (const int b : { 2, 3, 4 })
      edges.push_back(refused(a, b));
  parts_.resize(5);
  const AlignmentResult result = place(edges);
  expectTruth(result, 3);
  EXPECT_EQ(result.placements[0].session_id, "c");
  EXPECT_EQ(result.left_out, (std::vector<std::string>{ "a", "b" }));
  EXPECT_TRUE(result.status.ok());
  EXPECT_NE(result.status.message.find("sessions 'a', 'b'"), std::string::npos) << result.status.message;
  EXPECT_NE(result.status.message.find("colours disagree"), std::string::npos) << result.status.message;
  EXPECT_FALSE(result.edges[0].used) << "it is right, but of the other half";
  EXPECT_TRUE(result.edges[0].accepted);
  // One edge that holds joins the halves.
  edges.back() = edge(1, 4, 0.9);
  expectTruth(place(edges), 5);
}

TEST_F(SessionGraph, JoinsTwoSureHalvesByNoLessThanOneSession)
{
  // Inside either half all bear each other out. What joins the halves must be as probable by itself.
  const std::vector<AlignmentEdge> halves = { edge(0, 1, 0.95), edge(1, 2, 0.95), edge(2, 0, 0.95),
                                              edge(3, 4, 0.97), edge(4, 5, 0.97), edge(5, 3, 0.97) };
  const auto bridged = [&](int count, double probability, bool accepted)
  {
    std::vector<AlignmentEdge> edges = halves;
    for (int i = 0; i < count; ++i)
    {
      edges.push_back(edge(2 - i, 3 + i, probability));
      edges.back().accepted = accepted;
      edges.back().reason = accepted ? "" : "two poses score alike";
    }
    return place(edges);
  };
  for (const double probability : { 0.1, 0.3, 0.5 })
  {
    const AlignmentResult one = bridged(1, probability, false);
    expectTruth(one, 3);
    EXPECT_EQ(one.left_out, (std::vector<std::string>{ "a", "b", "c" }));
    EXPECT_FALSE(one.edges.back().accepted) << probability;
    EXPECT_NE(one.status.message.find("two poses score alike"), std::string::npos) << one.status.message;
  }
  expectTruth(bridged(1, 0.6, true), 6);
  expectTruth(bridged(2, 0.4, false), 6);
}

TEST_F(SessionGraph, LeavesOutWhereARingContradictsItself)
{
  // Each edge may be the wrong one: no more than four of five are sure.
  std::vector<AlignmentEdge> edges = ring(5, 0.8);
  parts_.resize(5);
  edges[2] = edge(2, 3, 0.8, shifted(0.05));
  const AlignmentResult doubtful = place(edges);
  EXPECT_EQ(doubtful.placements.size() + doubtful.left_out.size(), 5u);
  EXPECT_FALSE(doubtful.left_out.empty());
  EXPECT_NE(doubtful.status.message.find("none is certain"), std::string::npos) << doubtful.status.message;
  // Where the wrong one is the weakest, the others hold the ring.
  for (AlignmentEdge& edge : edges)
    edge.candidates[0].quality.probability = 0.98;
  edges[2].candidates[0].quality.probability = 0.6;
  const AlignmentResult sure = place(edges);
  expectTruth(sure, 5);
  EXPECT_NE(sure.edges[2].reason.find("contradicts"), std::string::npos) << sure.edges[2].reason;
}

TEST_F(SessionGraph, ClosesARingWithinItsTolerance)
{
  parts_.resize(4);
  for (const auto& [off_m, closes] : { std::pair(0.009, true), { 0.011, false } })
  {
    std::vector<AlignmentEdge> edges = ring(4, 0.9);
    edges[3] = edge(3, 0, 0.6, shifted(off_m));
    const AlignmentResult result = place(edges);
    ASSERT_EQ(result.edges[3].session_a, "d");
    EXPECT_TRUE(result.left_out.empty()) << "the three others are sure";
    EXPECT_EQ(result.edges[3].reason.empty(), closes) << off_m << result.edges[3].reason;
  }
}

TEST_F(SessionGraph, DoesNotDependOnTheOrderOfThePairs)
{
  std::vector<AlignmentEdge> edges = allPairs(0.9);
  edges[4].candidates[0].T_a_b = edges[4].candidates[0].T_a_b * turned(2);
  std::mt19937 random(3);
  for (int i = 0; i < 10; ++i)
  {
    std::shuffle(edges.begin(), edges.end(), random);
    expectTruth(place(edges), 6);
  }
}

}  // namespace
}  // namespace object_modelling::alignment
