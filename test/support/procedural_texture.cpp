#include "support/procedural_texture.h"

#include <algorithm>
#include <cmath>

namespace object_modelling::test_support
{
namespace
{
/// Integer hash with full avalanche (Wellons, "lowbias32").
std::uint32_t hash(std::uint32_t x)
{
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ (x >> 16);
}

/// Three values in [-1, 1] for a patch: mostly one gray level, with some hue.
Eigen::Vector3f patch(int i, int j, std::uint32_t seed)
{
  const std::uint32_t bits =
      hash(static_cast<std::uint32_t>(i) * 0x9e3779b1U ^ hash(static_cast<std::uint32_t>(j) ^ seed));
  const auto level = [&](int shift) { return static_cast<float>((bits >> shift) & 0xff) / 127.5f - 1.0f; };
  return Eigen::Vector3f::Constant(0.7f * level(0)) + 0.3f * Eigen::Vector3f(level(8), level(16), level(24));
}

/// Patches of side 1 around integer coordinates, their borders one footprint wide.
Eigen::Vector3f patches(float a, float b, float footprint, std::uint32_t seed)
{
  const float floor_a = std::floor(a);
  const float floor_b = std::floor(b);
  const float sharpness = 1.0f / std::clamp(footprint, 0.02f, 1.0f);
  const float s = std::clamp((a - floor_a - 0.5f) * sharpness + 0.5f, 0.0f, 1.0f);
  const float t = std::clamp((b - floor_b - 0.5f) * sharpness + 0.5f, 0.0f, 1.0f);
  const int i = static_cast<int>(floor_a);
  const int j = static_cast<int>(floor_b);
  Eigen::Vector3f value = Eigen::Vector3f::Zero();
  if (s < 1 && t < 1)
    value += (1 - s) * (1 - t) * patch(i, j, seed);
  if (s > 0 && t < 1)
    value += s * (1 - t) * patch(i + 1, j, seed);
  if (s < 1 && t > 0)
    value += (1 - s) * t * patch(i, j + 1, seed);
  if (s > 0 && t > 0)
    value += s * t * patch(i + 1, j + 1, seed);
  return value;
}

}  // namespace

Eigen::Vector3f textureColor(const Texture& texture, float a_m, float b_m, int face, float footprint_m)
{
  if (texture.contrast <= 0)
    return texture.color_bgr;
  constexpr float COS = 0.8775826f;  // the finer grid is turned by half a radian
  constexpr float SIN = 0.4794255f;
  constexpr float FINER = 0.37f;
  const float scale = 1.0f / texture.cell_m;
  const std::uint32_t seed = hash(texture.seed * 0x85ebca6bU + static_cast<std::uint32_t>(face));
  const Eigen::Vector3f coarse = patches(a_m * scale, b_m * scale, footprint_m * scale, seed);
  const float fine_scale = scale / FINER;
  const Eigen::Vector3f fine = patches((COS * a_m - SIN * b_m) * fine_scale, (SIN * a_m + COS * b_m) * fine_scale,
                                       footprint_m * fine_scale, ~seed);
  const Eigen::Vector3f value = 0.6f * coarse + 0.4f * fine;
  return (texture.color_bgr.array() * (1 + texture.contrast * value.array())).max(0.0f).min(255.0f).matrix();
}

}  // namespace object_modelling::test_support
