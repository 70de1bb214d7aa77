#include <cmath>

#include <gtest/gtest.h>

#include "cycle_poses.h"
#include "session_scene.h"
#include "support/transform_matchers.h"

namespace object_modelling::alignment
{
namespace
{
constexpr int FOLD = 4;
constexpr double OWN = 0.24;  // probability of each pose by itself

Eigen::Isometry3d aboutZ(double angle_rad)
{
  return Eigen::Isometry3d(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()));
}

/// An object that quarter turns about its z axis leave as it is, or all turns do.
class SymmetricSessions : public SessionsOfAnObject
{
protected:
  SymmetricSessions() : SessionsOfAnObject(12) {}

  /// Poses that probably make the same object, the first one turned by `turn_rad`, as decide() gives them.
  AlignmentEdge fourfold(int a, int b, double turn_rad, double same = 0.9,
                         const Eigen::Isometry3d& T_off = Eigen::Isometry3d::Identity()) const
  {
    AlignmentEdge result = edge(a, b, 0);
    result.candidates.clear();
    const double together = OWN * (1 + same * (FOLD - 1));
    for (int k = 0; k < FOLD; ++k)
    {
      PairCandidate pose = edge(a, b, together, T_off * aboutZ(turn_rad + k * 2 * M_PI / FOLD)).candidates[0];
      if (k > 0)
        pose.quality.probability = OWN + same * (together - OWN);
      pose.same_object_probability = k == 0 ? 1 : same;
      result.candidates.push_back(pose);
    }
    return result;
  }
  /// Every pair leads with another quarter turn.
  std::vector<AlignmentEdge> fourfoldPairs(int count, double same) const
  {
    std::vector<AlignmentEdge> edges;
    for (int i = 0; i < count; ++i)
      for (int j = i + 1; j < count; ++j)
        edges.push_back(fourfold(i, j, static_cast<double>(i + j * j) * M_PI / 2, same));
    return edges;
  }
  AlignmentResult place(int count, const std::vector<AlignmentEdge>& edges)
  {
    parts_.resize(count);
    return placeSessions(parts_, 0.85, edges);
  }
  /// Where a placed session has the object, but for turns about its axis.
  void expectTruthButForTurns(const AlignmentResult& result, double step_rad) const
  {
    const int reference = result.placements[0].session_id[0] - 'a';
    for (const SessionPlacement& placed : result.placements)
    {
      const Eigen::Isometry3d T = T_session_object_[reference].inverse() * placed.T_reference_session *
                                  T_session_object_[placed.session_id[0] - 'a'];
      const double turn_rad = std::atan2(T(1, 0), T(0, 0));
      EXPECT_TRANSFORM_NEAR(T, aboutZ(turn_rad), 1e-9, 1e-6);
      EXPECT_NEAR(std::remainder(turn_rad, step_rad), 0, 1e-6);
    }
  }
};

TEST_F(SymmetricSessions, ArePlacedThoughEveryPairPrefersAnotherTurn)
{
  for (const int count : { 4, 3 })
  {
    const AlignmentResult result = place(count, fourfoldPairs(count, 0.9));
    EXPECT_EQ(result.placements.size(), static_cast<std::size_t>(count)) << result.status.message;
    expectTruthButForTurns(result, 2 * M_PI / FOLD);
    for (const AlignmentEdge& edge : result.edges)
      EXPECT_TRUE(edge.reason.empty()) << edge.reason;
  }
}

TEST_F(SymmetricSessions, PosesOfOneProbabilityThatMakeOtherObjectsAreRivals)
{
  std::vector<AlignmentEdge> edges = { fourfold(0, 1, 0), fourfold(1, 2, 0) };
  EXPECT_EQ(place(3, edges).placements.size(), 3u);
  for (AlignmentEdge& edge : edges)
    for (std::size_t k = 1; k < FOLD; ++k)
      edge.candidates[k].same_object_probability = 0;
  EXPECT_EQ(place(3, edges).placements.size(), 2u) << "nothing tells which";
}

TEST_F(SymmetricSessions, AWrongPairIsFoundOut)
{
  for (std::size_t wrong = 0; wrong < 6; ++wrong)
  {
    std::vector<AlignmentEdge> edges = fourfoldPairs(4, 0.9);
    const int a = edges[wrong].session_a[0] - 'a', b = edges[wrong].session_b[0] - 'a';
    edges[wrong] = fourfold(a, b, 0, 0.9, turned(1));
    const AlignmentResult result = place(4, edges);
    EXPECT_EQ(result.placements.size(), 4u) << result.status.message;
    expectTruthButForTurns(result, 2 * M_PI / FOLD);
    EXPECT_FALSE(result.edges[wrong].used);
    EXPECT_NE(result.edges[wrong].reason.find("contradicts"), std::string::npos) << result.edges[wrong].reason;
  }
}

/// Three sessions of a can, of which each pair found one turn, and a to c what the others imply too.
class SessionsOfACan : public SymmetricSessions
{
protected:
  AlignmentResult placed(double implied_probability, double same)
  {
    std::vector<AlignmentEdge> edges = { edge(0, 1, 0.93, aboutZ(0.4)), edge(1, 2, 0.93, aboutZ(0.9)),
                                         edge(0, 2, 0.93, aboutZ(2)) };
    for (AlignmentEdge& found : edges)
      found.candidates[0].same_object_probability = 1;
    PairCandidate implied = edge(0, 2, implied_probability, aboutZ(1.3)).candidates[0];
    implied.kind = ProposalKind::CYCLE;
    implied.same_object_probability = same;
    edges[2].candidates.push_back(implied);
    return place(3, edges);
  }
};

TEST_F(SessionsOfACan, ArePlacedByAnImpliedPoseThatTheSurfacesBearOut)
{
  const AlignmentResult result = placed(0.9 * 0.93, 0.9);
  EXPECT_EQ(result.placements.size(), 3u) << result.status.message;
  expectTruthButForTurns(result, 1e-9);
}

TEST_F(SessionsOfACan, AreNotPlacedByAnImpliedPoseThatTheSurfacesContradict)
{
  for (const double probability : { 0.06, 0.01, 0.0 })
  {
    const AlignmentResult result = placed(probability, 0);
    EXPECT_EQ(result.placements.size(), 2u) << probability << ": one of the three is wrong, and nothing tells which";
  }
}

TEST_F(SymmetricSessions, AnImpliedPoseBearsOutByItsOwnEvidenceOnly)
{
  // That two that were found agree would be chance; that an implied one agrees is not.
  std::vector<AlignmentEdge> edges = { edge(0, 1, 0.95), edge(0, 2, 0.6), edge(1, 2, 0.6) };
  EXPECT_EQ(place(3, edges).placements.size(), 3u);
  edges[2].candidates[0].kind = ProposalKind::CYCLE;
  EXPECT_EQ(place(3, edges).placements.size(), 2u);
  const EdgeGraph graph(parts_, 0.85, edges);
  EXPECT_DOUBLE_EQ(graph.support(1, 0), 0.6 / CHANCE);
  EXPECT_DOUBLE_EQ(graph.support(2, 0), 0.6);
}

TEST_F(SymmetricSessions, TellsWhatAPoseHasByItself)
{
  const std::vector<AlignmentEdge> edges = { fourfold(0, 1, 0, 0.8), edge(1, 2, 0.9) };
  const EdgeGraph graph(parts_, 0.85, edges);
  for (std::size_t k = 0; k < FOLD; ++k)
    EXPECT_NEAR(graph.ownProbability(0, k), OWN, 1e-12);
  EXPECT_NEAR(graph.noneProbability(0), 1 - FOLD * OWN, 1e-12);
  EXPECT_DOUBLE_EQ(graph.sameObjectProbability(0, 2, 2), 1);
  EXPECT_DOUBLE_EQ(graph.sameObjectProbability(0, 0, 2), 0.8);
  EXPECT_DOUBLE_EQ(graph.sameObjectProbability(0, 1, 2), 0.8 * 0.8);
  EXPECT_DOUBLE_EQ(graph.ownProbability(1, 0), 0.9);
  EXPECT_NEAR(graph.noneProbability(1), 0.1, 1e-12);
}

TEST_F(SymmetricSessions, TwoPairsImplyThePoseOfTheThird)
{
  // Either order of the sessions of a pair.
  std::vector<AlignmentEdge> edges = { edge(0, 1, 0.9, aboutZ(0.4)), edge(2, 1, 0.9), edge(0, 2, 0.9, aboutZ(2)) };
  const auto implied = [&] { return cyclePoses(EdgeGraph(parts_, 0.85, edges)); };
  ASSERT_EQ(implied()[2].size(), 1u);
  EXPECT_TRANSFORM_NEAR(implied()[2][0], edge(0, 2, 1, aboutZ(0.4)).candidates[0].T_a_b, 1e-9, 1e-9);
  EXPECT_EQ(implied()[0].size(), 1u);
  EXPECT_EQ(implied()[1].size(), 1u);
  edges[2].decision = Decision::ACCEPTED;
  EXPECT_TRUE(implied()[2].empty()) << "a person decided";
  EXPECT_EQ(implied()[0].size(), 1u);
  edges[2].decision = Decision::REFUSED;
  EXPECT_TRUE(implied()[0].empty()) << "the two are not to be joined";
  edges[2] = edge(0, 2, 0.9, aboutZ(0.42));
  EXPECT_TRUE(implied()[2].empty()) << "it has that pose";
  edges[2] = edge(0, 2, 0.9, aboutZ(2));
  edges[1].candidates[0].quality.probability = 0.2;
  EXPECT_TRUE(implied()[2].empty()) << "it is improbable";
}

TEST_F(SymmetricSessions, TheMostProbableImpliedPosesAreTaken)
{
  std::vector<AlignmentEdge> edges = { edge(0, 1, 0.9, aboutZ(3)) };
  for (int i = 2; i < 12; ++i)
  {
    edges.push_back(edge(0, i, 0.7 + 0.01 * i, aboutZ(0.2 * i)));
    edges.push_back(edge(i, 1, 0.9));
  }
  const std::vector<Eigen::Isometry3d> poses = cyclePoses(EdgeGraph(parts_, 0.85, edges))[0];
  ASSERT_EQ(poses.size(), 8u);
  for (int k = 0; k < 8; ++k)
    EXPECT_TRANSFORM_NEAR(poses[k], edge(0, 1, 1, aboutZ(0.2 * (11 - k))).candidates[0].T_a_b, 1e-9, 1e-9);
}

}  // namespace
}  // namespace object_modelling::alignment
