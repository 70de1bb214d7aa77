#include "object_modelling/report/result_text.h"

#include <gtest/gtest.h>

namespace object_modelling::report
{
TEST(ResultText, WeighsResidualsByTheirObservations)
{
  bundle_adjustment::BundleAdjustmentResult result;
  result.residuals = { { 0, 300, 1.0, 0.5, 0.004, 0.002 }, { 1, 100, 3.0, 0.5, 0.004, 0.002 } };
  EXPECT_EQ(toText(result),
            "refined   2 keyframes, 0 new links; reprojection 1.73 -> 0.50 px, depth 4.00 -> 2.00 mm RMSE\n");
  result.left_out = { 7 };
  result.color_offset_px = { 0.25, -0.5 };
  result.status = { base::StatusCode::NO_RESULT, "not converged" };
  const std::string text = toText(result);
  EXPECT_NE(text.find("; 1 left out (nothing links them); colour is shifted by (0.25, -0.50) px against depth\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("\n          not converged\n"), std::string::npos) << text;
}

TEST(ResultText, TellsHowWellALoopCloses)
{
  bundle_adjustment::BundleAdjustmentResult result;
  result.residuals.resize(5);
  result.links.resize(1);
  result.links[0].keyframe_a = 0;
  result.links[0].keyframe_b = 4;
  result.links[0].translation_error_before_m = 0.014;
  result.links[0].translation_error_after_m = 0.0016;
  EXPECT_NE(
      toText(result).find("closure   keyframe 4 against 0: 14.00 mm, 0.00 deg before -> 1.60 mm, 0.00 deg after\n"),
      std::string::npos)
      << toText(result);
}

TEST(ResultText, OfSurfacesWeighsPairsByTheirPoints)
{
  multi_view_icp::MultiViewIcpResult result;
  result.residuals.resize(3);
  result.pairs.resize(2);
  result.pairs[0].point_count = 100;
  result.pairs[0].rmse_before_m = result.pairs[1].rmse_before_m = 0.002;
  result.pairs[0].rmse_after_m = result.pairs[1].rmse_after_m = 0.001;
  result.pairs[1].point_count = 300;
  result.iterations = 4;
  EXPECT_EQ(toText(result), "aligned   3 keyframes in 2 overlaps, 4 iterations; surfaces 2.00 -> 1.00 mm RMSE\n");
  result.status = { base::StatusCode::NO_RESULT, "too few points" };
  EXPECT_EQ(toText(result), "aligned   too few points\n");
}

TEST(ResultText, OfAPairTellsWhoDecided)
{
  alignment::AlignmentResult result;
  result.edges.resize(1);
  result.edges[0].session_a = "up";
  result.edges[0].session_b = "side";
  result.edges[0].reason = "too little in common";
  result.left_out = { "side" };
  EXPECT_EQ(toText(result), "pair      up and side: refused\n          too little in common\nleft out  side\n");
}
}  // namespace object_modelling::report
