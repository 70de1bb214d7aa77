#include "object_modelling/texture/texturing.h"

#include <algorithm>
#include <cmath>

#include "atlas.h"
#include "color_fill.h"
#include "exposure.h"
#include "mesh_charts.h"
#include "object_modelling/base/options.h"
#include "object_modelling/geometry/image_sampling.h"
#include "object_modelling/mesh/mesh_topology.h"
#include "texel_painting.h"
#include "view_weights.h"

namespace object_modelling::texture
{
namespace
{
constexpr int STAGES = 4;

TextureResult nothing(base::StatusCode code, const std::string& reason)
{
  TextureResult result;
  result.status = { code, "no texture: " + reason };
  return result;
}

/// Per vertex what its views show on the whole, or what surrounds it.
std::vector<Eigen::Vector3f> vertexColors(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views,
                                          const VertexWeights& weights, const Exposure& exposure)
{
  std::vector<Eigen::Vector3f> colors(mesh.vertices.size(), Eigen::Vector3f::Zero());
  std::vector<char> known(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < colors.size(); ++i)
  {
    float total = 0;
    for (const VertexView& seen : weights[i])
    {
      const TextureView& view = views[seen.view];
      const Eigen::Vector3f gains =
          exposure.view_gains[seen.view].cwiseProduct(exposure.ofLight(view.light, static_cast<std::uint32_t>(i)));
      colors[i] +=
          seen.weight * gains.cwiseProduct(geometry::colorAt(view.smooth_bgr, colorPixel(view, mesh.vertices[i])));
      total += seen.weight;
    }
    known[i] = total > 0;
    if (known[i])
      colors[i] /= total;
  }
  fillHarmonically(mesh, known, &colors);
  return colors;
}

/// The view that weighs most at the corners of each triangle; -1 without any.
std::vector<int> bestViews(const mesh::TriangleMesh& mesh, const VertexWeights& weights, std::size_t view_count)
{
  std::vector<int> best(mesh.triangles.size(), -1);
  std::vector<float> sum(view_count, 0);
  for (std::size_t t = 0; t < best.size(); ++t)
  {
    for (const std::uint32_t vertex : mesh.triangles[t])
      for (const VertexView& seen : weights[vertex])
      {
        sum[seen.view] += seen.weight;
        if (best[t] < 0 || sum[seen.view] > sum[best[t]])
          best[t] = seen.view;
      }
    for (const std::uint32_t vertex : mesh.triangles[t])
      for (const VertexView& seen : weights[vertex])
        sum[seen.view] = 0;
  }
  return best;
}

float step(const Eigen::Vector3f& a, const Eigen::Vector3f& b)
{
  return (a - b).cwiseAbs().mean();
}

void measureSeams(const Paint& paint, const Atlas& atlas, TextureResult* result)
{
  const mesh::TriangleMesh& mesh = paint.mesh;
  const std::vector<int> best = bestViews(mesh, paint.weights, paint.views.size());
  const mesh::TriangleNeighbors neighbors = mesh::triangleNeighbors(mesh);
  double before = 0, after = 0;
  std::size_t view_borders = 0, chart_borders = 0;
  for (std::size_t t = 0; t < best.size(); ++t)
    for (int k = 0; k < 3; ++k)
    {
      const int other = neighbors[t][k];
      if (other <= static_cast<int>(t))
        continue;
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (best[t] >= 0 && best[other] >= 0 && best[t] != best[other])
      {
        const Eigen::Vector3f middle = 0.5f * (mesh.vertices[a] + mesh.vertices[b]);
        const TextureView &one = paint.views[best[t]], &two = paint.views[best[other]];
        before += step(geometry::colorAt(one.frame->color_bgr, colorPixel(one, middle)),
                       geometry::colorAt(two.frame->color_bgr, colorPixel(two, middle)));
        ++view_borders;
      }
      if (atlas.chart[t] != atlas.chart[other])
      {
        const auto& triangle = mesh.triangles[other];
        const auto corner_of = [&](std::uint32_t vertex)
        { return std::find(triangle.begin(), triangle.end(), vertex) - triangle.begin(); };
        const Eigen::Vector2f here = 0.5f * (atlas.texels[t][k] + atlas.texels[t][(k + 1) % 3]);
        const Eigen::Vector2f there = 0.5f * (atlas.texels[other][corner_of(a)] + atlas.texels[other][corner_of(b)]);
        after += step(geometry::colorAt(result->textured.texture_bgr, here),
                      geometry::colorAt(result->textured.texture_bgr, there));
        ++chart_borders;
      }
    }
  result->seam_step_before = view_borders > 0 ? before / static_cast<double>(view_borders) : 0;
  result->seam_step_after = chart_borders > 0 ? after / static_cast<double>(chart_borders) : 0;
}

double seenRatio(const mesh::TriangleMesh& mesh, const VertexWeights& weights)
{
  double seen = 0, total = 0;
  for (const auto& [a, b, c] : mesh.triangles)
  {
    const double area = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
    total += area;
    seen += area * (!weights[a].empty() + !weights[b].empty() + !weights[c].empty()) / 3;
  }
  return total > 0 ? seen / total : 0;
}

void placeOnImage(const Atlas& atlas, mesh::TexturedMesh* textured)
{
  const auto width = static_cast<float>(atlas.size_px.width), height = static_cast<float>(atlas.size_px.height);
  textured->uvs.resize(atlas.texels.size());
  for (std::size_t t = 0; t < atlas.texels.size(); ++t)
    for (int k = 0; k < 3; ++k)
    {
      const Eigen::Vector2f& texel = atlas.texels[t][k];
      textured->uvs[t][k] = { (texel.x() + 0.5f) / width, 1 - (texel.y() + 0.5f) / height };
    }
}
}  // namespace

std::vector<std::string> TextureOptions::violations() const
{
  base::OptionsCheck check("texturing");
  check.inRange("texel_size_m", texel_size_m, 1e-5, 0.1);
  check.inRange("max_atlas_px", max_atlas_px, 64, 16384);
  check.inRange("padding_px", padding_px, 1, 64);
  check.inRange("view_preference", view_preference, 0.0, 100.0);
  check.inRange("outlier_tolerance", outlier_tolerance, 1.0, 255.0);
  return check.violations();
}

TextureResult textureMesh(const mesh::TriangleMesh& input, const std::vector<rgbd::View>& input_views,
                          const TextureOptions& options, base::JobControl& control)
{
  base::checked(options);
  control.report("texture", 0, STAGES);
  if (input.empty())
    return nothing(base::StatusCode::INVALID_ARGUMENT, "the mesh has no triangles");
  for (const auto& triangle : input.triangles)
    for (const std::uint32_t vertex : triangle)
      if (vertex >= input.vertices.size())
        return nothing(base::StatusCode::INVALID_ARGUMENT,
                       "a triangle of the mesh has vertex " + std::to_string(vertex) + ", which does not exist");
  if (input_views.empty())
    return nothing(base::StatusCode::NO_RESULT, "there are no views; record keyframes of the object");
  TextureResult result;
  result.textured.mesh = input;
  const mesh::TriangleMesh& mesh = result.textured.mesh;
  if (mesh.normals.size() != mesh.vertices.size())
    mesh::computeNormals(&result.textured.mesh);

  const std::vector<TextureView> views = prepareTextureViews(mesh, input_views);
  if (views.empty())
    return nothing(base::StatusCode::NO_RESULT, "none of the " + std::to_string(input_views.size()) +
                                                    " views has a colour image and the object in its mask; segment "
                                                    "the object first");
  control.report("texture", 1, STAGES);
  VertexWeights weights = weighViews(mesh, views);
  if (std::all_of(weights.begin(), weights.end(), [](const auto& of_vertex) { return of_vertex.empty(); }))
    return nothing(base::StatusCode::NO_RESULT, "none of the " + std::to_string(views.size()) +
                                                    " views sees the mesh; check the poses, masks and depth images");
  const Exposure exposure = solveExposure(mesh, views, weights);
  outvoteOutliers(mesh, views, exposure, options.outlier_tolerance, &weights);
  fadeAtBorders(mesh, views.size(), &weights);
  const std::vector<Eigen::Vector3f> colors = vertexColors(mesh, views, weights, exposure);

  control.report("texture", 2, STAGES);
  const std::vector<Chart> charts = makeCharts(mesh, options.texel_size_m);
  const Atlas atlas =
      packCharts(charts, mesh.triangles.size(), options.texel_size_m, options.padding_px, options.max_atlas_px);
  placeOnImage(atlas, &result.textured);
  result.chart_count = charts.size();
  result.texel_size_m = atlas.texel_size_m;

  control.report("texture", 3, STAGES);
  const Paint paint{ mesh, views, weights, exposure, options.view_preference };
  std::vector<ViewImage> images(views.size());
  for (std::size_t k = 0; k < views.size(); ++k)
    images[k] = correctedImage(views[k], exposure.view_gains[k]);
  const TexelOwners owners = findOwners(atlas);
  const cv::Mat texture_bgr = paintAtlas(paint, atlas, owners, images, colors, options.padding_px);
  texture_bgr.convertTo(result.textured.texture_bgr, CV_8UC3);
  result.textured.seen = seenTexels(paint, atlas, owners);
  measureSeams(paint, atlas, &result);
  result.seen_ratio = seenRatio(mesh, weights);
  result.gains.assign(input_views.size(), Eigen::Vector3f::Ones());
  for (std::size_t i = 0, k = 0; i < input_views.size() && k < views.size(); ++i)
    if (views[k].frame == &input_views[i].frame)
      result.gains[i] = exposure.view_gains[k++];
  control.report("texture", STAGES, STAGES);
  return result;
}

}  // namespace object_modelling::texture
