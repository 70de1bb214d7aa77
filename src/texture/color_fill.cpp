#include "color_fill.h"

#include <Eigen/SparseCholesky>

#include "object_modelling/mesh/mesh_topology.h"

namespace object_modelling::texture
{
namespace
{
constexpr double PULL_TO_MEAN = 1e-6;  ///< makes the system solvable where nothing is known
}

void fillHarmonically(const mesh::TriangleMesh& mesh, const std::vector<char>& known,
                      std::vector<Eigen::Vector3f>* colors)
{
  std::vector<int> unknown_index(known.size(), -1);
  int count = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    if (known[i])
      mean += (*colors)[i].cast<double>();
    else
      unknown_index[i] = count++;
  }
  if (count == 0)
    return;
  const auto known_count = static_cast<double>(known.size()) - count;
  mean = known_count > 0 ? Eigen::Vector3d(mean / known_count) : Eigen::Vector3d(128, 128, 128);

  const std::vector<std::vector<std::uint32_t>> neighbors = mesh::vertexNeighbors(mesh);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd right(count, 3);
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    const int row = unknown_index[i];
    if (row < 0)
      continue;
    right.row(row) = PULL_TO_MEAN * mean.transpose();
    entries.emplace_back(row, row, static_cast<double>(neighbors[i].size()) + PULL_TO_MEAN);
    for (const std::uint32_t neighbor : neighbors[i])
    {
      if (known[neighbor])
        right.row(row) += (*colors)[neighbor].cast<double>().transpose();
      else
        entries.emplace_back(row, unknown_index[neighbor], -1.);
    }
  }
  Eigen::SparseMatrix<double> laplacian(count, count);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::MatrixXd filled = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(laplacian).solve(right);
  for (std::size_t i = 0; i < known.size(); ++i)
    if (unknown_index[i] >= 0)
      (*colors)[i] = filled.row(unknown_index[i]).transpose().cast<float>();
}

}  // namespace object_modelling::texture
