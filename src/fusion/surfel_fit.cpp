#include "surfel_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace object_modelling::fusion
{
namespace
{
constexpr float SAME_SIDE_COSINE = 0.5f;                   ///< normals less than 60 deg apart may be of one surface
constexpr int COARSE_ITERATIONS = 3, FINE_ITERATIONS = 1;  ///< the fine fit starts where the coarse one ended
constexpr float SPACING_RATIO = 0.8f;                      ///< least to aimed-at distance of fused points
/// On all but the height, as a share of the summed weights: it decides only where the observations do not.
constexpr float RIDGE_RATIO = 0.001f;
/// Far from the camera a neighbourhood must be as wide, or it holds a handful of pixels.
constexpr float LATERAL_SIGMAS = 4;
constexpr int MIN_OBSERVATIONS = 3;
/// The noise of neighbouring pixels is correlated: about so many make one independent measurement.
constexpr float CORRELATED_PIXELS = 6.f;

using Vector6f = Eigen::Matrix<float, 6, 1>;
using Matrix6f = Eigen::Matrix<float, 6, 6>;

/// Height of the surface over the seed's tangent plane as a polynomial a + b u + c v + d u^2 + e u v + f v^2 in units
/// of the averaging radius: a plane alone would cut corners where the surface is curved.
struct HeightFit
{
  Matrix6f A = Matrix6f::Zero();
  Vector6f b = Vector6f::Zero();

  void add(float u, float v, float height, float weight)
  {
    Vector6f row;
    row << 1, u, v, u * u, u * v, v * v;
    A.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    b += weight * height * row;
  }
  Eigen::LDLT<Matrix6f> factorised() const
  {
    Matrix6f full = A.selfadjointView<Eigen::Lower>();
    full.diagonal().tail<5>().array() += RIDGE_RATIO * A(0, 0);
    return full.ldlt();
  }
};

}  // namespace

std::vector<Observation> cellMeans(const ObservationGrid& grid)
{
  struct Cluster
  {
    Eigen::Vector3f point = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
    float information = 0, weight = 0, lateral_sigma_sum_m = 0;
  };
  std::vector<Observation> means;
  std::vector<Cluster> clusters;
  const std::vector<std::uint32_t>& starts = grid.cellStarts();
  for (std::size_t cell = 0; cell + 1 < starts.size(); ++cell)
  {
    clusters.clear();
    for (std::uint32_t i = starts[cell]; i < starts[cell + 1]; ++i)
    {
      const Observation& observation = grid.observations()[i];
      auto cluster = std::find_if(
          clusters.begin(), clusters.end(),
          [&](const Cluster& candidate)
          { return candidate.normal.dot(observation.normal) > SAME_SIDE_COSINE * candidate.normal.norm(); });
      if (cluster == clusters.end())
        cluster = clusters.insert(clusters.end(), Cluster());
      const float information = observation.information();
      cluster->point += information * observation.point;
      cluster->normal += information * observation.normal;
      cluster->information += information;
      cluster->weight += observation.weight;
      cluster->lateral_sigma_sum_m += observation.weight * observation.lateral_sigma_m;
    }
    for (const Cluster& cluster : clusters)
    {
      Observation mean;
      mean.point = cluster.point / cluster.information;
      mean.normal = cluster.normal.normalized();
      mean.weight = cluster.weight;
      mean.sigma_m = std::sqrt(cluster.weight / cluster.information);
      mean.lateral_sigma_m = cluster.lateral_sigma_sum_m / cluster.weight;
      means.push_back(mean);
    }
  }
  return means;
}

bool fitSurfel(const ObservationGrid& grid, const CloudFusionOptions& options, int iterations,
               std::vector<char>* views_scratch, Surfel* surfel)
{
  const float radius_m = surfel->radius_m;
  const auto sigmas = static_cast<float>(options.consistency_sigmas);
  for (int iteration = 0; iteration < iterations; ++iteration)
  {
    const bool last = iteration + 1 == iterations;
    const Eigen::Vector3f n = surfel->normal, e1 = n.unitOrthogonal(), e2 = n.cross(e1);
    HeightFit fit;
    Eigen::Vector3f normal_sum = Eigen::Vector3f::Zero();
    float sum = 0, square_sum = 0, height_square_sum = 0, weight_sum = 0;
    int count = 0;
    if (last)
      std::fill(views_scratch->begin(), views_scratch->end(), 0);
    grid.forNeighbors(surfel->point, radius_m,
                      [&](std::uint32_t, const Observation& observation)
                      {
                        const Eigen::Vector3f d = observation.point - surfel->point;
                        const float height = n.dot(d);
                        const float lateral_squared = d.squaredNorm() - height * height;
                        if (lateral_squared > radius_m * radius_m || std::abs(height) > sigmas * observation.sigma_m ||
                            n.dot(observation.normal) < SAME_SIDE_COSINE)
                          return;
                        const float falloff = 1 - lateral_squared / (radius_m * radius_m);
                        const float kernel = falloff * falloff;
                        const float w = kernel * observation.information();
                        fit.add(e1.dot(d) / radius_m, e2.dot(d) / radius_m, height, w);
                        normal_sum += w * observation.normal;
                        sum += w;
                        square_sum += w * w;
                        height_square_sum += w * height * height;
                        weight_sum += kernel * observation.weight;
                        ++count;
                        if (last)
                          (*views_scratch)[observation.view] = 1;
                      });
    if (count < MIN_OBSERVATIONS || !(normal_sum.norm() > 0))
      return false;
    const Eigen::LDLT<Matrix6f> factorised = fit.factorised();
    const Vector6f height = factorised.solve(fit.b);
    surfel->point += height[0] * n;
    surfel->normal = normal_sum.normalized();
    if (!last)
      continue;
    // Observed normals are steady but average over ridges; the fit's own follows them but is noisier: the mean of both.
    const Eigen::Vector3f n_fit = (n - (height[1] * e1 + height[2] * e2) / radius_m).normalized();
    surfel->normal = (surfel->normal + n_fit).normalized();
    const float residual_variance = std::max(0.f, height_square_sum - height.dot(fit.b)) / sum;
    const float leverage = factorised.solve(Vector6f::Unit(0))[0] * square_sum / sum;
    surfel->sigma_m = std::sqrt(residual_variance * leverage * CORRELATED_PIXELS);
    surfel->weight = weight_sum;
    surfel->views = static_cast<int>(std::count(views_scratch->begin(), views_scratch->end(), 1));
  }
  return surfel->point.allFinite();
}

std::vector<Surfel> fitSurfels(const ObservationGrid& grid, const CloudFusionOptions& options, int iterations,
                               int view_count, int min_views, std::vector<Surfel> seeds)
{
  std::vector<char> good(seeds.size(), 0);
#pragma omp parallel
  {
    std::vector<char> views_scratch(view_count, 0);
#pragma omp for schedule(dynamic, 256)
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(seeds.size()); ++i)
      good[i] = fitSurfel(grid, options, iterations, &views_scratch, &seeds[i]) && seeds[i].views >= min_views;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < seeds.size(); ++i)
  {
    if (good[i])
      seeds[kept++] = seeds[i];
  }
  seeds.resize(kept);
  return seeds;
}

std::vector<Surfel> fuseSurface(const ObservationGrid& grid, const CloudFusionOptions& options, int view_count)
{
  const auto spacing_m = static_cast<float>(SPACING_RATIO * options.resolution_m);
  const std::vector<Observation> means = cellMeans(grid);
  std::vector<Surfel> seeds(means.size());
  for (std::size_t i = 0; i < means.size(); ++i)
  {
    seeds[i].point = means[i].point;
    seeds[i].normal = means[i].normal;
    seeds[i].radius_m =
        std::max(static_cast<float>(options.averaging_radius_m), LATERAL_SIGMAS * means[i].lateral_sigma_m);
  }
  const ObservationGrid coarse_grid({ means }, static_cast<float>(options.resolution_m));
  seeds = thinOut(fitSurfels(coarse_grid, options, COARSE_ITERATIONS, 1, 1, std::move(seeds)), spacing_m);
  return thinOut(fitSurfels(grid, options, FINE_ITERATIONS, view_count, options.min_views, std::move(seeds)),
                 spacing_m);
}

std::vector<Surfel> thinOut(const std::vector<Surfel>& surfels, float spacing_m)
{
  std::vector<std::size_t> order(surfels.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return surfels[a].weight > surfels[b].weight; });

  const auto cell_of = [&](const Eigen::Vector3f& p)
  { return Eigen::Array3i((p.array() / spacing_m).floor().cast<int>()); };
  const auto key_of = [](const Eigen::Array3i& cell)
  {
    const auto field = [](int value) { return static_cast<std::uint64_t>(value) & 0x1fffff; };
    return (field(cell.z()) << 42) | (field(cell.y()) << 21) | field(cell.x());
  };
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells;  // looked up only, never walked through
  std::vector<Surfel> kept;
  for (const std::size_t index : order)
  {
    const Surfel& surfel = surfels[index];
    const Eigen::Array3i cell = cell_of(surfel.point);
    bool crowded = false;
    for (int k = 0; k < 27 && !crowded; ++k)
    {
      const auto found = cells.find(key_of(cell + Eigen::Array3i(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
      if (found == cells.end())
        continue;
      crowded = std::any_of(found->second.begin(), found->second.end(),
                            [&](std::size_t other)
                            {
                              return (kept[other].point - surfel.point).squaredNorm() < spacing_m * spacing_m &&
                                     kept[other].normal.dot(surfel.normal) > SAME_SIDE_COSINE;
                            });
    }
    if (crowded)
      continue;
    cells[key_of(cell)].push_back(kept.size());
    kept.push_back(surfel);
  }
  return kept;
}

}  // namespace object_modelling::fusion
