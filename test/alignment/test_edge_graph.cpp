#include "edge_graph.h"

#include <gtest/gtest.h>

#include "session_scene.h"
#include "support/transform_matchers.h"

namespace object_modelling::alignment
{
namespace
{
class EdgeGraphOfThree : public SessionsOfAnObject
{
protected:
  EdgeGraphOfThree() : SessionsOfAnObject(3) {}
  EdgeGraph graphOf() const { return { parts_, MIN_PROBABILITY, edges_ }; }
  std::vector<AlignmentEdge> edges_ = { edge(0, 1, 0.9), edge(2, 1, 0.8), refused(0, 2) };
};

TEST_F(EdgeGraphOfThree, GoesAlongAnEdgeEitherWay)
{
  const EdgeGraph graph = graphOf();
  const Eigen::Isometry3d T_reference_a = turned(0.4) * Eigen::Translation3d(1, 2, 3);
  const Eigen::Isometry3d T_reference_b = graph.along(0, 0, 1, T_reference_a);
  EXPECT_TRANSFORM_NEAR(T_reference_b, T_reference_a * truth(0, 1), 1e-12, 1e-7);
  EXPECT_TRANSFORM_NEAR(graph.along(0, 0, 0, T_reference_b), T_reference_a, 1e-12, 1e-7);
  EXPECT_TRANSFORM_NEAR(graph.along(1, 0, 2, T_reference_b), T_reference_a * truth(0, 2), 1e-12, 1e-7);
  EXPECT_EQ(graph.otherEnd(1, 1), 2);
  EXPECT_EQ(graph.otherEnd(1, 2), 1);
}

TEST_F(EdgeGraphOfThree, PosesDifferByWhatTheObjectMoves)
{
  const EdgeGraph graph = graphOf();
  const Eigen::Isometry3d T = truth(0, 1), T_b_object = T_session_object_[1];
  const PoseDifference turn = graph.between(T, T * T_b_object * turned(0.3) * T_b_object.inverse(), 1);
  EXPECT_NEAR(turn.rotation_rad, 0.3, 1e-6);
  EXPECT_NEAR(turn.translation_m, 0, 1e-6) << "about its centre, 0.8 m from the camera";
  const PoseDifference shift = graph.between(T, T * T_b_object * shifted(0.02) * T_b_object.inverse(), 1);
  EXPECT_NEAR(shift.rotation_rad, 0, 1e-6);
  EXPECT_NEAR(shift.translation_m, 0.02, 1e-6);
  EXPECT_EQ((PoseDifference{ 0.3, 0.0204 }).text(), "17 deg and 20 mm");
  EXPECT_TRUE((PoseDifference{ 0.089, 0.0099 }).small());
  EXPECT_FALSE((PoseDifference{ 0.091, 0 }).small());
  EXPECT_FALSE((PoseDifference{ 0, 0.0101 }).small());
}

TEST_F(EdgeGraphOfThree, BoundsWhatIsProbable)
{
  edges_[0].candidates[0].quality.probability = 1;
  edges_[0].candidates.push_back(edges_[0].candidates[0]);
  edges_[2].candidates[0].quality.probability = 0.99;
  EXPECT_DOUBLE_EQ(graphOf().probability(0, 0), 0.997);
  EXPECT_DOUBLE_EQ(graphOf().doubt(0), 1 - 0.997);
  EXPECT_DOUBLE_EQ(graphOf().probability(1, 0), 0.8);
  EXPECT_DOUBLE_EQ(graphOf().probability(2, 0), 0.9 * MIN_PROBABILITY) << "it was refused";
  EXPECT_EQ(graphOf().candidates(0), 2u);
  edges_[0].decision = Decision::ACCEPTED;
  EXPECT_DOUBLE_EQ(graphOf().probability(0, 0), 1 - 1e-6);
  EXPECT_EQ(graphOf().candidates(0), 1u) << "the one that the person saw";
}

TEST_F(EdgeGraphOfThree, UsesNoEdgeThatAPersonRefusedOrThatHasNoPose)
{
  const Placement placed = { { 0, {} }, { 1, {} } };
  EXPECT_EQ(graphOf().edgesTo(2, placed), (std::vector<int>{ 1, 2 }));
  EXPECT_TRUE(graphOf().edgesTo(2, {}).empty());
  edges_[1].decision = Decision::REFUSED;
  edges_[2].candidates.clear();
  EXPECT_TRUE(graphOf().edgesTo(2, placed).empty());
  EXPECT_EQ(graphOf().edgesTo(1, placed), std::vector<int>{ 0 });
}

TEST_F(EdgeGraphOfThree, AgreesByTheMostProbableOfItsPoses)
{
  edges_[0].candidates = { edge(0, 1, 0.6, turned(1)).candidates[0], edge(0, 1, 0.1, turned(0.05)).candidates[0],
                           edge(0, 1, 0.2).candidates[0], edge(0, 1, 0.01, turned(-1)).candidates[0] };
  const EdgeGraph graph = graphOf();
  EXPECT_EQ(graph.agreeing(0, 1, truth(0, 1), {}), std::optional<std::size_t>(2));
  EXPECT_EQ(graph.agreeing(0, 0, truth(1, 0), {}), std::optional<std::size_t>(2)) << "the other way";
  EXPECT_DOUBLE_EQ(graph.support(0, 2), 0.2 / CHANCE);
  EXPECT_DOUBLE_EQ(graph.support(0, std::nullopt), 0.4) << "that none of its poses is right";
  // 0.01 / 0.05 is less than the doubt in the best one, 0.4.
  const AlignmentEdge unlikely = edge(0, 1, 0.01, turned(-1));
  EXPECT_EQ(graph.agreeing(0, 1, unlikely.candidates[0].T_a_b, {}), std::nullopt);
  EXPECT_EQ(graph.agreeing(0, 1, truth(0, 1) * Eigen::Translation3d(0.1, 0, 0), {}), std::nullopt);
}

}  // namespace
}  // namespace object_modelling::alignment
