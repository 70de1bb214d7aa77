#include "object_modelling/texture/texturing.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "object_modelling/mesh/textured_renderer.h"
#include "support/violations.h"
#include "texture_scene.h"

namespace object_modelling::texture
{
namespace
{
constexpr double MESH_STEP_M = 0.005;

TextureResult texture(const mesh::TriangleMesh& mesh, const std::vector<rgbd::View>& views,
                      const TextureOptions& options = {})
{
  base::JobControl control;
  return textureMesh(mesh, views, options, control);
}

/// Mean difference (gray levels) per channel between the model drawn from a view and what the view ought to show,
/// within its mask.
cv::Scalar differenceIn(const rgbd::View& truth, const mesh::TexturedMesh& textured, double* psnr_dB)
{
  const mesh::MeshView drawn =
      mesh::renderTexturedMesh(textured, truth.frame.camera, truth.T_world_camera.inverse(), 3, { 0, 0, 0 });
  cv::Mat mask = (drawn.triangle_id >= 0) & truth.frame.object_mask, drawn_f, truth_f, difference;
  cv::erode(mask, mask, cv::Mat::ones(5, 5, CV_8UC1));
  drawn.color_bgr.convertTo(drawn_f, CV_32FC3);
  truth.frame.color_bgr.convertTo(truth_f, CV_32FC3);
  difference = drawn_f - truth_f;
  const double squares = std::pow(cv::norm(drawn_f, truth_f, cv::NORM_L2, mask), 2);
  *psnr_dB = 10 * std::log10(255. * 255. * 3 * cv::countNonZero(mask) / squares);
  return cv::mean(difference, mask);
}

double psnr_dB(const rgbd::View& truth, const mesh::TexturedMesh& textured)
{
  double value = 0;
  differenceIn(truth, textured, &value);
  return value;
}

/// Between those of roundTheBox.
rgbd::View unusedView(const test_support::SyntheticScene& scene)
{
  return test_support::renderViews(scene, test_support::vgaCamera(),
                                   { test_support::orbitPoses(40, { 0, 0, 0.06 }, 0.48, 0.6)[3] })[0];
}

TEST(Texturing, GivesBackThePrintOfABox)
{
  const auto scene = boxScene();
  const TextureResult result = texture(boxMesh(MESH_STEP_M, false), roundTheBox(scene, 16));
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_GT(psnr_dB(unusedView(scene), result.textured), 27);
  EXPECT_GT(result.seen_ratio, 0.93);
  EXPECT_EQ(result.chart_count, 5u);
  EXPECT_LT(result.seam_step_after, 8);
  EXPECT_DOUBLE_EQ(result.texel_size_m, TextureOptions().texel_size_m);
}

TEST(Texturing, RemovesStepsOfExposureAndWhiteBalance)
{
  const auto scene = boxScene();
  std::vector<rgbd::View> views = roundTheBox(scene, 16);
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    const double blue = i % 2 ? 0.8 : 1.05, red = i % 3 ? 0.85 : 1.1;
    views[i].frame.color_bgr = views[i].frame.color_bgr.clone();
    cv::multiply(views[i].frame.color_bgr, cv::Scalar(blue, 0.9, red), views[i].frame.color_bgr);
  }
  const TextureResult result = texture(boxMesh(MESH_STEP_M, false), views);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_NEAR(result.gains[1][0] / result.gains[0][0], 1.05 / 0.8, 0.03);
  EXPECT_NEAR(result.gains[1][2] / result.gains[0][2], 1.1 / 0.85, 0.03);
  EXPECT_NEAR(result.gains[5][1] / result.gains[0][1], 1, 0.03);
  EXPECT_GT(result.seam_step_before, 2 * result.seam_step_after);
}

TEST(Texturing, KeepsTheColorOfAnOccluderOffTheObject)
{
  auto scene = boxScene();
  scene.objects[0].texture = test_support::plainTexture({ 60, 60, 200 });
  auto with_occluder = scene;
  // Green posts before the box, which its mesh does not know.
  for (const double x_m : { -0.09, 0.09 })
  {
    with_occluder.objects.push_back(test_support::standingBox({ 0.02, 0.02, 0.2 }, x_m, 0.02));
    with_occluder.objects.back().texture = test_support::plainTexture({ 40, 220, 40 });
  }
  for (const bool masks : { true, false })
  {
    std::vector<rgbd::View> views = roundTheBox(with_occluder, 16);
    for (rgbd::View& view : views)
      if (!masks)
        view.frame.object_mask.release();
    const TextureResult result = texture(boxMesh(MESH_STEP_M, false), views);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    cv::Mat greenish, green, red;
    cv::extractChannel(result.textured.texture_bgr, green, 1);
    cv::extractChannel(result.textured.texture_bgr, red, 2);
    greenish = (green > red - 60) & result.textured.seen;
    EXPECT_LT(cv::countNonZero(greenish), 0.001 * cv::countNonZero(result.textured.seen)) << masks;
  }
}

TEST(Texturing, OutvotesAViewWithAHighlight)
{
  const auto scene = boxScene();
  std::vector<rgbd::View> views = roundTheBox(scene, 24);
  const double undisturbed_dB = psnr_dB(unusedView(scene), texture(boxMesh(MESH_STEP_M, false), views).textured);
  cv::Mat& shiny = views[2].frame.color_bgr;
  shiny = shiny.clone();
  cv::circle(shiny, { shiny.cols / 2, shiny.rows / 2 }, 25, { 255, 255, 255 }, cv::FILLED);
  const TextureResult result = texture(boxMesh(MESH_STEP_M, false), views);
  EXPECT_GT(psnr_dB(unusedView(scene), result.textured), undisturbed_dB - 0.7);
}

TEST(Texturing, MarksAndFillsWhatNobodySaw)
{
  auto scene = boxScene();
  scene.objects[0].texture = test_support::plainTexture({ 60, 90, 200 });
  const TextureResult result = texture(boxMesh(MESH_STEP_M, true), roundTheBox(scene, 16));
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const mesh::TexturedMesh& textured = result.textured;
  int unseen = 0;
  for (std::size_t t = 0; t < textured.mesh.triangles.size(); ++t)
  {
    float highest = 0;
    for (const std::uint32_t vertex : textured.mesh.triangles[t])
      highest = std::max(highest, textured.mesh.vertices[vertex].z());
    if (highest > 1e-4f)  // the bottom only
      continue;
    const Eigen::Vector2f middle = textured.texel((textured.uvs[t][0] + textured.uvs[t][1] + textured.uvs[t][2]) / 3);
    const cv::Point texel(cvRound(middle.x()), cvRound(middle.y()));
    EXPECT_EQ(textured.seen.at<std::uint8_t>(texel), 0);
    const cv::Vec3b color = textured.texture_bgr.at<cv::Vec3b>(texel);
    EXPECT_NEAR(color[2], color[0] * 200 / 60, 15);  // of its kind, as dark as the sides are
    EXPECT_GT(color[2], 100);
    ++unseen;
  }
  EXPECT_GT(unseen, 500);
  EXPECT_LT(result.seen_ratio, 0.86);
}

TEST(Texturing, FollowsTheOffsetOfEachColorImage)
{
  const auto scene = boxScene();
  std::vector<rgbd::View> with_offset = roundTheBox(scene, 16);
  for (std::size_t i = 0; i < with_offset.size(); ++i)
  {
    rgbd::View& view = with_offset[i];
    view.color_offset_px = i % 2 == 0 ? Eigen::Vector2d(3, -2) : Eigen::Vector2d(1, -4);
    cv::Mat shifted;
    cv::warpAffine(view.frame.color_bgr, shifted,
                   cv::Matx23d(1, 0, view.color_offset_px.x(), 0, 1, view.color_offset_px.y()),
                   view.frame.color_bgr.size());
    view.frame.color_bgr = shifted;
  }
  const auto psnrWith = [&](const Eigen::Vector2d& offset_px)
  {
    std::vector<rgbd::View> views = with_offset;
    for (rgbd::View& view : views)
      view.color_offset_px = offset_px;
    return psnr_dB(unusedView(scene), texture(boxMesh(MESH_STEP_M, false), views).textured);
  };
  const double own_dB = psnr_dB(unusedView(scene), texture(boxMesh(MESH_STEP_M, false), with_offset).textured);
  EXPECT_GT(own_dB, psnrWith({ 0, 0 }) + 4);
  EXPECT_GT(own_dB, psnrWith({ 2, -3 }) + 1) << "their mean";
}

TEST(Texturing, IsTheSameEveryTime)
{
  const auto views = roundTheBox(boxScene(), 8);
  const TextureResult one = texture(boxMesh(MESH_STEP_M, false), views);
  const TextureResult two = texture(boxMesh(MESH_STEP_M, false), views);
  EXPECT_EQ(cv::norm(one.textured.texture_bgr, two.textured.texture_bgr, cv::NORM_INF), 0);
  EXPECT_EQ(one.textured.uvs, two.textured.uvs);
}

TEST(Texturing, SaysWhyThereIsNone)
{
  const auto mesh = boxMesh(0.02, false);
  std::vector<rgbd::View> views = roundTheBox(boxScene(), 4);
  EXPECT_EQ(texture({}, views).status.code, base::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(texture(mesh, {}).status.code, base::StatusCode::NO_RESULT);
  for (rgbd::View& view : views)
    view.frame.object_mask = cv::Mat::zeros(view.frame.object_mask.size(), CV_8UC1);
  const base::Status no_mask = texture(mesh, views).status;
  EXPECT_EQ(no_mask.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(no_mask.message.find("mask"), std::string::npos) << no_mask.message;

  views = roundTheBox(boxScene(), 4);
  for (rgbd::View& view : views)
    view.T_world_camera.translation().z() += 5;
  EXPECT_EQ(texture(mesh, views).status.code, base::StatusCode::NO_RESULT);

  views = roundTheBox(boxScene(), 4);
  views[1].frame.color_bgr = cv::Mat::zeros(10, 10, CV_8UC3);
  EXPECT_THROW(texture(mesh, views), base::Error);
  views = roundTheBox(boxScene(), 4);
  views[1].session_index = -1;
  EXPECT_THROW(texture(mesh, views), base::Error);
  mesh::TriangleMesh broken = mesh;
  broken.triangles[0][1] = 100000;
  EXPECT_EQ(texture(broken, roundTheBox(boxScene(), 4)).status.code, base::StatusCode::INVALID_ARGUMENT);
  TextureOptions options;
  options.texel_size_m = 0;
  options.padding_px = 0;
  EXPECT_EQ(test_support::namesOf(options.violations()), (std::vector<std::string>{ "padding_px", "texel_size_m" }));
  EXPECT_TRUE(TextureOptions().violations().empty());
}

TEST(Texturing, StopsWhenCancelled)
{
  base::JobControl control;
  control.cancel();
  EXPECT_THROW(textureMesh(boxMesh(0.02, false), roundTheBox(boxScene(), 2), {}, control), base::Cancelled);
}

}  // namespace
}  // namespace object_modelling::texture
