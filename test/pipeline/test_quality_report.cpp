#include <yaml-cpp/yaml.h>

#include <filesystem>

#include "build_fixture.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/pipeline/report_maker.h"
#include "quality_report.h"
#include "refinement_report.h"

namespace object_modelling::pipeline
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
    EXPECT_EQ(statusOf([&] { readRefinementReport(text); }).code, base::StatusCode::BAD_INPUT) << text;
}

TEST(QualityReportTest, HoldsTheResidualsOfEverySession)
{
  std::vector<keyframes::Session> sessions{ named("up"), named("down"), named("damaged") };
  sessions[0].refinement_report = refinementReportYaml(adjusted());
  sessions[0].reference_is_object = true;
  sessions[2].refinement_report = "[broken";  // does not cost the model
  const YAML::Node quality = YAML::Load(qualityYaml({}, sessions, {}, {}, { { "fuse", 1.5 } }));
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

TEST_F(BuildObject, QualityNamesFiguresStagesAndVersions)
{
  const BuildReport report = build({ "box" });
  ASSERT_TRUE(report.status.ok()) << report.status.message;
  const YAML::Node quality = YAML::LoadFile(report.object_folder + "/quality.yaml");
  EXPECT_EQ(quality["figures"]["view_count"].as<int>(), 12);
  EXPECT_EQ(quality["figures"]["triangle_count"].as<std::size_t>(), report.triangle_count);
  EXPECT_NEAR(quality["figures"]["size_m"][2].as<double>(), BOX_SIZE_M.z(), 0.01);
  EXPECT_GT(quality["sigma"]["median_m"].as<double>(), 0);
  EXPECT_GE(quality["sigma"]["p95_m"].as<double>(), quality["sigma"]["median_m"].as<double>());
  std::size_t counted = 0;
  for (const YAML::Node& count : quality["sigma"]["histogram_counts"])
    counted += count.as<std::size_t>();
  EXPECT_EQ(counted, report.point_count);
  EXPECT_GT(quality["coverage"]["mesh_seen_ratio"].as<double>(), 0.9);
  EXPECT_GT(quality["coverage"]["mesh_seen_by_3_ratio"].as<double>(), 0.5);
  EXPECT_EQ(quality["coverage"]["view_counts"].size(), 12u);
  EXPECT_TRUE(quality["sessions"][0]["refinement"].IsNull());
  ASSERT_EQ(quality["views"].size(), 12u);
  EXPECT_EQ(quality["views"][5]["keyframe_id"].as<int>(), 5);
  EXPECT_GT(quality["stage_s"]["fuse"].as<double>(), 0);
  EXPECT_EQ(quality["parameters"]["fusion/resolution_m"].as<double>(), 0.004);
  for (const char* name : { "object_modelling", "opencv", "pcl", "ceres", "eigen" })
    EXPECT_FALSE(quality["versions"][name].as<std::string>().empty()) << name;
  EXPECT_TRUE(std::filesystem::exists(report.object_folder + "/turntable.png"));
}

TEST_F(BuildObject, TheReportIsWrittenWithTheModelAndCanBeMadeAgain)
{
  BuildOptions options = coarse();
  options.make_report = true;
  const BuildReport report = build({ "box" }, options);
  ASSERT_TRUE(report.status.ok());
  EXPECT_EQ(report.status.message, "");
  const std::string path = report.object_folder + "/report.html";
  EXPECT_GT(base::readTextFile(path).size(), 100000u);
  EXPECT_EQ(report.stages.back().stage, "report");
  EXPECT_EQ(database_.check(), std::vector<std::string>());

  base::writeTextFile(path, "changed");
  EXPECT_EQ(database_.check().size(), 1u);
  const std::string hash = contentHash();
  database_.remakeReport("carton", control_, [this](const std::string& folder) { makeReport(folder, control_); });
  EXPECT_GT(base::readTextFile(path).size(), 100000u);
  EXPECT_EQ(database_.check(), std::vector<std::string>());
  EXPECT_EQ(contentHash(), hash);
}

TEST_F(BuildObject, AReportThatFailsNamesTheReason)
{
  const base::Status status = statusOf([this] { makeReport(folder_.path("no object"), control_); });
  EXPECT_EQ(status.code, base::StatusCode::INTERNAL);
  EXPECT_NE(status.message.find("object.yaml"), std::string::npos) << status.message;
  base::JobControl cancelled;
  cancelled.cancel();
  EXPECT_EQ(statusOf([&] { makeReport(folder_.path(), cancelled); }).code, base::StatusCode::CANCELLED);
}

}  // namespace object_modelling::pipeline
