#include <gtest/gtest.h>

#include <cmath>

#include "object_modelling/registration/invariant_colors.h"

namespace object_modelling::registration
{
namespace
{
/// Points 2 mm apart on a ball of 40 mm radius, as a camera sees it under a light from above.
struct Ball
{
  std::vector<Eigen::Vector3f> points, normals;
  std::vector<Rgb> colors;

  /// `albedo` of a normal, RGB in [0, 1].
  template <typename Albedo>
  explicit Ball(const Albedo& albedo, const Eigen::Vector3f& light = Eigen::Vector3f(0.3F, 0.2F, 0.9F).normalized(),
                float exposure = 1)
  {
    constexpr int COUNT = 5000;
    constexpr float RADIUS_M = 0.04F, AMBIENT = 0.4F, DIRECT = 0.6F;
    for (int i = 0; i < COUNT; ++i)
    {
      const float z = 1 - 2 * (i + 0.5F) / COUNT, turn = 2.399963F * i, r = std::sqrt(1 - z * z);  // Fibonacci lattice
      const Eigen::Vector3f n(r * std::cos(turn), r * std::sin(turn), z);
      const float shade = AMBIENT + DIRECT * std::max(0.0F, n.dot(light));
      points.push_back(RADIUS_M * n);
      normals.push_back(n);
      colors.push_back((exposure * 200 * shade * albedo(n)).cwiseMin(255).template cast<std::uint8_t>());
    }
  }
  std::vector<Eigen::Vector3f> invariant() const { return invariantColors(points, normals, colors); }
};

const auto PLAIN = [](const Eigen::Vector3f&) { return Eigen::Vector3f(0.8F, 0.8F, 0.8F); };
const auto STRIPED = [](const Eigen::Vector3f& n)
{
  const bool dark = std::sin(20 * std::atan2(n.y(), n.x())) > 0;
  return dark ? Eigen::Vector3f(0.2F, 0.2F, 0.2F) : Eigen::Vector3f(0.9F, 0.9F, 0.9F);
};
const auto RED_SPOT = [](const Eigen::Vector3f& n)
{ return n.x() > 0.8F ? Eigen::Vector3f(0.9F, 0.1F, 0.1F) : Eigen::Vector3f(0.7F, 0.7F, 0.7F); };

/// Deviation of the first channel.
double contrastOf(const std::vector<Eigen::Vector3f>& colors)
{
  double sum = 0, squares = 0;
  for (const Eigen::Vector3f& color : colors)
  {
    sum += color[0];
    squares += color[0] * color[0];
  }
  const auto count = static_cast<double>(colors.size());
  return std::sqrt(squares / count - std::pow(sum / count, 2));
}

double correlation(const std::vector<Eigen::Vector3f>& a, const std::vector<Eigen::Vector3f>& b)
{
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    ab += a[i][0] * b[i][0];
    aa += a[i][0] * a[i][0];
    bb += b[i][0] * b[i][0];
  }
  return ab / std::sqrt(aa * bb);
}
}  // namespace

TEST(ShadingOf, IsAllOfAPlainBallsBrightness)
{
  const Ball ball(PLAIN);
  std::vector<float> logarithms;
  for (const Rgb& color : ball.colors)
    logarithms.push_back(std::log(color.cast<float>().sum()));
  const std::vector<float> shading = shadingOf(logarithms, ball.normals);
  double left = 0, all = 0, mean = 0;
  for (const float value : logarithms)
    mean += value / logarithms.size();
  for (std::size_t i = 0; i < shading.size(); ++i)
  {
    left += std::pow(logarithms[i] - shading[i], 2);
    all += std::pow(logarithms[i] - mean, 2);
  }
  EXPECT_LT(left, 0.1 * all);
}

TEST(ShadingOf, NothingOfTooFewPoints)
{
  const std::vector<float> values(29, 3.0F);
  for (const float shading : shadingOf(values, std::vector<Eigen::Vector3f>(29, Eigen::Vector3f::UnitZ())))
    EXPECT_EQ(shading, 0);
  EXPECT_TRUE(shadingOf({}, {}).empty());
}

TEST(InvariantColors, APlainThingHasNoPrint)
{
  EXPECT_LT(contrastOf(Ball(PLAIN).invariant()), 0.05);
}

TEST(InvariantColors, PrintStays)
{
  EXPECT_GT(contrastOf(Ball(STRIPED).invariant()), 0.3);
}

TEST(InvariantColors, LightAndExposureChangeLittle)
{
  const std::vector<Eigen::Vector3f> one = Ball(STRIPED).invariant();
  const std::vector<Eigen::Vector3f> other =
      Ball(STRIPED, Eigen::Vector3f(-1, 0.4F, 0.2F).normalized(), 0.6F).invariant();
  EXPECT_GT(correlation(one, other), 0.9);
}

TEST(InvariantColors, HueIsThatOfThePaintAndItsLengthIsBounded)
{
  const Ball ball(RED_SPOT);
  const std::vector<Eigen::Vector3f> colors = ball.invariant();
  for (std::size_t i = 0; i < colors.size(); ++i)
  {
    EXPECT_LT(colors[i].tail<2>().norm(), 1);
    const float x = ball.normals[i].x();
    if (x > 0.85F)
    {
      EXPECT_GT(colors[i][1], 0.5F);
    }
    if (x < 0.75F)
    {
      EXPECT_LT(colors[i].tail<2>().norm(), 0.05F);
    }
  }
}

}  // namespace object_modelling::registration
