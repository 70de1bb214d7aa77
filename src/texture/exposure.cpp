#include "exposure.h"
#include "object_modelling/geometry/image_sampling.h"
#include "object_modelling/geometry/linear_systems.h"

#include <algorithm>
#include <cmath>

namespace object_modelling::texture
{
namespace
{
constexpr int ITERATIONS = 5;
constexpr float DARKEST = 12, BRIGHTEST = 243;  ///< levels beyond are noise or clipped
constexpr double EXPOSURE_LOG_SIGMA = 0.05;     ///< differences beyond are highlights or edges
constexpr double PRIOR = 1e-3;                  ///< of a view's total weight

struct LogColor
{
  int view = -1;
  Eigen::Vector3f log_bgr = Eigen::Vector3f::Zero();
};

/// Of every vertex under every light.
std::vector<std::vector<LogColor>> collect(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views,
                                           const VertexWeights& weights)
{
  int lights = 1;
  for (const TextureView& view : views)
    lights = std::max(lights, view.light + 1);
  std::vector<std::vector<LogColor>> samples(weights.size() * lights);
#pragma omp parallel for schedule(dynamic, 256)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(weights.size()); ++i)
  {
    for (const VertexView& seen : weights[i])
    {
      const TextureView& view = views[seen.view];
      const Eigen::Vector3f bgr = geometry::colorAt(view.smooth_bgr, colorPixel(view, mesh.vertices[i]));
      if (const std::optional<Eigen::Vector3f> log_bgr = logColor(bgr))
        samples[i * lights + view.light].push_back({ seen.view, *log_bgr });
    }
    for (int light = 0; light < lights; ++light)
      if (samples[i * lights + light].size() < 2)
        samples[i * lights + light].clear();
  }
  return samples;
}

/// Logarithms of the gains of one channel from those of the step before.
Eigen::VectorXd solveChannel(const std::vector<std::vector<LogColor>>& samples, int channel,
                             const Eigen::VectorXd& previous)
{
  const Eigen::Index count = previous.size();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  std::vector<double> weight;
  for (const std::vector<LogColor>& of_vertex : samples)
  {
    double sum = 0, total = 0;
    for (const LogColor& sample : of_vertex)
      sum += sample.log_bgr[channel] + previous[sample.view];
    const double common = of_vertex.empty() ? 0 : sum / static_cast<double>(of_vertex.size());
    weight.clear();
    double mean = 0;
    for (const LogColor& sample : of_vertex)
    {
      const double ratio = (sample.log_bgr[channel] + previous[sample.view] - common) / EXPOSURE_LOG_SIGMA;
      weight.push_back(1 / (1 + ratio * ratio));
      total += weight.back();
      mean += weight.back() * sample.log_bgr[channel];
    }
    // Residuals w_k (g_k + l_k - m) with the vertex's own m eliminated.
    for (std::size_t a = 0; a < of_vertex.size(); ++a)
    {
      const int view = of_vertex[a].view;
      normal(view, view) += weight[a];
      for (std::size_t b = 0; b < of_vertex.size(); ++b)
        normal(view, of_vertex[b].view) -= weight[a] * weight[b] / total;
      right[view] -= weight[a] * (of_vertex[a].log_bgr[channel] - mean / total);
    }
  }
  normal.diagonal() += PRIOR * normal.diagonal() + Eigen::VectorXd::Constant(count, 1e-9);
  Eigen::VectorXd log_gains = geometry::solveSymmetric(normal, right);
  return log_gains.array() - log_gains.mean();
}
}  // namespace

std::optional<Eigen::Vector3f> logColor(const Eigen::Vector3f& bgr)
{
  if (bgr.maxCoeff() < DARKEST || bgr.maxCoeff() > BRIGHTEST)
    return std::nullopt;
  return Eigen::Vector3f(bgr.array().max(DARKEST).log());
}

Exposure solveExposure(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views,
                       const VertexWeights& weights)
{
  Exposure exposure;
  exposure.view_gains = solveGains(mesh, views, weights);
  exposure.light_gains = levelLights(mesh, views, weights, exposure.view_gains);
  return exposure;
}

std::vector<Eigen::Vector3f> solveGains(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views,
                                        const VertexWeights& weights)
{
  const std::vector<std::vector<LogColor>> samples = collect(mesh, views, weights);
  std::vector<Eigen::Vector3f> gains(views.size(), Eigen::Vector3f::Ones());
#pragma omp parallel for
  for (int channel = 0; channel < 3; ++channel)
  {
    Eigen::VectorXd log_gains = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(views.size()));
    for (int iteration = 0; iteration < ITERATIONS; ++iteration)
      log_gains = solveChannel(samples, channel, log_gains);
    for (std::size_t k = 0; k < views.size(); ++k)
      gains[k][channel] = static_cast<float>(std::exp(log_gains[static_cast<Eigen::Index>(k)]));
  }
  return gains;
}

}  // namespace object_modelling::texture
