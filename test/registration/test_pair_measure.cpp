#include "object_modelling/registration/pair_measure.h"

#include <cmath>

#include <gtest/gtest.h>

#include "made_part.h"
#include "object_modelling/registration/pair_figures.h"

namespace object_modelling::registration
{
namespace
{
constexpr int SIDE = 20;  // points along a side of a plate
constexpr float HALF_M = 0.5F * SPACING_M * (SIDE - 1);

/// Rows of a plate that faces the cameras, `in_front_m` before z = 0; `first`: of all its rows.
void addRows(int first, int count, float in_front_m, PartialModel* part)
{
  const Eigen::Vector3f corner(-HALF_M + static_cast<float>(first) * SPACING_M, -HALF_M, -in_front_m);
  addPatch(corner, Y, X, SIDE, count, plain, part);
}

PartialModel plate(float in_front_m = 0)
{
  PartialModel part = madePart();
  addRows(0, SIDE, in_front_m, &part);
  return part;
}

PairQuality measure(const PartialModel& a, const PartialModel& b,
                    const Eigen::Isometry3f& T_a_b = Eigen::Isometry3f::Identity(), bool many = true)
{
  const MatchedSurface part_a(a, 1), part_b(b, 1);
  return measurePair(PartPair(part_a, part_b, 1), T_a_b, many);
}

TEST(FreeSpaceViolation, IsTheShareOfWhatIsLookedThrough)
{
  PartialModel a = plate(), b = madePart();
  a.views = { viewAlongZ(1), viewAlongZ(1) };
  addRows(0, 15, 0, &b);       // 300 points that a sees
  addRows(15, 3, 0.02F, &b);   // 60 in front
  addRows(18, 2, -0.02F, &b);  // 40 hidden, of which nothing is known
  EXPECT_DOUBLE_EQ(measure(a, b).fsv_ratio, 60.0 / 360);
  EXPECT_DOUBLE_EQ(measure(b, a).fsv_ratio, 60.0 / 360);
  // With what b saw of a's 400 points: its wall lies 20 mm farther back, but for the half at x < 0.
  b.views = { viewAlongZ(1.02F), viewAlongZ(1.02F) };
  for (SpaceView& view : b.views)
    view.least_depth_m.colRange(0, 100).setTo(1);
  EXPECT_DOUBLE_EQ(measure(a, b).fsv_ratio, (60.0 + 200) / (360 + 400));
  EXPECT_DOUBLE_EQ(measure(b, a).fsv_ratio, (60.0 + 200) / (360 + 400));
}

TEST(FreeSpaceViolation, OfFewPointsIsTheSameShare)
{
  // 400 points, of which 250 are taken.
  PartialModel a = plate(), b = madePart();
  a.views = { viewAlongZ(1), viewAlongZ(1) };
  addRows(0, 15, 0, &b);
  addRows(15, 5, 0.02F, &b);
  EXPECT_DOUBLE_EQ(measure(a, b).fsv_ratio, 0.25);
  EXPECT_NEAR(measure(a, b, Eigen::Isometry3f::Identity(), false).fsv_ratio, 0.25, 0.004);
}

TEST(FreeSpaceViolation, IsDecidedByMostOfTheViews)
{
  constexpr float THROUGH_M = 1.1F, SAME_M = 1, HIDES_M = 0.9F, NOTHING_M = 0;
  enum Verdict
  {
    UNKNOWN,
    UPHELD,
    LOOKED_THROUGH
  };
  const std::vector<std::pair<std::vector<float>, Verdict>> cases = {
    { {}, UNKNOWN },
    { { THROUGH_M }, UNKNOWN },
    { { THROUGH_M, THROUGH_M }, LOOKED_THROUGH },
    { { THROUGH_M, THROUGH_M, SAME_M }, LOOKED_THROUGH },
    { { THROUGH_M, THROUGH_M, SAME_M, SAME_M }, UPHELD },
    { { THROUGH_M, SAME_M }, UPHELD },
    { { SAME_M }, UPHELD },
    { { HIDES_M, HIDES_M }, UNKNOWN },
    { { THROUGH_M, THROUGH_M, HIDES_M, HIDES_M, HIDES_M }, LOOKED_THROUGH },
    { { SAME_M, HIDES_M, HIDES_M }, UPHELD },
    { { THROUGH_M, NOTHING_M, NOTHING_M }, UNKNOWN },
    { { SAME_M, NOTHING_M, NOTHING_M }, UPHELD },
  };
  for (std::size_t i = 0; i < cases.size(); ++i)
  {
    const Verdict verdict = cases[i].second;
    // Beside the plate of z = 0 the same one 10 cm aside, that every view looks through.
    PartialModel a = plate(), b = plate();
    addPatch({ 0.1F, 0, 0 }, Y, X, SIDE, SIDE, plain, &b);
    a.views = { viewAlongZ(NOTHING_M), viewAlongZ(NOTHING_M) };
    for (SpaceView& view : a.views)
      view.least_depth_m.colRange(110, 200).setTo(THROUGH_M);
    for (const float measured_m : cases[i].first)
    {
      a.views.push_back(viewAlongZ(measured_m));
      a.views.back().least_depth_m.colRange(110, 200).setTo(NOTHING_M);
    }
    EXPECT_DOUBLE_EQ(measure(a, b).fsv_ratio, verdict == UPHELD ? 0.5 : 1) << i;
    EXPECT_EQ(seenThrough(a.views, Eigen::Vector3f::Zero()), verdict == LOOKED_THROUGH) << i;
  }
}

TEST(FreeSpaceViolation, AllowsForNoiseAndRegistration)
{
  for (const double sigma_m : { 0.0, 0.001, 0.004 })
  {
    const auto margin_m = static_cast<float>(3 * sigma_m + 0.004);
    const std::vector<SpaceView> views = { viewAlongZ(1, sigma_m), viewAlongZ(1, sigma_m) };
    EXPECT_FALSE(seenThrough(views, { 0, 0, -margin_m + 1e-4F })) << sigma_m;
    EXPECT_TRUE(seenThrough(views, { 0, 0, -margin_m - 1e-4F })) << sigma_m;
  }
}

TEST(FreeSpaceViolation, TakesNoWordFromAViewThatDoesNotLookThere)
{
  const Eigen::Vector3f p = Eigen::Vector3f::Zero();
  SpaceView behind = viewAlongZ(3), aside = viewAlongZ(3);
  behind.T_camera_session.translation().z() = -1;
  aside.T_camera_session.translation().x() = 0.6F;
  EXPECT_FALSE(seenThrough({ behind, behind }, p));
  EXPECT_FALSE(seenThrough({ aside, aside }, p));
  aside.T_camera_session.translation().x() = 0.4F;
  EXPECT_TRUE(seenThrough({ aside, aside }, p)) << "still in the image";
}

TEST(PairMeasure, OverlapIsTheShareOfThePartThatHasLessBesides)
{
  PartialModel a = madePart(), b = madePart();
  addRows(0, 15, 0, &a);     // 300 points in common
  addRows(15, 5, 0.2F, &a);  // 100 of a alone
  addRows(0, 15, 0, &b);
  addRows(0, 15, -0.2F, &b);  // 300 of b alone
  EXPECT_DOUBLE_EQ(measure(a, b).overlap_ratio, 0.75);
  EXPECT_DOUBLE_EQ(measure(b, a).overlap_ratio, 0.75);
  const MatchedSurface part_a(a, 1), part_b(b, 1);
  const Eigen::Isometry3f I = Eigen::Isometry3f::Identity();
  EXPECT_NEAR(coarseOverlap(part_a, part_b, I), 0.5, 0.01) << "of b";
  EXPECT_NEAR(coarseOverlap(part_b, part_a, I), 0.75, 0.01) << "of a";
  EXPECT_EQ(coarseOverlap(part_a, part_b, pose({ 1, 0, 0 }, 0, X)), 0);
}

TEST(PairMeasure, RmseIsThatOfTheDistancesAlongTheNormals)
{
  PartialModel b = madePart();
  addRows(0, 10, 0.001F, &b);
  addRows(10, 10, 0.002F, &b);
  EXPECT_NEAR(measure(plate(), plate(0.0015F)).rmse_m, 0.0015, 1e-6);
  // Of the step's points some find the other half of b, from either side: 1 and 2 mm all the same.
  EXPECT_NEAR(measure(plate(), b).rmse_m, std::sqrt((1.0 + 4.0) / 2) * 1e-3, 3e-5);
  // Half a spacing along the surface is no distance.
  EXPECT_NEAR(measure(plate(), plate(), pose({ 0.001F, 0, 0 }, 0, X)).rmse_m, 0, 1e-6);
}

TEST(PairMeasure, SurfacesThatFaceAwayAreNotTheSame)
{
  PartialModel back = plate();
  for (Eigen::Vector3f& n : back.normals)
    n = -n;
  const PairQuality quality = measure(plate(), back);
  EXPECT_EQ(quality.overlap_ratio, 0);
  EXPECT_EQ(quality.rmse_m, 0);
  const MatchedSurface part(plate(), 1);
  EXPECT_EQ(measure(plate(), plate(0.05F)).overlap_ratio, 0) << "out of reach";
}

/// Blots of three channels, 12 mm across, on a corner of three faces: seen, with features, standing on its table.
PartialModel printedCorner()
{
  const ColorAt texture = [](const Eigen::Vector3f& p)
  {
    return Eigen::Vector3f(0.3F * std::sin(260 * p.x() + 90 * p.y()), 0.2F * std::sin(240 * p.y() - 80 * p.z()),
                           0.1F * std::sin(250 * p.z() + 120 * p.x()));
  };
  PartialModel part = madePart();
  addPatch({ -HALF_M, -HALF_M, HALF_M }, X, Y, SIDE, SIDE, texture, &part);
  addPatch({ HALF_M, -HALF_M, -HALF_M }, Y, Z, SIDE, SIDE, texture, &part);
  addPatch({ -HALF_M, HALF_M, -HALF_M }, Z, X, SIDE, SIDE, texture, &part);
  part.support_plane = geometry::Plane{ Eigen::Vector3d::UnitZ(), HALF_M + 0.003 };
  part.spacing_m *= 1.05;  // no neighbour lies at the rim of what is averaged over
  part.views = { viewAlongZ(1.0005F), viewAlongZ(1.0045F), viewAlongZ(0.9705F) };
  ObjectFeatures features;
  features.norm = cv::NORM_L2;
  features.descriptors = cv::Mat::eye(5, 5, CV_32FC1);
  for (int i = 0; i < 5; ++i)
    features.points.push_back(part.points[static_cast<std::size_t>(100 * i)]);
  part.features = { features };
  return part;
}

void expectAlike(const PairQuality& one, const PairQuality& other, double tolerance)
{
  for (const PairFigure& figure : registration::pairFigures())
    EXPECT_NEAR(one.*figure.value, other.*figure.value, tolerance) << figure.name;
}

TEST(PairMeasure, IsTheSameWhicheverPartComesFirst)
{
  const PartialModel a = printedCorner(), b = placed(printedCorner(), pose({ 0.3F, -0.1F, 0.2F }, 2, { 1, -2, 3 }));
  // Right but for 1 mm and 2 deg.
  const Eigen::Isometry3f T_a_b = pose({ 0.3F, -0.1F, 0.201F }, 2.035F, { 1, -2, 3 }).inverse();
  const PairQuality quality = measure(a, b, T_a_b);
  EXPECT_GT(quality.overlap_ratio, 0.9);
  EXPECT_GT(quality.color_agreement, 0.9);
  EXPECT_GT(quality.edge_strength, 0.1);
  expectAlike(measure(b, a, T_a_b.inverse()), quality, 1e-6);
}

TEST(PairMeasure, DoesNotDependOnTheSessionFrames)
{
  const PartialModel corner = printedCorner();
  const PairQuality truth = measure(corner, corner);
  EXPECT_GT(truth.color_agreement, 0.999);
  EXPECT_GT(truth.edge_agreement, 0.999);
  const Eigen::Isometry3f T = pose({ 0.2F, 0.1F, -0.3F }, 1.2F, { 2, 1, -1 });
  expectAlike(measure(corner, placed(corner, T.inverse()), T), truth, 2e-3);
}

TEST(PairMeasure, ColorsAndTheirSlopesAgreeOrAreOpposite)
{
  const PartialModel corner = printedCorner();
  const auto times = [&](float factor)
  {
    PartialModel result = corner;
    for (Eigen::Vector3f& color : result.colors)
      color *= factor;
    return result;
  };
  const PairQuality same = measure(corner, corner), opposite = measure(corner, times(-1));
  EXPECT_NEAR(same.color_agreement, 1, 1e-5);
  EXPECT_NEAR(same.edge_agreement, 1, 1e-5);
  EXPECT_NEAR(opposite.color_agreement, -1, 1e-5);
  EXPECT_NEAR(opposite.edge_agreement, -1, 1e-5);
  // Fainter texture is the same texture to the colours. To the slopes it is less alike: 2 * 0.5 / (1 + 0.5^2).
  const PairQuality fainter = measure(corner, times(0.5F));
  EXPECT_NEAR(fainter.color_agreement, 1, 1e-5);
  EXPECT_NEAR(fainter.edge_agreement, 0.8, 1e-5);
  EXPECT_NEAR(fainter.texture, same.texture * std::sqrt(0.5), 1e-5);
  EXPECT_NEAR(fainter.edge_strength, same.edge_strength * std::sqrt((1 + 0.25) / 2), 1e-5);
  const PairQuality none = measure(corner, times(0));
  EXPECT_EQ(none.color_agreement, 0);
  EXPECT_EQ(none.edge_agreement, 0);
  EXPECT_EQ(none.texture, 0);
  EXPECT_EQ(measure(times(0), times(0)).edge_strength, 0);
}

TEST(PairMeasure, StrengthOfEdgesIsTheSlopeOverTheLengthItIsTakenOver)
{
  // 5 per metre in one channel, over three spacings; rims of the plate are smoothed flatter.
  PartialModel part = plate();
  for (std::size_t i = 0; i < part.points.size(); ++i)
    part.colors[i] = { 5 * part.points[i].x(), 0, 0 };
  const PairQuality quality = measure(part, part);
  EXPECT_NEAR(quality.edge_strength, 5 * 3 * SPACING_M, 0.15 * 5 * 3 * SPACING_M);
  EXPECT_EQ(measure(part, part, Eigen::Isometry3f::Identity(), false).edge_strength, 0) << "not of few points";
  // Uniform over a plate: sigma = side / sqrt(12).
  EXPECT_NEAR(quality.texture, 5 * SIDE * SPACING_M / std::sqrt(12.0), 0.003);
  // A quarter turn lays slopes across each other.
  const PairQuality across = measure(part, part, pose({ 0, 0, 0 }, static_cast<float>(M_PI) / 2, Z));
  EXPECT_NEAR(across.edge_agreement, 0, 0.01);
  EXPECT_NEAR(across.edge_strength, quality.edge_strength, 1e-4);
}

TEST(PairMeasure, TurnIsTheAngleBetweenWhatWasUp)
{
  const PartialModel a = printedCorner();
  PartialModel b = a;
  for (const double angle_rad : { 0.0, 0.7, M_PI / 2, 3.0 })
    EXPECT_NEAR(measure(a, b, pose({ 0, 0, 0 }, static_cast<float>(angle_rad), X)).turn_rad, angle_rad, 1e-3);
  EXPECT_NEAR(measure(a, b, pose({ 0, 0, 0 }, 1.5F, Z)).turn_rad, 0, 1e-3) << "turned about the vertical";
  b.support_plane.reset();
  EXPECT_EQ(measure(a, b).turn_rad, -1);
  EXPECT_EQ(measure(b, a).turn_rad, -1);
}

TEST(PairMeasure, FootIsTheOneThatIsHiddenMore)
{
  // Both lowest points are at -19 mm; the planes 3 and 5 mm below them.
  const PartialModel a = printedCorner();
  PartialModel b = a;
  b.support_plane->offset_m = HALF_M + 0.005;
  EXPECT_NEAR(measure(a, b).foot_m, 0.005, 1e-5);
  EXPECT_NEAR(measure(b, a).foot_m, 0.005, 1e-5);
  EXPECT_NEAR(measure(a, b).contact_gap_m, 0.005, 1e-5);
}

TEST(PairMeasure, CountsTheMatchesThatThePoseBringsTogether)
{
  const PartialModel a = printedCorner();
  PartialModel b = a;
  EXPECT_EQ(measure(a, b).features_upheld, 5);
  b.features[0].points[1].x() += 0.02F;
  b.features[0].points[4].z() -= 0.02F;
  EXPECT_EQ(measure(a, b).features_upheld, 3);
  EXPECT_EQ(measure(a, b, pose({ 0.02F, 0, 0 }, 0, X)).features_upheld, 0);
  b.features.clear();
  EXPECT_EQ(measure(a, b).features_upheld, 0);
}

TEST(PairMeasure, OfNothingIsNothing)
{
  PartialModel nothing = madePart();
  nothing.views = { viewAlongZ(1), viewAlongZ(1) };
  nothing.support_plane = geometry::Plane{};
  for (const PartialModel& other : { nothing, plate() })
  {
    const PairQuality quality = measure(nothing, other);
    EXPECT_EQ(quality.overlap_ratio, 0);
    for (const PairFigure& figure : registration::pairFigures())
      EXPECT_TRUE(std::isfinite(quality.*figure.value)) << figure.name;
  }
}

}  // namespace
}  // namespace object_modelling::registration
