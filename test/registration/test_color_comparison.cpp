#include "color_comparison.h"

#include <functional>

#include <gtest/gtest.h>

namespace object_modelling::registration
{
namespace
{
using ColorOf = std::function<Eigen::Vector3f(const Eigen::Vector3f& normal)>;

/// Of two views of a sphere, whose points are told by their normals.
ColorComparison::Result compare(const ColorOf& a, const ColorOf& b)
{
  ColorComparison comparison;
  constexpr int COUNT = 2000;
  for (int i = 0; i < COUNT; ++i)
  {
    const float z = 1 - 2 * (static_cast<float>(i) + 0.5F) / COUNT;
    const auto angle = static_cast<float>(i) * 2.39996F;  // golden angle
    const float r = std::sqrt(1 - z * z);
    const Eigen::Vector3f normal(r * std::cos(angle), r * std::sin(angle), z);
    comparison.add(a(normal), b(normal), normal);
  }
  return comparison.result();
}

/// Stripes of some strength; `phase_rad` makes other ones.
ColorOf stripes(float strength, float phase_rad)
{
  return [=](const Eigen::Vector3f& n)
  {
    return Eigen::Vector3f(strength * std::sin(20 * n.z() + phase_rad),
                           0.5F * strength * std::sin(15 * n.x() + phase_rad), 0);
  };
}

/// The light of a table that reflects its colour from below, or from where that is once the object is turned over.
ColorOf under(const Eigen::Vector3f& light, const ColorOf& texture)
{
  return [=](const Eigen::Vector3f& n)
  { return Eigen::Vector3f(texture(n) + light.dot(n) * Eigen::Vector3f(0.15F, -0.1F, 0.1F)); };
}

/// What is left of the differences once light is made up for.
double difference(const ColorComparison::Result& result)
{
  return result.texture * result.texture * (1 - result.agreement) - result.light_variance;
}

TEST(ColorComparison, TellsWeakPrintFromAnotherLight)
{
  const Eigen::Vector3f light = Eigen::Vector3f::UnitZ();
  const ColorComparison::Result same = compare(under(light, stripes(0.05F, 0)), under(-light, stripes(0.05F, 0)));
  EXPECT_LT(same.agreement, -0.5);
  EXPECT_LT(difference(same), 0.03 * same.light_variance);
  const ColorComparison::Result other = compare(under(light, stripes(0.05F, 0)), under(-light, stripes(0.05F, 1.6F)));
  EXPECT_GT(difference(other), 1e-3);
  EXPECT_NEAR(other.light_variance, same.light_variance, 0.1 * same.light_variance);
}

TEST(ColorComparison, WhatAnyPrintHasOfItIsNoLight)
{
  EXPECT_EQ(compare(stripes(0.3F, 0), stripes(0.3F, 1.6F)).light_variance, 0);
  // Blots as large as a sixth of the sphere, of which some are on one side more than on the other.
  const auto blots = [](float phase)
  {
    return [phase](const Eigen::Vector3f& n)
    {
      return Eigen::Vector3f(
          std::sin(4 * n.x() + phase) * std::sin(4 * n.y() + 2 * phase) * std::sin(4 * n.z() + phase), 0, 0);
    };
  };
  for (const float phase : { 0.5F, 1.0F, 2.0F })
  {
    const ColorComparison::Result other = compare(blots(phase), blots(phase + 1));
    EXPECT_LT(other.light_variance, 0.1 * difference(other)) << phase;
  }
}

TEST(ColorComparison, LightThatIsTheSameIsLeft)
{
  const ColorOf lit = under(Eigen::Vector3f::UnitY(), stripes(0.02F, 0));
  const ColorComparison::Result result = compare(lit, lit);
  EXPECT_NEAR(result.agreement, 1, 1e-6);
  EXPECT_GT(result.texture, 0.1);
  EXPECT_NEAR(result.light_variance, 0, 1e-9);
}

TEST(ColorComparison, PrintThatIsDarkOnOneSideIsNotLight)
{
  const auto half = [](float dark, const Eigen::Vector3f& n)
  { return Eigen::Vector3f(n.x() > 0 ? dark : -dark, 0, 0); };
  const auto one = [&](const Eigen::Vector3f& n) { return half(0.6F, n); };
  const auto turned = [&](const Eigen::Vector3f& n) { return half(-0.6F, n); };
  EXPECT_NEAR(compare(one, one).agreement, 1, 1e-6);
  EXPECT_LT(compare(one, turned).agreement, -0.9);
  EXPECT_GT(difference(compare(one, turned)), 0.3);
}

TEST(ColorComparison, IsZeroWithoutColorAndWithoutPoints)
{
  const auto gray = [](const Eigen::Vector3f&) { return Eigen::Vector3f::Zero(); };
  EXPECT_EQ(compare(gray, gray).agreement, 0);
  EXPECT_EQ(compare(gray, gray).texture, 0);
  EXPECT_EQ(compare(gray, gray).light_variance, 0);
  EXPECT_EQ(ColorComparison().result().agreement, 0);
}

TEST(ColorComparison, ComparesOnAFlatSurfaceToo)
{
  ColorComparison comparison;
  for (int i = 0; i < 500; ++i)
  {
    const float texture = 0.2F * std::sin(0.37F * static_cast<float>(i));
    comparison.add({ texture, 0, 0 }, { texture + 0.1F, 0.05F, 0 }, Eigen::Vector3f::UnitX());
  }
  EXPECT_NEAR(comparison.result().agreement, 1, 1e-4);
  EXPECT_NEAR(comparison.result().texture, 0.2 / std::sqrt(2), 0.005);
}
}  // namespace
}  // namespace object_modelling::registration
