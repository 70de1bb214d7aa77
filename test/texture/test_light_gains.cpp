#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "light_levelling.h"

namespace object_modelling::texture
{
namespace
{
constexpr int SIDE = 41;  // vertices along a side
constexpr double STEP_M = 0.002;
constexpr double HALF_M = STEP_M * (SIDE - 1) / 2;
constexpr float COLOR = 100;  // of the surface, gray levels

constexpr double SOLVED = 3e-3;  // ratio; the solver's tolerance is 1e-3

using Shade = std::function<Eigen::Vector3f(double x_m)>;

/// What the colours of a surface under some lights are levelled by. It is a square of 80 mm, flat or with a ridge of
/// 90 deg along x = 0. Cameras look along -z from far off, one pixel per millimetre.
class LightGainsOfASquare : public testing::Test
{
protected:
  void makeMesh(bool ridge)
  {
    mesh_ = {};
    for (int j = 0; j < SIDE; ++j)
      for (int i = 0; i < SIDE; ++i)
      {
        const double x_m = STEP_M * i - HALF_M, y_m = STEP_M * j - HALF_M;
        mesh_.vertices.emplace_back(x_m, y_m, ridge ? -std::abs(x_m) : 0);
      }
    for (std::uint32_t j = 0; j + 1 < SIDE; ++j)
      for (std::uint32_t i = 0; i + 1 < SIDE; ++i)
      {
        const std::uint32_t p = j * SIDE + i, q = p + 1, r = q + SIDE, s = p + SIDE;
        mesh_.triangles.insert(mesh_.triangles.end(), { { p, q, r }, { p, r, s } });
      }
    mesh::computeNormals(&mesh_);
    weights_.assign(mesh_.vertices.size(), {});
  }

  /// A view that shows the square's colour times the shade, where x is between the limits.
  void addView(int light, const Shade& shade, double from_m = -1, double to_m = 1, float gain = 1)
  {
    TextureView view;
    view.frame = &frame_;
    view.light = light;
    view.T_camera_mesh = Eigen::Translation3f(0, 0, 10) * Eigen::AngleAxisf(static_cast<float>(M_PI), X);
    view.smooth_bgr = cv::Mat(SIZE_PX, SIZE_PX, CV_32FC3);
    for (int v = 0; v < SIZE_PX; ++v)
      for (int u = 0; u < SIZE_PX; ++u)
      {
        const Eigen::Vector3f bgr = COLOR * shade(1e-3 * (u - frame_.camera.cx));
        view.smooth_bgr.at<cv::Vec3f>(v, u) = { bgr.x(), bgr.y(), bgr.z() };
      }
    for (std::size_t i = 0; i < weights_.size(); ++i)
      if (mesh_.vertices[i].x() >= from_m && mesh_.vertices[i].x() <= to_m)
        weights_[i].push_back({ static_cast<int>(views_.size()), 1 });
    views_.push_back(view);
    view_gains_.push_back(Eigen::Vector3f::Constant(gain));
  }
  void solve() { gains_ = levelLights(mesh_, views_, weights_, view_gains_); }
  /// In the middle of the side at some x.
  Eigen::Vector3f gain(int light, double x_m) const
  {
    return gains_.at(light)[SIDE / 2 * SIDE + static_cast<std::size_t>(std::lround((x_m + HALF_M) / STEP_M))];
  }
  void expectGains(int light, const Eigen::Vector3f& expected, double tolerance_ratio) const
  {
    for (const Eigen::Vector3f& found : gains_.at(light))
      for (int channel = 0; channel < 3; ++channel)
        ASSERT_NEAR(found[channel] / expected[channel], 1, tolerance_ratio) << light << ": " << found.transpose();
  }

  static constexpr int SIZE_PX = 101;
  const Eigen::Vector3f X = Eigen::Vector3f::UnitX();
  mesh::TriangleMesh mesh_;
  rgbd::Frame frame_ = []
  {
    rgbd::Frame frame;
    frame.camera = { SIZE_PX, SIZE_PX, 10000, 10000, 50, 50, {} };
    return frame;
  }();
  std::vector<TextureView> views_;
  std::vector<Eigen::Vector3f> view_gains_;
  VertexWeights weights_;
  LightGains gains_;
};

Shade everywhere(float blue, float green, float red)
{
  return [=](double /*x_m*/) { return Eigen::Vector3f(blue, green, red); };
}

TEST_F(LightGainsOfASquare, MeetInTheGeometricMean)
{
  makeMesh(false);
  addView(0, everywhere(1, 1, 1));
  addView(1, everywhere(0.25F, 0.64F, 1.44F));
  solve();
  ASSERT_EQ(gains_.size(), 2u);
  expectGains(0, { 0.5F, 0.8F, 1.2F }, SOLVED);
  expectGains(1, { 2, 1 / 0.8F, 1 / 1.2F }, SOLVED);
}

TEST_F(LightGainsOfASquare, OfThreeLightsToo)
{
  // 1 : 1/2 : 1/4, the mean is 1/2; of the last one there are two views.
  makeMesh(false);
  addView(0, everywhere(1, 1, 1));
  addView(1, everywhere(0.5F, 0.5F, 0.5F));
  addView(2, everywhere(0.25F, 0.25F, 0.25F));
  addView(2, everywhere(0.25F, 0.25F, 0.25F));
  solve();
  ASSERT_EQ(gains_.size(), 3u);
  expectGains(0, Eigen::Vector3f::Constant(0.5F), SOLVED);
  expectGains(1, Eigen::Vector3f::Ones(), SOLVED);
  expectGains(2, Eigen::Vector3f::Constant(2), SOLVED);
}

TEST_F(LightGainsOfASquare, ComeAfterThoseOfTheViews)
{
  makeMesh(false);
  addView(0, everywhere(1, 1, 1));
  addView(1, everywhere(0.5F, 0.5F, 0.5F), -1, 1, 2);
  solve();
  expectGains(0, Eigen::Vector3f::Ones(), SOLVED);
  expectGains(1, Eigen::Vector3f::Ones(), SOLVED);
}

TEST_F(LightGainsOfASquare, FollowAShadeThatGrowsAlongTheSurface)
{
  // From e^-0.5 to e^0.5; away from the rims.
  makeMesh(false);
  addView(0, everywhere(1, 1, 1));
  addView(1, [](double x_m) { return Eigen::Vector3f::Constant(static_cast<float>(std::exp(0.5 * x_m / HALF_M))); });
  solve();
  for (const double x_m : { -0.026, -0.01, 0.0, 0.02 })
  {
    const double ratio = std::exp(0.5 * x_m / HALF_M);
    EXPECT_NEAR(gain(0, x_m)[1] / gain(1, x_m)[1], ratio, 0.01 * ratio) << x_m;
    EXPECT_NEAR(gain(0, x_m)[1], std::sqrt(ratio), 0.01) << x_m;
  }
}

TEST_F(LightGainsOfASquare, RunOnWhereASingleLightWas)
{
  // Light 1 saw the left half alone, light 0 all of it.
  makeMesh(false);
  addView(0, everywhere(1, 1, 1));
  addView(1, everywhere(0.25F, 0.25F, 0.25F), -1, 0);
  solve();
  expectGains(0, Eigen::Vector3f::Constant(0.5F), 0.02);
  expectGains(1, Eigen::Vector3f::Constant(2), 0.02);
}

TEST_F(LightGainsOfASquare, ChangeFreelyAcrossAnEdgeAndSmoothlyElsewhere)
{
  const Shade left_dark = [](double x_m) { return Eigen::Vector3f::Constant(x_m < -0.0005 ? 0.25F : 1); };
  for (const bool ridge : { true, false })
  {
    views_.clear();
    view_gains_.clear();
    makeMesh(ridge);
    addView(0, everywhere(1, 1, 1));
    addView(1, left_dark);
    solve();
    // Far from the step each side has its own: 2 and 1.
    EXPECT_NEAR(gain(1, -0.03)[0], 2, 0.04) << ridge;
    EXPECT_NEAR(gain(1, 0.03)[0], 1, 0.02) << ridge;
    // Two millimetres from it on a ridge as well; on the flat the step is spread.
    const double near_m = 0.002;
    if (ridge)
    {
      EXPECT_NEAR(gain(1, -near_m)[0], 2, 0.1);
      EXPECT_NEAR(gain(1, near_m)[0], 1, 0.05);
    }
    else
    {
      EXPECT_LT(gain(1, -near_m)[0], 1.8);
      EXPECT_GT(gain(1, near_m)[0], 1.06);
    }
  }
}

TEST_F(LightGainsOfASquare, TakeLittleNoteOfAHighlight)
{
  // A stripe of 2 mm, under light 1 alone, that is 2.2 times as bright.
  makeMesh(false);
  addView(0, everywhere(1, 1, 1));
  addView(1, [](double x_m) { return Eigen::Vector3f::Constant(std::abs(x_m) < 0.001 ? 2.2F : 1); });
  solve();
  EXPECT_NEAR(gain(1, 0)[1], 1, 0.13) << "1 / sqrt(2.2), 0.67, would make it vanish";
  EXPECT_NEAR(gain(1, 0.02)[1], 1, 0.01);
}

TEST_F(LightGainsOfASquare, CountNoColorsThatTellNothing)
{
  // Under light 1 the right half is black, and clipped under light 2.
  makeMesh(false);
  const auto right = [](float value)
  { return [=](double x_m) { return Eigen::Vector3f::Constant(x_m > 0.0005 ? value / COLOR : 0.5F); }; };
  addView(0, everywhere(1, 1, 1));
  addView(1, right(3));
  addView(2, right(254));
  solve();
  expectGains(0, Eigen::Vector3f::Constant(std::pow(0.5F, 2 / 3.0F)), 0.03);
  expectGains(1, Eigen::Vector3f::Constant(std::pow(0.5F, -1 / 3.0F)), 0.03);
  expectGains(2, Eigen::Vector3f::Constant(std::pow(0.5F, -1 / 3.0F)), 0.03);
}

TEST_F(LightGainsOfASquare, AreOneWhereNothingTells)
{
  // Light 1 has no view, light 2 sees nothing of it.
  makeMesh(false);
  addView(0, everywhere(1, 1, 1));
  addView(2, everywhere(0.5F, 0.5F, 0.5F), 1, 2);
  solve();
  ASSERT_EQ(gains_.size(), 3u);
  for (int light = 0; light < 3; ++light)
    expectGains(light, Eigen::Vector3f::Ones(), SOLVED);
}

TEST_F(LightGainsOfASquare, AreNoneUnderOneLight)
{
  makeMesh(false);
  addView(0, everywhere(1, 1, 1));
  addView(0, everywhere(0.5F, 0.5F, 0.5F));
  solve();
  EXPECT_TRUE(gains_.empty());
}

}  // namespace
}  // namespace object_modelling::texture
