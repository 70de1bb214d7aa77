#include "icp_system.h"

#include <map>

#include <Eigen/SparseCholesky>

#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::multi_view_icp
{
namespace
{
using SparseMatrix = Eigen::SparseMatrix<double>;

/// Where the unknowns of each view's body are, -1 for those that do not move.
struct Rows
{
  Rows(const std::vector<int>& members, const std::vector<int>& bodies) : of(bodies.size(), -1)
  {
    std::map<int, int> row_of_body;
    for (const int k : members)
    {
      const auto [body, is_new] = row_of_body.emplace(bodies[k], unknowns);
      if (is_new && row_of_body.size() == 1)
        body->second = -1;
      else if (is_new)
        unknowns += 6;
      of[k] = body->second;
    }
  }
  std::vector<int> of;
  int unknowns = 0;
};

/// Lower triangle of the normal equations; every diagonal entry exists.
SparseMatrix matrixOf(const std::vector<PairEquations>& pairs, const std::vector<int>& rows, int unknowns,
                      const geometry::Matrix6d& prior)
{
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int row, int column, const geometry::Matrix6d& block)
  {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        if (row + i >= column + j)
          entries.emplace_back(row + i, column + j, block(i, j));
  };
  for (int row = 0; row < unknowns; row += 6)
    add(row, row, prior);
  for (const PairEquations& pair : pairs)
  {
    const int row_a = rows[pair.a], row_b = rows[pair.b];
    if (row_a == row_b)
      continue;  // their body moves both alike
    if (row_a >= 0)
      add(row_a, row_a, pair.A);
    if (row_b >= 0)
      add(row_b, row_b, pair.A);
    if (row_a >= 0 && row_b >= 0)
      add(std::max(row_a, row_b), std::min(row_a, row_b), -pair.A);
  }
  SparseMatrix matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}
}  // namespace

namespace
{
Eigen::VectorXd rightSideOf(const std::vector<PairEquations>& pairs, const std::vector<int>& rows, int unknowns)
{
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  for (const PairEquations& pair : pairs)
  {
    if (rows[pair.a] >= 0)
      right.segment<6>(rows[pair.a]) -= pair.g;
    if (rows[pair.b] >= 0)
      right.segment<6>(rows[pair.b]) += pair.g;
  }
  return right;
}

std::optional<std::vector<geometry::Vector6d>> motionsOf(const Eigen::VectorXd& solution, const std::vector<int>& rows)
{
  if (!solution.allFinite())
    return std::nullopt;
  std::vector<geometry::Vector6d> motions(rows.size(), geometry::Vector6d::Zero());
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (rows[k] >= 0)
      motions[k] = solution.segment<6>(rows[k]);
  return motions;
}
}  // namespace

std::optional<std::vector<geometry::Vector6d>> solveMotions(const std::vector<PairEquations>& pairs,
                                                            const std::vector<int>& members,
                                                            const std::vector<int>& bodies, double damping)
{
  const auto [rows, unknowns] = Rows(members, bodies);
  if (unknowns == 0)
    return std::nullopt;
  SparseMatrix matrix = matrixOf(pairs, rows, unknowns, geometry::Matrix6d::Zero());
  const double least = 1e-9 * (1 + Eigen::VectorXd(matrix.diagonal()).maxCoeff());
  for (int i = 0; i < unknowns; ++i)
    matrix.coeffRef(i, i) += damping * matrix.coeff(i, i) + least;
  const Eigen::SimplicialLDLT<SparseMatrix> factors(matrix);
  if (factors.info() != Eigen::Success)
    return std::nullopt;
  return motionsOf(factors.solve(rightSideOf(pairs, rows, unknowns)), rows);
}

std::optional<std::vector<geometry::Vector6d>> solveResisted(const std::vector<PairEquations>& pairs,
                                                             const std::vector<geometry::Matrix6d>& noise,
                                                             const std::vector<int>& members,
                                                             const std::vector<int>& bodies, double damping)
{
  const auto [rows, unknowns] = Rows(members, bodies);
  if (unknowns == 0)
    return std::nullopt;
  std::vector<PairEquations> of_noise = pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    of_noise[i].A = noise[i];
  const auto dense = [&, &rows = rows, unknowns = unknowns](const std::vector<PairEquations>& equations)
  {
    const Eigen::MatrixXd lower(matrixOf(equations, rows, unknowns, geometry::Matrix6d::Zero()));
    return Eigen::MatrixXd(lower.selfadjointView<Eigen::Lower>());
  };
  const auto information = geometry::informationOverNoise(dense(pairs), dense(of_noise));
  if (!information)
    return std::nullopt;
  Eigen::VectorXd along = information->V.transpose() * rightSideOf(pairs, rows, unknowns);
  for (int i = 0; i < unknowns; ++i)
    along[i] *= information->ratios[i] > NOISE_FACTOR ? 1 / ((1 + damping) * information->ratios[i]) : 0;
  return motionsOf(information->V * along, rows);
}

std::vector<geometry::Matrix6d> motionCovariances(const std::vector<PairEquations>& pairs,
                                                  const std::vector<int>& members, const std::vector<int>& bodies,
                                                  const geometry::Matrix6d& prior)
{
  std::vector<geometry::Matrix6d> covariances(bodies.size(), geometry::Matrix6d::Zero());
  const auto [rows, unknowns] = Rows(members, bodies);
  if (unknowns == 0)
    return covariances;
  const Eigen::SimplicialLDLT<SparseMatrix> factors(matrixOf(pairs, rows, unknowns, prior));
  if (factors.info() != Eigen::Success)
    return covariances;
  for (std::size_t k = 0; k < bodies.size(); ++k)
  {
    if (rows[k] < 0)
      continue;
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(unknowns, 6);
    unit.block<6, 6>(rows[k], 0).setIdentity();
    const geometry::Matrix6d block = factors.solve(unit).block<6, 6>(rows[k], 0);
    covariances[k] = 0.5 * (block + block.transpose());
  }
  return covariances;
}

}  // namespace object_modelling::multi_view_icp
