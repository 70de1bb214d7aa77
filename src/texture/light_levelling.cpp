#include "light_levelling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "exposure.h"
#include "object_modelling/geometry/image_sampling.h"
#include "object_modelling/mesh/mesh_topology.h"

namespace object_modelling::texture
{
namespace
{
constexpr double SMOOTH_M = 0.003;       // finer differences are texture, out of register, and noise
constexpr double EDGE_SOFTNESS = 0.05;   // 1 - cos between normals over which the light may change freely
constexpr double LEAST_TIE = 0.01;       // across an edge
constexpr double PULL_TO_ONE = 1e-4;     // what nothing else determines
constexpr double LIGHT_LOG_SIGMA = 0.3;  // differences that stay beyond are highlights or edges of texture
constexpr double PATCH_M = 0.005;
constexpr int ROUNDS = 3;
constexpr int MAX_ITERATIONS = 400;
constexpr double TOLERANCE = 1e-3;

/// Logarithms of the colours of every vertex under every light, one row a channel; weight 0 where it was not seen.
struct LitColors
{
  std::vector<std::vector<Eigen::Vector3f>> log_bgr;
  std::vector<std::vector<float>> weight;
};

LitColors collect(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views, const VertexWeights& weights,
                  const std::vector<Eigen::Vector3f>& view_gains, int light_count)
{
  LitColors colors;
  colors.log_bgr.assign(light_count, std::vector<Eigen::Vector3f>(weights.size(), Eigen::Vector3f::Zero()));
  colors.weight.assign(light_count, std::vector<float>(weights.size(), 0));
#pragma omp parallel for schedule(dynamic, 256)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(weights.size()); ++i)
  {
    std::vector<float> total(light_count, 0);
    for (const VertexView& seen : weights[i])
    {
      const TextureView& view = views[seen.view];
      const auto log_bgr = logColor(
          view_gains[seen.view].cwiseProduct(geometry::colorAt(view.smooth_bgr, colorPixel(view, mesh.vertices[i]))));
      if (!log_bgr)
        continue;
      colors.log_bgr[view.light][i] += seen.weight * *log_bgr;
      total[view.light] += seen.weight;
    }
    for (int light = 0; light < light_count; ++light)
      if (total[light] > 0)
      {
        colors.log_bgr[light][i] /= total[light];
        colors.weight[light][i] = 1;
      }
  }
  return colors;
}

/// How strongly the gains of neighbours are tied; by edges (i, j), j > i.
struct Tie
{
  std::uint32_t i, j;
  double strength;
};

std::vector<Tie> tiesOf(const mesh::TriangleMesh& mesh)
{
  const std::vector<std::vector<std::uint32_t>> neighbors = mesh::vertexNeighbors(mesh);
  std::vector<Tie> ties;
  double length_m = 0;
  for (std::uint32_t i = 0; i < neighbors.size(); ++i)
    for (const std::uint32_t j : neighbors[i])
      if (j > i)
      {
        const double bend = 1 - static_cast<double>(mesh.normals[i].dot(mesh.normals[j]));
        ties.push_back({ i, j, LEAST_TIE + std::exp(-bend / EDGE_SOFTNESS) });
        length_m += (mesh.vertices[j] - mesh.vertices[i]).norm();
      }
  // Of six neighbours every direction along the surface has three.
  const double rings = SMOOTH_M * static_cast<double>(ties.size()) / std::max(length_m, 1e-9) / std::sqrt(3.0);
  for (Tie& tie : ties)
    tie.strength *= rings * rings;
  return ties;
}

/// Residuals sqrt(w) (c + g - m) with each vertex's own m eliminated, and sqrt(tie) (g_i - g_j).
Eigen::SparseMatrix<double> normalMatrix(const LitColors& colors, const std::vector<Tie>& ties, std::size_t vertices)
{
  const auto lights = static_cast<int>(colors.weight.size());
  const auto n = static_cast<int>(vertices);
  std::vector<Eigen::Triplet<double>> entries;
  for (int light = 0; light < lights; ++light)
    for (const Tie& tie : ties)
    {
      const int a = light * n + static_cast<int>(tie.i), b = light * n + static_cast<int>(tie.j);
      entries.emplace_back(a, a, tie.strength);
      entries.emplace_back(b, b, tie.strength);
      entries.emplace_back(a, b, -tie.strength);
      entries.emplace_back(b, a, -tie.strength);
    }
  for (int i = 0; i < n; ++i)
  {
    double total = 0;
    for (int light = 0; light < lights; ++light)
      total += colors.weight[light][i];
    for (int light = 0; light < lights; ++light)
    {
      const double weight = colors.weight[light][i];
      entries.emplace_back(light * n + i, light * n + i, PULL_TO_ONE + weight);
      for (int other = 0; other < lights && weight > 0; ++other)
        if (colors.weight[other][i] > 0)
          entries.emplace_back(light * n + i, other * n + i, -weight * colors.weight[other][i] / total);
    }
  }
  Eigen::SparseMatrix<double> matrix(lights * n, lights * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Which patch of the surface every vertex belongs to: those of one cell that face alike.
std::vector<int> patchesOf(const mesh::TriangleMesh& mesh)
{
  std::map<std::array<int, 4>, int> numbers;
  std::vector<int> patches;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
  {
    const Eigen::Vector3i cell = (mesh.vertices[i] / static_cast<float>(PATCH_M)).array().floor().cast<int>();
    int axis = 0;
    mesh.normals[i].cwiseAbs().maxCoeff(&axis);
    const int facing = 2 * axis + (mesh.normals[i][axis] > 0 ? 1 : 0);
    patches.push_back(
        numbers.emplace(std::array<int, 4>{ cell.x(), cell.y(), cell.z(), facing }, numbers.size()).first->second);
  }
  return patches;
}

/// The solution that is constant over patches: what is far from any data takes conjugate gradients, which pass on from
/// neighbour to neighbour, very long.
class PatchSolver
{
public:
  PatchSolver(const std::vector<int>& patches, std::size_t lights, const Eigen::SparseMatrix<double>& matrix)
  {
    const int count = 1 + *std::max_element(patches.begin(), patches.end());
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t light = 0; light < lights; ++light)
      for (std::size_t i = 0; i < patches.size(); ++i)
        entries.emplace_back(static_cast<int>(light * patches.size() + i), static_cast<int>(light) * count + patches[i],
                             1.0);
    spread_.resize(matrix.rows(), static_cast<Eigen::Index>(lights) * count);
    spread_.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseMatrix<double> gathered = spread_.transpose() * matrix;
    solver_.compute(gathered * spread_);
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const
  {
    return spread_ * solver_.solve(spread_.transpose() * right);
  }

private:
  Eigen::SparseMatrix<double> spread_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

/// w (m - c), m: the mean of the vertex.
Eigen::VectorXd rightSide(const LitColors& colors, int channel, std::size_t vertices)
{
  const std::size_t lights = colors.weight.size();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(lights * vertices));
  for (std::size_t i = 0; i < vertices; ++i)
  {
    double total = 0, sum = 0;
    for (std::size_t light = 0; light < lights; ++light)
    {
      total += colors.weight[light][i];
      sum += colors.weight[light][i] * colors.log_bgr[light][i][channel];
    }
    for (std::size_t light = 0; light < lights && total > 0; ++light)
      right[static_cast<Eigen::Index>(light * vertices + i)] =
          colors.weight[light][i] * (sum / total - colors.log_bgr[light][i][channel]);
  }
  return right;
}

/// Takes weight from vertices whose colours still differ.
void reweight(const Eigen::MatrixXd& log_gains, LitColors* colors)
{
  const std::size_t lights = colors->weight.size(), vertices = colors->weight.front().size();
  for (std::size_t i = 0; i < vertices; ++i)
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
    double count = 0;
    for (std::size_t light = 0; light < lights; ++light)
      if (colors->weight[light][i] > 0)
      {
        const Eigen::Vector3d color = colors->log_bgr[light][i].cast<double>() +
                                      log_gains.row(static_cast<Eigen::Index>(light * vertices + i)).transpose();
        sum += color;
        squares += color.cwiseAbs2();
        count += 1;
      }
    if (count < 2)
      continue;
    const double variance = (squares / count - (sum / count).cwiseAbs2()).maxCoeff();
    for (std::size_t light = 0; light < lights; ++light)
      if (colors->weight[light][i] > 0)
        colors->weight[light][i] = static_cast<float>(1 / (1 + variance / (LIGHT_LOG_SIGMA * LIGHT_LOG_SIGMA)));
  }
}
}  // namespace

LightGains levelLights(const mesh::TriangleMesh& mesh, const std::vector<TextureView>& views,
                       const VertexWeights& weights, const std::vector<Eigen::Vector3f>& view_gains)
{
  int light_count = 1;
  for (const TextureView& view : views)
    light_count = std::max(light_count, view.light + 1);
  if (light_count < 2)
    return {};
  LitColors colors = collect(mesh, views, weights, view_gains, light_count);
  const std::vector<Tie> ties = tiesOf(mesh);
  const std::vector<int> patches = patchesOf(mesh);
  const std::size_t vertices = mesh.vertices.size();
  Eigen::MatrixXd log_gains = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(light_count * vertices), 3);
  for (int round = 0; round < ROUNDS; ++round)
  {
    const Eigen::SparseMatrix<double> matrix = normalMatrix(colors, ties, vertices);
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
    solver.setMaxIterations(MAX_ITERATIONS);
    solver.setTolerance(TOLERANCE);
    solver.compute(matrix);
    const PatchSolver patch_solver(patches, light_count, matrix);
    for (int channel = 0; channel < 3; ++channel)
    {
      const Eigen::VectorXd right = rightSide(colors, channel, vertices);
      log_gains.col(channel) = solver.solveWithGuess(right, patch_solver.solve(right));
    }
    if (round + 1 < ROUNDS)
      reweight(log_gains, &colors);
  }
  LightGains gains(light_count, std::vector<Eigen::Vector3f>(vertices));
  for (int light = 0; light < light_count; ++light)
    for (std::size_t i = 0; i < vertices; ++i)
      gains[light][i] = log_gains.row(static_cast<Eigen::Index>(light * vertices + i))
                            .array()
                            .exp()
                            .matrix()
                            .transpose()
                            .cast<float>();
  return gains;
}

}  // namespace object_modelling::texture
