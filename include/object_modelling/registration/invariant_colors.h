#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace object_modelling::registration
{
using Rgb = Eigen::Matrix<std::uint8_t, 3, 1>;

/// What light, exposure and white balance leave of the colours of one session's surface; all three vectors have one
/// length. First, the logarithm of the brightness without the session's shading (shadingOf()), against the mean of the
/// surroundings on the same side, in [-1.2, 1.2]. Then two opponent colours, red against green and both against blue,
/// whose length is compressed to [0, 1): a faint hue counts, a strong one counts little more.
std::vector<Eigen::Vector3f> invariantColors(const std::vector<Eigen::Vector3f>& points,
                                             const std::vector<Eigen::Vector3f>& normals,
                                             const std::vector<Rgb>& colors_rgb);

/// What of values on a surface is a smooth function of its normals, as the shading of a matt surface by distant lights
/// is: spherical harmonics of second order (Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance
/// Environment Maps, SIGGRAPH 2001, equation 13), fitted robustly, so that texture weighs little. Both in the frame of
/// the light. Zero for fewer than 30 points.
std::vector<float> shadingOf(const std::vector<float>& values, const std::vector<Eigen::Vector3f>& normals);

}  // namespace object_modelling::registration
