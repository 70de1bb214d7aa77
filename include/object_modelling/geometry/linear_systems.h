#pragma once

#include <optional>

#include <Eigen/Core>

#include "object_modelling/geometry/transform.h"

// Solvers of the small symmetric systems of poses, and of dense ones. Eigen's decompositions are templates that cost
// the compiler seconds in each file that uses them; here each is compiled once, and test/architecture asks for these.
namespace object_modelling::geometry
{
using Vector6f = Eigen::Matrix<float, 6, 1>;
using Matrix6f = Eigen::Matrix<float, 6, 6>;

/// x with A x = b by LDL^T of a symmetric, positive semi-definite A. A singular A gives values that are not finite or
/// of no meaning: damp it, or use solveWellPosed.
Vector6d solveSymmetric(const Matrix6d& A, const Vector6d& b);
Vector6f solveSymmetric(const Matrix6f& A, const Vector6f& b);
Eigen::VectorXd solveSymmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
template <int Size>
Eigen::Matrix<double, Size, 1> solveSymmetric(const Eigen::Matrix<double, Size, Size>& A,
                                              const Eigen::Matrix<double, Size, 1>& b)
{
  return solveSymmetric(Eigen::MatrixXd(A), Eigen::VectorXd(b));
}

/// The same; nothing if the reciprocal condition of A is below `min_rcond`.
std::optional<Vector6d> solveWellPosed(const Matrix6d& A, const Vector6d& b, double min_rcond = 1e-12);

/// Inverse of a matrix that has one, by LU with partial pivoting.
Matrix6d inverseOf(const Matrix6d& A);

/// X that minimises |A X - B| by QR with column pivoting; A has full column rank.
Eigen::MatrixXd leastSquares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// A = V diag(values) V^T of a symmetric A; values ascend, the columns of V are orthonormal.
template <int Size>
struct EigenSystem
{
  Eigen::Matrix<double, Size, 1> values;
  Eigen::Matrix<double, Size, Size> vectors;
};
EigenSystem<3> eigenSystem(const Eigen::Matrix3d& A);
EigenSystem<6> eigenSystem(const Matrix6d& A);

/// Information A compared with the share N of it that noise makes: A V = N V diag(ratios), V^T N V = 1, ratios ascend.
/// A direction (column of V) is constrained if its ratio is well above 1. N is `noise` with a small diagonal added.
template <int Size>
struct InformationRatios
{
  Eigen::Matrix<double, Size, 1> ratios;
  Eigen::Matrix<double, Size, Size> V, N;
};
/// Nothing if the decomposition fails (values that are not finite).
std::optional<InformationRatios<6>> informationOverNoise(const Matrix6d& A, const Matrix6d& noise);
std::optional<InformationRatios<Eigen::Dynamic>> informationOverNoise(const Eigen::MatrixXd& A,
                                                                      const Eigen::MatrixXd& noise);

}  // namespace object_modelling::geometry
