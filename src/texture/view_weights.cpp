#include "view_weights.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exposure.h"
#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/image_sampling.h"
#include "object_modelling/mesh/mesh_topology.h"

namespace object_modelling::texture
{
namespace
{
constexpr float MIN_SHARPNESS = 0.2f, MAX_SHARPNESS = 2.f;
constexpr int FADE_RINGS = 3;
constexpr int AGREEMENT_ITERATIONS = 5;
constexpr float POSITION_SIGMA_PX = 0.7f;  ///< poses and mesh are off by so much: views may differ at edges
constexpr float MIN_AGREEMENT = 0.01f;     ///< what disagrees more is dropped

cv::Point nearestPixel(const TextureView& view, const Eigen::Vector3f& p_mesh)
{
  const Eigen::Vector2f pixel = colorPixel(view, p_mesh);
  return { std::clamp(cvRound(pixel.x()), 0, view.gradient.cols - 1),
           std::clamp(cvRound(pixel.y()), 0, view.gradient.rows - 1) };
}

/// Per view: its gradients per metre over the mean of all views at the vertices that it shares with others.
std::vector<float> sharpnessOf(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views,
                               const VertexWeights& weights)
{
  std::vector<double> own(views.size(), 0), common(views.size(), 0);
  std::vector<float> gradients;
  for (std::size_t i = 0; i < weights.size(); ++i)
  {
    if (weights[i].size() < 2)
      continue;
    gradients.clear();
    double mean = 0;
    for (const VertexView& seen : weights[i])
    {
      const TextureView& view = views[seen.view];
      gradients.push_back(view.gradient.at<float>(nearestPixel(view, mesh.vertices[i])) /
                          pixelSize_m(view, mesh.vertices[i]));
      mean += gradients.back() / static_cast<double>(weights[i].size());
    }
    for (std::size_t k = 0; k < gradients.size(); ++k)
    {
      own[weights[i][k].view] += gradients[k];
      common[weights[i][k].view] += mean;
    }
  }
  std::vector<float> sharpness(views.size(), 1);
  for (std::size_t k = 0; k < views.size(); ++k)
    if (common[k] > 0)
      sharpness[k] = std::clamp(static_cast<float>(own[k] / common[k]), MIN_SHARPNESS, MAX_SHARPNESS);
  return sharpness;
}

/// Views are compared in pairs, and beyond the best few they change no colour.
void keepBest(std::vector<VertexView>* seen)
{
  constexpr std::size_t MAX_VIEWS = 24;
  if (seen->size() <= MAX_VIEWS)
    return;
  const auto end = seen->begin() + MAX_VIEWS;
  std::partial_sort(seen->begin(), end, seen->end(),
                    [](const VertexView& a, const VertexView& b)
                    { return std::make_pair(-a.weight, a.view) < std::make_pair(-b.weight, b.view); });
  seen->erase(end, seen->end());
  std::sort(seen->begin(), seen->end(), [](const VertexView& a, const VertexView& b) { return a.view < b.view; });
}

/// Down-weights the views of one vertex by their distance from the common colour (Geman-McClure), which starts from
/// the median per channel.
void outvoteAt(const std::vector<Eigen::Vector3f>& colors, const std::vector<float>& tolerances,
               std::vector<VertexView>* seen)
{
  Eigen::Vector3f common;
  for (int c = 0; c < 3; ++c)
  {
    std::vector<float> values;
    for (const Eigen::Vector3f& color : colors)
      values.push_back(color[c]);
    common[c] = base::median(&values);
  }
  std::vector<float> agreement(seen->size(), 1);
  for (int iteration = 0; iteration < AGREEMENT_ITERATIONS; ++iteration)
  {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float total = 0;
    for (std::size_t k = 0; k < seen->size(); ++k)
    {
      const float ratio = (colors[k] - common).cwiseAbs().maxCoeff() / tolerances[k];
      agreement[k] = 1 / ((1 + ratio * ratio) * (1 + ratio * ratio));
      sum += agreement[k] * colors[k];
      total += agreement[k];
    }
    common = sum / total;
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < seen->size(); ++k)
    if (agreement[k] > MIN_AGREEMENT)
      (*seen)[kept++] = { (*seen)[k].view, (*seen)[k].weight * agreement[k] };
  if (kept > 0)
    seen->resize(kept);
}
}  // namespace

VertexWeights weighViews(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views)
{
  VertexWeights weights(mesh.vertices.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(weights.size()); ++i)
    for (int k = 0; k < static_cast<int>(views.size()); ++k)
    {
      const float quality = sight(views[k], mesh.vertices[i], mesh.normals[i]).quality;
      if (quality > 0)
        weights[i].push_back({ k, quality });
    }
  const std::vector<float> sharpness = sharpnessOf(mesh, views, weights);
  for (std::vector<VertexView>& of_vertex : weights)
    for (VertexView& seen : of_vertex)
      seen.weight *= sharpness[seen.view] * sharpness[seen.view];
  for (std::vector<VertexView>& of_vertex : weights)
    keepBest(&of_vertex);
  return weights;
}

void outvoteOutliers(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views, const Exposure& exposure,
                     double tolerance, VertexWeights* weights)
{
#pragma omp parallel for schedule(dynamic, 256)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(weights->size()); ++i)
  {
    std::vector<VertexView>& of_vertex = (*weights)[i];
    if (of_vertex.size() < 3)  // of two, the outlier cannot be identified
      continue;
    std::vector<Eigen::Vector3f> colors;
    std::vector<float> tolerances;
    for (const VertexView& seen : of_vertex)
    {
      const TextureView& view = views[seen.view];
      const float step = POSITION_SIGMA_PX * view.gradient.at<float>(nearestPixel(view, mesh.vertices[i]));
      const Eigen::Vector3f gains =
          exposure.view_gains[seen.view].cwiseProduct(exposure.ofLight(view.light, static_cast<std::uint32_t>(i)));
      colors.emplace_back(gains.cwiseProduct(geometry::colorAt(view.smooth_bgr, colorPixel(view, mesh.vertices[i]))));
      tolerances.push_back(std::hypot(static_cast<float>(tolerance), step));
    }
    outvoteAt(colors, tolerances, &of_vertex);
  }
}

void fadeAtBorders(const mesh::TriangleMesh& mesh, std::size_t view_count, VertexWeights* weights)
{
  const std::vector<std::vector<std::uint32_t>> neighbors = mesh::vertexNeighbors(mesh);
  std::vector<std::vector<float>> by_view(view_count, std::vector<float>(mesh.vertices.size(), 0));
  for (std::size_t i = 0; i < weights->size(); ++i)
    for (const VertexView& seen : (*weights)[i])
      by_view[seen.view][i] = seen.weight;
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < static_cast<int>(view_count); ++k)
  {
    std::vector<float>& weight = by_view[k];
    std::vector<float> faded(weight.size());
    for (int ring = 0; ring < FADE_RINGS; ++ring)
    {
      for (std::size_t i = 0; i < weight.size(); ++i)
      {
        float sum = 0;
        for (const std::uint32_t neighbor : neighbors[i])
          sum += weight[neighbor];
        const auto count = static_cast<float>(std::max<std::size_t>(1, neighbors[i].size()));
        faded[i] = std::min(weight[i], sum / count);
      }
      weight.swap(faded);
    }
  }
#pragma omp parallel for schedule(dynamic, 256)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(weights->size()); ++i)
    for (VertexView& seen : (*weights)[i])
      seen.weight = std::max(by_view[seen.view][i], 1e-3f * seen.weight);  // a lone sight is still one
}

}  // namespace object_modelling::texture
