#include "object_modelling/mesh/surface_sampling.h"

#include <cmath>

namespace object_modelling::mesh
{
std::vector<SurfaceSample> sampleEvenly(const TriangleMesh& mesh, std::size_t count)
{
  // Equal steps along the sum of areas, a low-discrepancy sequence inside the triangles.
  constexpr double GOLDEN_RATIO = 0.6180339887498949;
  const double step_m2 = surfaceArea_m2(mesh) / static_cast<double>(count);
  std::vector<SurfaceSample> samples;
  if (!(step_m2 > 0))
    return samples;
  samples.reserve(count + 1);
  double due_m2 = step_m2 / 2;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
  {
    const auto& triangle = mesh.triangles[t];
    const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[triangle[1]].cast<double>() - a;
    const Eigen::Vector3d c = mesh.vertices[triangle[2]].cast<double>() - a;
    const double area_m2 = b.cross(c).norm() / 2;
    for (; due_m2 < area_m2; due_m2 += step_m2)
    {
      const auto index = static_cast<double>(samples.size());
      const double r = std::sqrt(std::fmod((index + 0.5) * GOLDEN_RATIO, 1.0));
      const double s = std::fmod((index + 0.5) * GOLDEN_RATIO * GOLDEN_RATIO * M_SQRT2, 1.0);
      samples.push_back({ t, { 1 - r, r * (1 - s), r * s } });
    }
    due_m2 -= area_m2;
  }
  return samples;
}

Eigen::Vector3d pointAt(const TriangleMesh& mesh, const SurfaceSample& sample)
{
  const auto& [a, b, c] = mesh.triangles[sample.triangle];
  return sample.shares[0] * mesh.vertices[a].cast<double>() + sample.shares[1] * mesh.vertices[b].cast<double>() +
         sample.shares[2] * mesh.vertices[c].cast<double>();
}

}  // namespace object_modelling::mesh
