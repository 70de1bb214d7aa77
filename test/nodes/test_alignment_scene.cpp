#include "nodes/jobs/alignment_scene.h"

#include <gtest/gtest.h>

namespace object_modelling::nodes
{
namespace
{
/// A plate of 6 x 10 cm that stands 0.8 m before the camera.
std::shared_ptr<registration::PartialModel> plate(const std::string& session_id)
{
  auto part = std::make_shared<registration::PartialModel>();
  part->session_id = session_id;
  part->spacing_m = 0.002;
  part->support_plane = geometry::Plane{ Eigen::Vector3d(0, -1, 0), 0.05 };
  for (int x = -15; x <= 15; ++x)
    for (int y = -25; y <= 25; ++y)
    {
      part->points.emplace_back(0.002F * static_cast<float>(x), 0.002F * static_cast<float>(y), 0.8F);
      part->normals.emplace_back(0, 0, -1);
      part->colors_rgb.emplace_back(200, 100, 50);
    }
  return part;
}

alignment::AlignmentEdge edge(std::size_t candidates)
{
  alignment::AlignmentEdge result;
  result.session_a = "mug_1";
  result.session_b = "mug_2";
  result.candidates.resize(candidates);
  return result;
}

bool anyLabel(const AlignmentScene& scene, const std::string& text)
{
  for (const AlignmentScene::Label& label : scene.labels())
    if (label.text.find(text) != std::string::npos)
      return true;
  return false;
}
}  // namespace

TEST(AlignmentScene, ShowsBothAloneAndTheBestThreeTogether)
{
  const auto a = plate("mug_1"), b = plate("mug_2");
  for (const std::size_t candidates : { 0, 1, 5 })
  {
    const AlignmentScene scene(a, b, edge(candidates));
    EXPECT_EQ(scene.points().size(), 2 * (1 + std::min<std::size_t>(3, candidates)) * a->points.size());
    EXPECT_EQ(scene.colors().size(), scene.points().size());
    EXPECT_TRUE(anyLabel(scene, "mug_1") && anyLabel(scene, "mug_2"));
    EXPECT_EQ(anyLabel(scene, "2: "), candidates > 2);
    EXPECT_FALSE(anyLabel(scene, "3: "));
    EXPECT_FALSE(anyLabel(scene, "CHOSEN"));
  }
}

TEST(AlignmentScene, TellsWhatWasChosenOrWhyNothing)
{
  alignment::AlignmentEdge chosen = edge(2);
  chosen.accepted = true;
  chosen.decision = alignment::Decision::ACCEPTED;
  EXPECT_TRUE(anyLabel(AlignmentScene(plate("mug_1"), plate("mug_2"), chosen), "CHOSEN by a person"));
  alignment::AlignmentEdge refused = edge(1);
  refused.reason = "overlap 9 % below 15 %";
  EXPECT_TRUE(anyLabel(AlignmentScene(plate("mug_1"), plate("mug_2"), refused), "overlap 9 % below 15 %"));
}

TEST(AlignmentScene, TellsWhatWasClickedOn)
{
  const AlignmentScene scene(plate("mug_1"), plate("mug_2"), edge(1));
  for (const bool in_a : { true, false })
    for (const Eigen::Vector3d& p : { Eigen::Vector3d(0.03, 0.05, 0.8), Eigen::Vector3d(-0.02, 0.01, 0.8) })
    {
      const Eigen::Vector3d shown = scene.displayed({ in_a, p });
      const auto spot = scene.spotAt(shown + Eigen::Vector3d(0, 0.003, 0));
      ASSERT_TRUE(spot);
      EXPECT_EQ(spot->in_a, in_a);
      EXPECT_LT((spot->p_session - p).norm(), 0.003);
    }
  EXPECT_GT(scene.displayed({ true, { 0, -0.05, 0.8 } }).z(), scene.displayed({ true, { 0, 0.05, 0.8 } }).z())
      << "up as it stood";
  EXPECT_FALSE(scene.spotAt(Eigen::Vector3d::Zero())) << "candidates are not clicked on";
  EXPECT_FALSE(scene.spotAt({ 5, 5, 5 }));
}

}  // namespace object_modelling::nodes
