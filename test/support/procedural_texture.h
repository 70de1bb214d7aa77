#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace object_modelling::test_support
{
/// Colour of a surface at a place on it.
struct Texture
{
  Eigen::Vector3f color_bgr{ 170, 170, 170 };  ///< mean colour, 0 to 255
  float contrast = 0.6f;                       ///< 0: plain; 1: from black to twice the mean colour
  float cell_m = 0.02f;                        ///< side of the larger patches; the finer ones have 0.37 of it
  std::uint32_t seed = 1;                      ///< another seed, another texture
};

inline Texture plainTexture(const Eigen::Vector3f& color_bgr = { 170, 170, 170 })
{
  return { color_bgr, 0, 0.02f, 0 };
}

/// Two turned grids of randomly coloured patches: corners at two scales, no repetition. `footprint_m` is what one pixel
/// covers: edges are as soft as that, so that nothing aliases and the pattern is the same from any distance.
/// `face`: number of the face; faces of one object differ.
Eigen::Vector3f textureColor(const Texture& texture, float a_m, float b_m, int face, float footprint_m);

}  // namespace object_modelling::test_support
