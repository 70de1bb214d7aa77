#include <limits>

#include <gtest/gtest.h>

#include "object_modelling/segmentation/scene_segmenter.h"
#include "scene_fixtures.h"

namespace object_modelling::segmentation
{
namespace
{
/// Boxes of 10 cm at 1 m, at x = -0.2, 0, 0.3 m; masks where a camera of f = 100 px sees them.
SceneSegmentation threeHypotheses()
{
  SceneSegmentation segmentation;
  for (const double x_m : { -0.2, 0.0, 0.3 })
  {
    Hypothesis hypothesis;
    hypothesis.id = static_cast<int>(segmentation.hypotheses.size());
    hypothesis.centroid_camera = { x_m, 0, 1 };
    hypothesis.box_camera.T_frame_box.translation() = hypothesis.centroid_camera;
    hypothesis.box_camera.size_m.setConstant(0.1);
    hypothesis.mask = cv::Mat::zeros(80, 100, CV_8UC1);
    hypothesis.mask(cv::Rect(45 + static_cast<int>(100 * x_m), 35, 10, 10)) = cv::Scalar(255);
    hypothesis.pixel_count = 100;
    segmentation.hypotheses.push_back(hypothesis);
  }
  return segmentation;
}

geometry::PinholeCamera camera()
{
  geometry::PinholeCamera camera;
  camera.width = 100;
  camera.height = 80;
  camera.fx = camera.fy = 100;
  camera.cx = 49.5;
  camera.cy = 39.5;
  return camera;
}

SceneSegmentation nothing()
{
  SceneSegmentation segmentation;
  segmentation.status = { base::StatusCode::NO_RESULT, "no plane" };
  return segmentation;
}

}  // namespace

TEST(Selection, ByPixel)
{
  const SceneSegmentation segmentation = threeHypotheses();
  EXPECT_EQ(selectByPixel(segmentation, 30, 40).value, 0);
  EXPECT_EQ(selectByPixel(segmentation, 50, 40).value, 1);
  EXPECT_EQ(selectByPixel(segmentation, 65, 40).status.code, base::StatusCode::NO_RESULT);
  EXPECT_EQ(selectByPixel(segmentation, 100, 40).status.code, base::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(selectByPixel(segmentation, -1, 40).status.code, base::StatusCode::INVALID_ARGUMENT);
}

TEST(Selection, ByPoint)
{
  const SceneSegmentation segmentation = threeHypotheses();
  EXPECT_EQ(selectByPoint(segmentation, { -0.2, 0, 1 }).value, 0);
  EXPECT_EQ(selectByPoint(segmentation, { 0.065, 0, 1 }).value, 1) << "15 mm beside the box";
  const base::Result<int> far = selectByPoint(segmentation, { 0.1, 0, 1 });
  EXPECT_EQ(far.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(far.status.message.find("0.05"), std::string::npos) << far.status.message;
  EXPECT_EQ(selectByPoint(segmentation, { 0.1, 0, 1 }, 0.06).value, 1);
  EXPECT_EQ(selectByPoint(segmentation, { std::numeric_limits<double>::quiet_NaN(), 0, 1 }).status.code,
            base::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(selectByPoint(segmentation, { 0, 0, 1 }, -1).status.code, base::StatusCode::INVALID_ARGUMENT);
}

TEST(Selection, OverlappingBoxesGoToTheNearerCenter)
{
  SceneSegmentation segmentation = threeHypotheses();
  for (Hypothesis& hypothesis : segmentation.hypotheses)
    hypothesis.box_camera.size_m.x() = 1;
  EXPECT_EQ(selectByPoint(segmentation, { 0.2, 0, 1 }).value, 2);
}

TEST(Selection, AutomaticTakesTheCentralOneOfEqualSize)
{
  EXPECT_EQ(selectAutomatically(threeHypotheses(), camera()).value, 1);
}

TEST(Selection, AutomaticPrefersTheLargerNearTheCenterAndAWholeOne)
{
  SceneSegmentation segmentation = threeHypotheses();
  segmentation.hypotheses[0].pixel_count = 1000;
  EXPECT_EQ(selectAutomatically(segmentation, camera()).value, 0);
  segmentation.hypotheses[0].mask.row(0) = cv::Scalar(255);  // cut off by the image's border
  EXPECT_EQ(selectAutomatically(segmentation, camera()).value, 1);
}

TEST(Selection, SaysWhyThereIsNothing)
{
  for (const base::Result<int>& result : { selectByPixel(nothing(), 0, 0), selectByPoint(nothing(), { 0, 0, 1 }),
                                           selectAutomatically(nothing(), camera()) })
  {
    EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
    EXPECT_NE(result.status.message.find("no plane"), std::string::npos);
    EXPECT_EQ(result.value, -1);
  }
}

}  // namespace object_modelling::segmentation
