#include "object_modelling/report/quality_report.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "object_modelling/report/refinement_report.h"
#include "support/thrown_status.h"

namespace object_modelling::report
{
namespace
{
bundle_adjustment::BundleAdjustmentResult adjusted()
{
  bundle_adjustment::BundleAdjustmentResult result;
  result.iterations = 7;
  result.initial_cost = 12.5;
  result.final_cost = 3.25;
  result.color_offset_px = { 0.25, -0.5 };
  result.links.resize(4);
  result.rejected_links.resize(1);
  result.left_out = { 3 };
  for (int id = 0; id < 12; ++id)
    result.residuals.push_back({ id, 100 + id, 0.5, 0.2 + 0.05 * id, 0.004, 0.0015 });
  return result;
}

keyframes::Session session(const std::string& id)
{
  keyframes::Session result;
  result.id = id;
  return result;
}
}  // namespace

TEST(RefinementReportTest, ComesBack)
{
  const std::optional<RefinementReport> report = readRefinementReport(refinementReportYaml(adjusted()));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->iterations, 7);
  EXPECT_EQ(report->initial_cost, 12.5);
  EXPECT_EQ(report->final_cost, 3.25);
  EXPECT_EQ(report->color_offset_px, Eigen::Vector2d(0.25, -0.5));
  EXPECT_EQ(report->link_count, 4);
  EXPECT_EQ(report->rejected_link_count, 1);
  EXPECT_EQ(report->left_out, std::vector<int>{ 3 });
  ASSERT_EQ(report->residuals.size(), 12u);
  EXPECT_EQ(report->residuals[11].keyframe_id, 11);
  EXPECT_EQ(report->residuals[11].observation_count, 111);
  EXPECT_DOUBLE_EQ(report->residuals[11].reprojection_rmse_after_px, 0.75);
  EXPECT_DOUBLE_EQ(report->residuals[11].depth_rmse_before_m, 0.004);
}

TEST(RefinementReportTest, EmptyIsNeverRefinedAndDamageIsNamed)
{
  EXPECT_FALSE(readRefinementReport(""));
  for (const std::string text : { "iterations: many", "[1, 2", "keyframes: []" })
    EXPECT_EQ(test_support::statusOf([&] { readRefinementReport(text); }).code, base::StatusCode::BAD_INPUT) << text;
}

TEST(QualityReportTest, HoldsTheResidualsOfEverySession)
{
  std::vector<keyframes::Session> sessions{ session("up"), session("down"), session("damaged") };
  sessions[0].refinement_report = refinementReportYaml(adjusted());
  sessions[0].reference_is_object = true;
  sessions[2].refinement_report = "[broken";  // does not cost the model
  const YAML::Node quality = YAML::Load(qualityYaml({}, sessions, {}, {}, {}, { { "fuse", 1.5 } }));
  ASSERT_EQ(quality["sessions"].size(), 3u);
  EXPECT_EQ(quality["sessions"][0]["id"].as<std::string>(), "up");
  EXPECT_EQ(quality["sessions"][0]["tracked_against"].as<std::string>(), "object");
  const YAML::Node refinement = quality["sessions"][0]["refinement"];
  EXPECT_EQ(refinement["left_out"][0].as<int>(), 3);
  EXPECT_EQ(refinement["color_offset_px"][1].as<double>(), -0.5);
  ASSERT_EQ(refinement["keyframes"].size(), 12u);
  EXPECT_EQ(refinement["keyframes"][11]["keyframe_id"].as<int>(), 11);
  EXPECT_NEAR(refinement["keyframes"][11]["reprojection_rmse_after_px"].as<double>(), 0.75, 1e-6);
  EXPECT_TRUE(quality["sessions"][1]["refinement"].IsNull());
  EXPECT_TRUE(quality["sessions"][2]["refinement"].IsNull());
  EXPECT_EQ(quality["stage_s"]["fuse"].as<double>(), 1.5);
  EXPECT_EQ(quality["figures"]["point_count"].as<int>(), 0);  // an empty model has figures too
}
}  // namespace object_modelling::report
