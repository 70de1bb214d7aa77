#include "object_modelling/report/quality_figures.h"

#include <algorithm>

#include "object_modelling/mesh/mesh_check.h"

namespace object_modelling::report
{
namespace
{
double meanSigma_m(const fusion::FusedCloud& cloud)
{
  double sum = 0;
  for (const float sigma_m : cloud.sigmas_m)
    sum += sigma_m;
  return cloud.sigmas_m.empty() ? 0 : sum / static_cast<double>(cloud.sigmas_m.size());
}
}  // namespace

std::map<std::string, double> qualityFigures(std::size_t view_count, const fusion::CloudFusionResult& fused,
                                             const mesh::TriangleMesh& mesh, const texture::TextureResult& texture)
{
  const mesh::MeshCheck check = mesh::checkMesh(mesh);
  const std::size_t observations = fused.observations_used + fused.observations_inconsistent;
  return { { "view_count", static_cast<double>(view_count) },
           { "point_count", static_cast<double>(fused.cloud.size()) },
           { "mean_sigma_m", meanSigma_m(fused.cloud) },
           { "inconsistent_observation_ratio", static_cast<double>(fused.observations_inconsistent) /
                                                   static_cast<double>(std::max<std::size_t>(1, observations)) },
           { "mesh_boundary_edge_count", static_cast<double>(check.boundary_edge_count) },
           { "mesh_manifold", check.manifold() ? 1.0 : 0.0 },
           { "mesh_watertight", check.watertight() ? 1.0 : 0.0 },
           { "texture_seen_ratio", texture.seen_ratio },
           { "texture_chart_count", static_cast<double>(texture.chart_count) },
           { "texture_texel_size_m", texture.texel_size_m },
           { "texture_seam_step_before", texture.seam_step_before },
           { "texture_seam_step_after", texture.seam_step_after } };
}

}  // namespace object_modelling::report
