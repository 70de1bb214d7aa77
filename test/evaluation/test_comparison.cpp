#include "object_modelling/evaluation/comparison.h"

#include <limits>

#include <gtest/gtest.h>

#include "support/shapes.h"

namespace object_modelling::evaluation
{
namespace
{
using test_support::farAway;
using test_support::moved;
using test_support::pointsOf;

Comparison compared(const std::vector<Eigen::Vector3d>& points, const mesh::ReferenceSurface& surface,
                    const ComparisonOptions& options = {})
{
  base::JobControl control;
  return compareToReference(points, surface, options, control);
}

TEST(ComparisonTest, StatisticsOfKnownDistances)
{
  std::vector<double> distances_m;
  for (int i = 0; i <= 100; ++i)
    distances_m.push_back(i * 1e-4);  // 0 to 10 mm
  const DistanceStatistics statistics = statisticsOf(distances_m);
  EXPECT_NEAR(statistics.mean_m, 0.005, 1e-12);
  EXPECT_NEAR(statistics.median_m, 0.005, 1e-12);
  EXPECT_NEAR(statistics.sigma_m, std::sqrt((101.0 * 101 - 1) / 12) * 1e-4, 1e-12);
  EXPECT_NEAR(statistics.rms_m * statistics.rms_m,
              statistics.mean_m * statistics.mean_m + statistics.sigma_m * statistics.sigma_m, 1e-12);
  EXPECT_NEAR(statistics.p95_m, 0.0095, 1e-12);
  EXPECT_NEAR(statistics.max_m, 0.01, 1e-12);
  EXPECT_NEAR(statistics.outlier_ratio, 50.0 / 101, 0.01);
  EXPECT_EQ(statisticsOf({ 0.002 }).p95_m, 0.002);
}

// 0.5 mm outside a sphere of 50 mm, somewhere else: the distance has to come out whatever the unknown turn is.
TEST(ComparisonTest, ASphereHalfAMillimeterTooLarge)
{
  const mesh::ReferenceSurface surface(test_support::sphere(0.05f, 100));
  const std::vector<Eigen::Vector3d> points = pointsOf(test_support::sphere(0.0505f, 60));
  for (const bool align : { false, true })
  {
    ComparisonOptions options;
    options.align = align;
    const Comparison comparison = compared(align ? moved(farAway(), points) : points, surface, options);
    ASSERT_TRUE(comparison.status.ok()) << comparison.status.message;
    EXPECT_EQ(comparison.distances_m.size(), points.size());
    EXPECT_NEAR(comparison.statistics.mean_m, 0.0005, 1e-5);
    EXPECT_NEAR(comparison.statistics.max_m, 0.0005, 2e-5);
    EXPECT_NEAR(comparison.statistics.sigma_m, 0, 1e-5);
    EXPECT_EQ(comparison.statistics.outlier_ratio, 0);
  }
}

TEST(ComparisonTest, WithoutAlignmentTheModelStaysWhereItIsPut)
{
  mesh::TriangleMesh box;
  test_support::addBox({ 0, 0, 0 }, { 0.1f, 0.1f, 0.1f }, 8, &box);
  std::vector<Eigen::Vector3d> top;
  for (const Eigen::Vector3d& point : pointsOf(box))
    if (point.z() > 0.0999)
      top.push_back(point + Eigen::Vector3d(0, 0, 0.002));
  ComparisonOptions options;
  options.align = false;
  EXPECT_NEAR(compared(top, mesh::ReferenceSurface(box), options).statistics.mean_m, 0.002, 1e-7);
  options.T_start = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.006));
  const Comparison comparison = compared(top, mesh::ReferenceSurface(box), options);
  EXPECT_NEAR(comparison.statistics.mean_m, 0.008, 1e-7);
  EXPECT_EQ(comparison.statistics.outlier_ratio, 1);
  EXPECT_EQ(comparison.T_reference_model.matrix(), options.T_start->matrix());
}

TEST(ComparisonTest, MillimetersForMetersAreNamed)
{
  const mesh::ReferenceSurface meters(test_support::lopsidedShape(3));
  std::vector<Eigen::Vector3d> points = pointsOf(test_support::lopsidedShape(5));
  for (Eigen::Vector3d& point : points)
    point *= 1000;
  const base::Status status = compared(points, meters).status;
  EXPECT_EQ(status.code, base::StatusCode::BAD_INPUT);
  EXPECT_NE(status.message.find("--model-unit mm"), std::string::npos) << status.message;
  for (Eigen::Vector3d& point : points)
    point /= 1e6;
  EXPECT_NE(compared(points, meters).status.message.find("--reference-unit mm"), std::string::npos);
}

TEST(ComparisonTest, NothingAndNotANumber)
{
  const mesh::ReferenceSurface surface(test_support::lopsidedShape(3));
  EXPECT_EQ(compared({}, surface).status.code, base::StatusCode::BAD_INPUT);
  std::vector<Eigen::Vector3d> points(30, Eigen::Vector3d(0, 0, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(compared(points, surface).status.code, base::StatusCode::BAD_INPUT);
}

}  // namespace
}  // namespace object_modelling::evaluation
