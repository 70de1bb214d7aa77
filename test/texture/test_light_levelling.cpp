#include "light_levelling.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "exposure.h"
#include "object_modelling/texture/texturing.h"
#include "texture_scene.h"

namespace object_modelling::texture
{
namespace
{
/// How bright light 1 leaves a place that light 0 shows as it is.
float shade(const Eigen::Vector3d& p)
{
  return static_cast<float>(0.45 + 0.4 * p.z() / BOX_HEIGHT_M + 1.5 * p.x());
}

void darken(rgbd::View* view)
{
  rgbd::Frame& frame = view->frame;
  frame.color_bgr = frame.color_bgr.clone();
  for (int v = 0; v < frame.color_bgr.rows; ++v)
    for (int u = 0; u < frame.color_bgr.cols; ++u)
      if (frame.depthAt_m(u, v) > 0)
        frame.color_bgr.at<cv::Vec3b>(v, u) *= shade(view->T_world_camera * frame.point(u, v).cast<double>());
}

/// Twice round the box; every second view is of session 1, under light 1.
std::vector<rgbd::View> underTwoLights()
{
  std::vector<rgbd::View> views = roundTheBox(boxScene(), 16);
  for (std::size_t i = 1; i < views.size(); i += 2)
  {
    views[i].session_index = 1;
    darken(&views[i]);
  }
  return views;
}

/// The same taken for one session's.
std::vector<rgbd::View> ofOneSession(std::vector<rgbd::View> views)
{
  for (rgbd::View& view : views)
    view.session_index = 0;
  return views;
}

double median(std::vector<double> values)
{
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}
}  // namespace

TEST(LightLevelling, FindsTheRatioOfTheLights)
{
  const std::vector<rgbd::View> lit = underTwoLights();
  const mesh::TriangleMesh mesh = boxMesh(0.004, false);
  const std::vector<TextureView> views = prepareTextureViews(mesh, lit);
  const VertexWeights weights = weighViews(mesh, views);
  const Exposure exposure = solveExposure(mesh, views, weights);
  ASSERT_EQ(exposure.light_gains.size(), 2u);
  // Exposure takes the mean of the shade, so ratios tell up to one factor.
  std::vector<double> log_ratios, shades;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
  {
    bool of_light[2] = { false, false };
    for (const VertexView& seen : weights[i])
      of_light[views[seen.view].light] = true;
    if (!of_light[0] || !of_light[1])
      continue;
    const auto vertex = static_cast<std::uint32_t>(i);
    log_ratios.push_back(std::log(exposure.ofLight(0, vertex)[1] / exposure.ofLight(1, vertex)[1]));
    shades.push_back(std::log(shade(mesh.vertices[i].cast<double>())));
  }
  ASSERT_GT(shades.size(), mesh.vertices.size() / 3);
  const auto [darkest, brightest] = std::minmax_element(shades.begin(), shades.end());
  ASSERT_GT(*brightest - *darkest, 0.5) << "the lights differ";
  std::vector<double> off;
  for (std::size_t i = 0; i < shades.size(); ++i)
    off.push_back(log_ratios[i] - shades[i]);
  const double factor = median(off);
  for (double& value : off)
    value = std::abs(value - factor);
  EXPECT_LT(median(off), 0.03);
}

TEST(LightLevelling, LeavesNoSeamsInTheTexture)
{
  const std::vector<rgbd::View> views = underTwoLights();
  const mesh::TriangleMesh mesh = boxMesh(0.004, false);
  base::JobControl control;
  const TextureResult with = textureMesh(mesh, views, {}, control);
  const TextureResult without = textureMesh(mesh, ofOneSession(views), {}, control);
  const std::vector<rgbd::View> lit = roundTheBox(boxScene(), 16);
  const TextureResult truth = textureMesh(mesh, lit, {}, control);
  // What is left of light is smooth: steps are those of the texture.
  const auto roughness = [](const TextureResult& result)
  {
    cv::Mat gray, dx;
    cv::cvtColor(result.textured.texture_bgr, gray, cv::COLOR_BGR2GRAY);
    gray.convertTo(gray, CV_32F);
    gray.setTo(1, gray < 1);
    cv::log(gray, gray);
    cv::Sobel(gray, dx, CV_32F, 1, 0);
    cv::Mat seen;
    cv::erode(result.textured.seen, seen, cv::Mat(), cv::Point(-1, -1), 3);
    return cv::mean(cv::abs(dx), seen)[0];
  };
  EXPECT_LT(roughness(with), 1.1 * roughness(truth));
  EXPECT_GT(roughness(without), roughness(with));
}

TEST(LightLevelling, IsNotNeededUnderOneLight)
{
  const std::vector<rgbd::View> lit = roundTheBox(boxScene(), 4);
  const mesh::TriangleMesh mesh = boxMesh(0.01, false);
  const std::vector<TextureView> views = prepareTextureViews(mesh, lit);
  EXPECT_TRUE(solveExposure(mesh, views, weighViews(mesh, views)).light_gains.empty());
}

TEST(LightLevelling, TakesALightThatMeetsNoOther)
{
  std::vector<rgbd::View> views = roundTheBox(boxScene(), 6);
  views[5].T_world_camera.translation().x() += 5;  // sees nothing of the mesh
  views[5].session_index = 1;
  base::JobControl control;
  const TextureResult result = textureMesh(boxMesh(0.01, false), views, {}, control);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  for (const std::size_t k : { 3, 4, 5 })
    views[k].session_index = 3;  // 1 and 2 have no view at all
  EXPECT_TRUE(textureMesh(boxMesh(0.01, false), views, {}, control).status.ok());
}

}  // namespace object_modelling::texture
