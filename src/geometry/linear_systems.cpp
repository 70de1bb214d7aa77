#include "object_modelling/geometry/linear_systems.h"

#include <Eigen/Dense>

namespace object_modelling::geometry
{
namespace
{
template <int Size, typename Matrix>
std::optional<InformationRatios<Size>> ratiosOf(const Matrix& A, const Matrix& noise)
{
  Matrix N = noise;
  N.diagonal().array() += 1e-9 * noise.diagonal().maxCoeff() + 1e-12;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(A, N);
  if (solver.info() != Eigen::Success)
    return std::nullopt;
  return InformationRatios<Size>{ solver.eigenvalues(), solver.eigenvectors(), N };
}
}  // namespace

Vector6d solveSymmetric(const Matrix6d& A, const Vector6d& b)
{
  return A.ldlt().solve(b);
}

Vector6f solveSymmetric(const Matrix6f& A, const Vector6f& b)
{
  return A.ldlt().solve(b);
}

Eigen::VectorXd solveSymmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b)
{
  return A.ldlt().solve(b);
}

std::optional<Vector6d> solveWellPosed(const Matrix6d& A, const Vector6d& b, double min_rcond)
{
  const Eigen::LDLT<Matrix6d> solver(A);
  // A pivot that is exactly zero is left out by Eigen, in the condition too.
  const Vector6d pivots = solver.vectorD().cwiseAbs();
  if (solver.info() != Eigen::Success || !(pivots.minCoeff() > min_rcond * pivots.maxCoeff()) ||
      solver.rcond() < min_rcond)
    return std::nullopt;
  return solver.solve(b);
}

Matrix6d inverseOf(const Matrix6d& A)
{
  return A.inverse();
}

Eigen::MatrixXd leastSquares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B)
{
  return A.colPivHouseholderQr().solve(B);
}

EigenSystem<3> eigenSystem(const Eigen::Matrix3d& A)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(A);
  return { solver.eigenvalues(), solver.eigenvectors() };
}

EigenSystem<6> eigenSystem(const Matrix6d& A)
{
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(A);
  return { solver.eigenvalues(), solver.eigenvectors() };
}

std::optional<InformationRatios<6>> informationOverNoise(const Matrix6d& A, const Matrix6d& noise)
{
  return ratiosOf<6>(A, noise);
}

std::optional<InformationRatios<Eigen::Dynamic>> informationOverNoise(const Eigen::MatrixXd& A,
                                                                      const Eigen::MatrixXd& noise)
{
  return ratiosOf<Eigen::Dynamic>(A, noise);
}

}  // namespace object_modelling::geometry
