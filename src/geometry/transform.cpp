#include "object_modelling/geometry/transform.h"

#include <cmath>

#include <Eigen/SVD>

namespace object_modelling::geometry
{
namespace
{
bool collinear(const Eigen::Matrix3Xd& points)
{
  const Eigen::Matrix3Xd centered = points.colwise() - points.rowwise().mean();
  const Eigen::Matrix3d moments = centered * centered.transpose();
  const Eigen::Vector3d spread = moments.jacobiSvd().singularValues();
  return !(spread[1] > 1e-12 * spread[0]);
}

}  // namespace

Eigen::Isometry3d isometryFromVector(const Vector6d& translation_m_rotation_rad)
{
  const Eigen::Vector3d rotation = translation_m_rotation_rad.tail<3>();
  const double angle = rotation.norm();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = translation_m_rotation_rad.head<3>();
  // sin(a/2)/a tends to 1/2: no axis to divide by near zero.
  const double scale = angle > 1e-9 ? std::sin(0.5 * angle) / angle : 0.5;
  Eigen::Quaterniond q(std::cos(0.5 * angle), scale * rotation.x(), scale * rotation.y(), scale * rotation.z());
  T.linear() = q.normalized().toRotationMatrix();
  return T;
}

Vector6d vectorFromIsometry(const Eigen::Isometry3d& T)
{
  const Eigen::AngleAxisd rotation(Eigen::Quaterniond(T.linear()).normalized());
  Vector6d vector;
  vector << T.translation(), rotation.angle() * rotation.axis();
  return vector;
}

Eigen::Isometry3d isometryFrom(const Eigen::Quaterniond& R, const Eigen::Vector3d& t)
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R.normalized().toRotationMatrix();
  T.translation() = t;
  return T;
}

Matrix6d adjoint(const Eigen::Isometry3d& T_a_b)
{
  const Eigen::Matrix3d R = T_a_b.linear();
  const Eigen::Vector3d t = T_a_b.translation();
  Eigen::Matrix3d cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  Matrix6d result = Matrix6d::Zero();
  result.topLeftCorner<3, 3>() = R;
  result.topRightCorner<3, 3>() = cross * R;
  result.bottomRightCorner<3, 3>() = R;
  return result;
}

double rotationAngle_rad(const Eigen::Isometry3d& T)
{
  const Eigen::Quaterniond q(T.linear());
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

namespace
{
template <typename Scalar>
Eigen::Matrix<Scalar, 3, 3> rotationBetweenOf(const Eigen::Matrix<Scalar, 3, 1>& from,
                                              const Eigen::Matrix<Scalar, 3, 1>& to)
{
  const Eigen::Matrix<Scalar, 3, 1> a = from.normalized(), b = to.normalized();
  const Scalar cosine = b.dot(a);
  if (cosine < -1 + Eigen::NumTraits<Scalar>::dummy_precision())
    return Eigen::AngleAxis<Scalar>(Scalar(M_PI), a.unitOrthogonal()).toRotationMatrix();
  const Eigen::Matrix<Scalar, 3, 1> axis = a.cross(b);
  const Scalar s = std::sqrt((1 + cosine) * 2);
  Eigen::Quaternion<Scalar> q;
  q.vec() = axis * (1 / s);
  q.w() = s * Scalar(0.5);
  return q.toRotationMatrix();
}
}  // namespace

Eigen::Matrix3d rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
  return rotationBetweenOf<double>(from, to);
}

Eigen::Matrix3f rotationBetween(const Eigen::Vector3f& from, const Eigen::Vector3f& to)
{
  return rotationBetweenOf<float>(from, to);
}

Eigen::Isometry3d normalized(const Eigen::Isometry3d& T)
{
  return isometryFrom(Eigen::Quaterniond(T.linear()), T.translation());
}

bool rigidTransformFromPoints(const Eigen::Matrix3Xd& p_a, const Eigen::Matrix3Xd& p_b, Eigen::Isometry3d* T_a_b)
{
  if (p_a.cols() != p_b.cols() || p_a.cols() < 3 || !p_a.allFinite() || !p_b.allFinite() || collinear(p_a) ||
      collinear(p_b))
    return false;
  T_a_b->matrix() = Eigen::umeyama(p_b, p_a, false);
  return true;
}

}  // namespace object_modelling::geometry
