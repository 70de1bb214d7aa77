#include "patch_kernels.h"

#include <cstdint>
#include <cstring>

#include "object_modelling/base/multiversion.h"

// Loops of fixed length over registers of eight: most of the time that tracking takes is spent here. Hence no
// geometry::bilinear(), which takes one position at a time.
namespace object_modelling::registration
{
namespace
{
constexpr int LANES = 8;
constexpr float AREA = PATCH_SIDE * PATCH_SIDE;
using Lanes = float __attribute__((vector_size(LANES * sizeof(float))));

// By pointer: with and without AVX, registers are passed in different ways.
inline __attribute__((always_inline)) void load(const float* from, Lanes* to)
{
  std::memcpy(to, from, sizeof(Lanes));
}

inline __attribute__((always_inline)) float sum(const Lanes& v)
{
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

/// The lanes of a row that are pixels of the patch.
constexpr Lanes INSIDE[2] = { { 1, 1, 1, 1, 1, 1, 1, 1 }, { 1, 1, 1, 1, 1, 1, 1, 0 } };
}  // namespace

OBJECT_MODELLING_MULTIVERSION
void warpWindow(const cv::Mat& image, const Eigen::Matrix3f& H, PatchWindow* window)
{
  const std::uint8_t* data = image.data;
  const std::size_t step = image.step;
  const float* h = H.data();  // by columns
  for (int y = 0; y < WINDOW_SIDE; ++y)
  {
    const auto fy = static_cast<float>(y);
    const float u0 = h[3] * fy + h[6], v0 = h[4] * fy + h[7], z0 = h[5] * fy + h[8];
    float a[WINDOW_ROW], b[WINDOW_ROW];
    int iu[WINDOW_ROW], iv[WINDOW_ROW];
    for (int x = 0; x < WINDOW_ROW; ++x)
    {
      const auto fx = static_cast<float>(x);
      const float inverse_z = 1 / (h[2] * fx + z0);
      const float u = (h[0] * fx + u0) * inverse_z;
      const float v = (h[1] * fx + v0) * inverse_z;
      iu[x] = static_cast<int>(u);
      iv[x] = static_cast<int>(v);
      a[x] = u - static_cast<float>(iu[x]);
      b[x] = v - static_cast<float>(iv[x]);
    }
    // Two neighbours at once, on processors that put the first of two bytes below the second.
    std::uint16_t upper[WINDOW_ROW] = {}, lower[WINDOW_ROW] = {};
    for (int x = 0; x < WINDOW_SIDE; ++x)
    {
      const std::uint8_t* at = data + static_cast<std::size_t>(iv[x]) * step + iu[x];
      std::memcpy(&upper[x], at, sizeof(std::uint16_t));
      std::memcpy(&lower[x], at + step, sizeof(std::uint16_t));
    }
    float* out = &window->pixels[static_cast<std::size_t>(y) * WINDOW_ROW];
    for (int x = 0; x < WINDOW_ROW; ++x)
    {
      const auto left = static_cast<float>(upper[x] & 255), right = static_cast<float>(upper[x] >> 8);
      const auto left_below = static_cast<float>(lower[x] & 255), right_below = static_cast<float>(lower[x] >> 8);
      const float top = left + a[x] * (right - left);
      out[x] = top + b[x] * (left_below + a[x] * (right_below - left_below) - top);
    }
  }
}

OBJECT_MODELLING_MULTIVERSION
void shiftWindow(const cv::Mat& image, int u, int v, float a, float b, PatchWindow* window)
{
  float across[2][WINDOW_ROW] = {};
  for (int y = 0; y <= WINDOW_SIDE; ++y)
  {
    const std::uint8_t* row = image.data + static_cast<std::size_t>(v + y) * image.step + u;
    float* current = across[y % 2];
    for (int x = 0; x < WINDOW_SIDE; ++x)
      current[x] = static_cast<float>(row[x]) + a * static_cast<float>(row[x + 1] - row[x]);
    if (y == 0)
      continue;
    const float* last = across[1 - y % 2];
    float* out = &window->pixels[static_cast<std::size_t>(y - 1) * WINDOW_ROW];
    for (int x = 0; x < WINDOW_ROW; ++x)
      out[x] = last[x] + b * (current[x] - last[x]);
  }
}

OBJECT_MODELLING_MULTIVERSION
void makeTemplate(const PatchWindow& window, PatchTemplate* patch)
{
  Lanes total = {};
  for (int y = 0; y < PATCH_SIDE; ++y)
    for (int half = 0; half < 2; ++half)
    {
      const float* at = &window.pixels[static_cast<std::size_t>(y + 1) * WINDOW_ROW + 1 + half * LANES];
      Lanes value, left, right, above, below;
      load(at, &value);
      load(at - 1, &left);
      load(at + 1, &right);
      load(at - WINDOW_ROW, &above);
      load(at + WINDOW_ROW, &below);
      const Lanes inside = INSIDE[half];
      value *= inside;
      const Lanes gradient_x = 0.5F * (right - left) * inside;
      const Lanes gradient_y = 0.5F * (below - above) * inside;
      total += value;
      const std::size_t to = static_cast<std::size_t>(y) * PATCH_ROW + half * LANES;
      std::memcpy(&patch->value[to], &value, sizeof(Lanes));
      std::memcpy(&patch->gradient_x[to], &gradient_x, sizeof(Lanes));
      std::memcpy(&patch->gradient_y[to], &gradient_y, sizeof(Lanes));
    }
  const float mean = sum(total) / AREA;
  Lanes squares = {};
  for (int y = 0; y < PATCH_SIDE; ++y)
    for (int half = 0; half < 2; ++half)
    {
      float* at = &patch->value[static_cast<std::size_t>(y) * PATCH_ROW + half * LANES];
      Lanes value;
      load(at, &value);
      value -= mean * INSIDE[half];
      squares += value * value;
      std::memcpy(at, &value, sizeof(Lanes));
    }
  patch->variance = sum(squares);
}

OBJECT_MODELLING_MULTIVERSION
void comparePatch(const PatchTemplate& patch, const PatchWindow& window, PatchDifference* difference)
{
  Lanes total = {}, products = {};
  for (int y = 0; y < PATCH_SIDE; ++y)
    for (int half = 0; half < 2; ++half)
    {
      Lanes value, reference;
      load(&window.pixels[static_cast<std::size_t>(y + 1) * WINDOW_ROW + 1 + half * LANES], &value);
      load(&patch.value[static_cast<std::size_t>(y) * PATCH_ROW + half * LANES], &reference);
      total += value * INSIDE[half];
      products += value * reference;  // whose mean is zero, so that the window's does not matter
    }
  const float mean = sum(total) / AREA;
  PatchDifference result;
  result.covariance = sum(products);
  result.gain = result.covariance / patch.variance;
  Lanes squares = {}, sum_x = {}, sum_y = {}, xx = {}, xy = {}, yy = {}, xt = {}, yt = {}, xr = {}, yr = {};
  for (int y = 0; y < PATCH_SIDE; ++y)
    for (int half = 0; half < 2; ++half)
    {
      const float* at = &window.pixels[static_cast<std::size_t>(y + 1) * WINDOW_ROW + 1 + half * LANES];
      const std::size_t of_patch = static_cast<std::size_t>(y) * PATCH_ROW + half * LANES;
      const Lanes inside = INSIDE[half];
      Lanes value, left, right, above, below, reference, gx, gy;
      load(at, &value);
      load(at - 1, &left);
      load(at + 1, &right);
      load(at - WINDOW_ROW, &above);
      load(at + WINDOW_ROW, &below);
      load(&patch.value[of_patch], &reference);
      load(&patch.gradient_x[of_patch], &gx);
      load(&patch.gradient_y[of_patch], &gy);
      value = (value - mean) * inside;
      squares += value * value;
      value -= result.gain * reference;
      gx = 0.5F * (result.gain * gx + 0.5F * (right - left) * inside);
      gy = 0.5F * (result.gain * gy + 0.5F * (below - above) * inside);
      sum_x += gx;
      sum_y += gy;
      xx += gx * gx;
      xy += gx * gy;
      yy += gy * gy;
      xt += gx * reference;
      yt += gy * reference;
      xr += gx * value;
      yr += gy * value;
    }
  result.variance = sum(squares);
  const float x = sum(sum_x), y = sum(sum_y), x_gain = sum(xt), y_gain = sum(yt);
  result.a_xx = sum(xx) - x * x / AREA - x_gain * x_gain / patch.variance;
  result.a_xy = sum(xy) - x * y / AREA - x_gain * y_gain / patch.variance;
  result.a_yy = sum(yy) - y * y / AREA - y_gain * y_gain / patch.variance;
  // The residual has neither mean nor a part along the template.
  result.b_x = sum(xr);
  result.b_y = sum(yr);
  *difference = result;
}

}  // namespace object_modelling::registration
