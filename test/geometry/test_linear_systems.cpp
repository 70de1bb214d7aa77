#include "object_modelling/geometry/linear_systems.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

namespace object_modelling::geometry
{
namespace
{
constexpr double UNKNOWN = std::numeric_limits<double>::quiet_NaN();

/// Symmetric and positive definite; the same at every call.
Matrix6d someInformation()
{
  Matrix6d root;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      root(i, j) = std::sin(1.0 + 7 * i + 3 * j) + (i == j ? 2 : 0);
  return root * root.transpose();
}

const Vector6d SOME_VECTOR = (Vector6d() << 1, -2, 3, 0.5, 0, -1).finished();

TEST(LinearSystems, SolvesWhatItIsGiven)
{
  const Matrix6d A = someInformation();
  const Vector6d b = A * SOME_VECTOR;
  EXPECT_TRUE(solveSymmetric(A, b).isApprox(SOME_VECTOR, 1e-9));
  EXPECT_TRUE(
      solveSymmetric(Matrix6f(A.cast<float>()), Vector6f(b.cast<float>())).cast<double>().isApprox(SOME_VECTOR, 1e-3));
  EXPECT_TRUE(solveSymmetric(Eigen::MatrixXd(A), Eigen::VectorXd(b)).isApprox(SOME_VECTOR, 1e-9));
  ASSERT_TRUE(solveWellPosed(A, b).has_value());
  EXPECT_TRUE(solveWellPosed(A, b)->isApprox(SOME_VECTOR, 1e-9));
  EXPECT_TRUE((inverseOf(A) * A).isApprox(Matrix6d::Identity(), 1e-9));
}

TEST(LinearSystems, RefusesWhatHasNoSolution)
{
  Matrix6d singular = Matrix6d::Identity();
  singular(5, 5) = 0;
  EXPECT_FALSE(solveWellPosed(singular, SOME_VECTOR).has_value());
  EXPECT_FALSE(solveWellPosed(Matrix6d::Zero(), SOME_VECTOR).has_value());
  singular(5, 5) = 1e-6;
  EXPECT_TRUE(solveWellPosed(singular, SOME_VECTOR).has_value());
  EXPECT_FALSE(solveWellPosed(singular, SOME_VECTOR, 1e-3).has_value());
}

TEST(LinearSystems, LeastSquaresLeavesAnOrthogonalResidual)
{
  Eigen::MatrixXd A(4, 2), B(4, 1);
  A << 1, 0, 1, 1, 1, 2, 1, 3;
  B << 1, 3, 4, 8;
  const Eigen::MatrixXd X = leastSquares(A, B);
  EXPECT_NEAR(X(0), 0.7, 1e-12);
  EXPECT_NEAR(X(1), 2.2, 1e-12);
  EXPECT_NEAR((A.transpose() * (B - A * X)).norm(), 0, 1e-12);
}

TEST(LinearSystems, EigenSystemsAscendAndCompose)
{
  const Matrix6d A = someInformation();
  const EigenSystem<6> system = eigenSystem(A);
  EXPECT_TRUE((system.vectors * system.values.asDiagonal() * system.vectors.transpose()).isApprox(A, 1e-9));
  for (int i = 1; i < 6; ++i)
    EXPECT_LE(system.values[i - 1], system.values[i]);
  const EigenSystem<3> diagonal = eigenSystem(Eigen::Matrix3d(Eigen::Vector3d(4, 1, 9).asDiagonal()));
  EXPECT_TRUE(diagonal.values.isApprox(Eigen::Vector3d(1, 4, 9), 1e-12));
  EXPECT_NEAR(std::abs(diagonal.vectors(1, 0)), 1, 1e-12);
}

TEST(LinearSystems, InformationOverNoiseNamesTheDirections)
{
  // Noise explains the first direction, a tenth of the second, nothing of the others.
  Vector6d information, noise;
  information << 5, 10, 100, 100, 100, 100;
  noise << 5, 1, 1, 1, 1, 1;
  const auto ratios = informationOverNoise(Matrix6d(information.asDiagonal()), Matrix6d(noise.asDiagonal()));
  ASSERT_TRUE(ratios.has_value());
  EXPECT_NEAR(ratios->ratios[0], 1, 1e-6);
  EXPECT_NEAR(ratios->ratios[1], 10, 1e-6);
  EXPECT_NEAR(ratios->ratios[5], 100, 1e-4);
  EXPECT_TRUE((ratios->V.transpose() * ratios->N * ratios->V).isApprox(Matrix6d::Identity(), 1e-9));
}

TEST(LinearSystems, InformationOverNoiseIsTheSameInBothSizes)
{
  const Matrix6d A = someInformation(), N = someInformation() + Matrix6d::Identity();
  const auto fixed = informationOverNoise(A, N);
  const auto dynamic = informationOverNoise(Eigen::MatrixXd(A), Eigen::MatrixXd(N));
  ASSERT_TRUE(fixed && dynamic);
  EXPECT_TRUE(fixed->ratios.isApprox(dynamic->ratios, 1e-9));
}

TEST(LinearSystems, InformationThatIsNotFiniteHasNoRatios)
{
  EXPECT_FALSE(informationOverNoise(Matrix6d(Matrix6d::Constant(UNKNOWN)), Matrix6d(Matrix6d::Identity())));
}

}  // namespace
}  // namespace object_modelling::geometry
