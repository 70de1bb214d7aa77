#include <yaml-cpp/yaml.h>

#include <filesystem>

#include "build_fixture.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/report/report_maker.h"

namespace object_modelling::pipeline
{
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
  database_.remakeReport("carton", control_,
                         [this](const std::string& folder) { report::makeReport(folder, control_); });
  EXPECT_GT(base::readTextFile(path).size(), 100000u);
  EXPECT_EQ(database_.check(), std::vector<std::string>());
  EXPECT_EQ(contentHash(), hash);
}

TEST_F(BuildObject, AReportThatFailsNamesTheReason)
{
  const base::Status status = statusOf([this] { report::makeReport(folder_.path("no object"), control_); });
  EXPECT_EQ(status.code, base::StatusCode::INTERNAL);
  EXPECT_NE(status.message.find("object.yaml"), std::string::npos) << status.message;
  base::JobControl cancelled;
  cancelled.cancel();
  EXPECT_EQ(statusOf([&] { report::makeReport(folder_.path(), cancelled); }).code, base::StatusCode::CANCELLED);
}

}  // namespace object_modelling::pipeline
