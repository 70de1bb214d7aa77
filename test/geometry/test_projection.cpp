#include "object_modelling/geometry/projection.h"

#include <limits>

#include <gtest/gtest.h>

namespace object_modelling::geometry
{
namespace
{
PinholeCamera smallCamera()
{
  PinholeCamera camera;
  camera.width = 64;
  camera.height = 48;
  camera.fx = 50;
  camera.fy = 40;
  camera.cx = 31.5;
  camera.cy = 24;
  return camera;
}

/// Where the point at depth z (m) on the ray of a pixel falls.
template <typename Scalar>
Projection<Scalar> seenAt(double u_px, double v_px, double z_m, double border_px)
{
  const Eigen::Matrix<Scalar, 3, 1> p = smallCamera().unproject(u_px, v_px, z_m).template cast<Scalar>();
  return projectionOf(smallCamera(), p, border_px);
}

template <typename Scalar>
class Projected : public testing::Test
{
public:
  static bool inside(double u_px, double v_px, double border_px = -0.5)
  {
    return seenAt<Scalar>(u_px, v_px, 2, border_px).inside;
  }
  static bool inside(const Eigen::Matrix<Scalar, 3, 1>& p) { return projectionOf(smallCamera(), p).inside; }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Projected, Scalars);

TYPED_TEST(Projected, FallsAtThePixelOfTheCamera)
{
  const Projection<TypeParam> at = projectionOf(smallCamera(), Eigen::Matrix<TypeParam, 3, 1>(0.25, -0.5, 2));
  EXPECT_TRUE(at.inside);
  EXPECT_EQ(at.u_px, TypeParam(37.75));
  EXPECT_EQ(at.v_px, TypeParam(14));
  EXPECT_EQ(at.z_m, TypeParam(2));
  EXPECT_EQ(at.column, 38);
  EXPECT_EQ(at.row, 14);
  EXPECT_EQ(at.pixel().template cast<double>(), smallCamera().project({ 0.25, -0.5, 2 }));
}

TYPED_TEST(Projected, ComesBackToThePixelThatItWasSeenAt)
{
  for (int v = 0; v < smallCamera().height; ++v)
  {
    for (int u = 0; u < smallCamera().width; ++u)
    {
      const Projection<TypeParam> at = seenAt<TypeParam>(u, v, 0.7, -0.5);
      ASSERT_TRUE(at.inside) << u << " " << v;
      ASSERT_EQ(at.column, u);
      ASSERT_EQ(at.row, v);
      const Eigen::Vector3d back = smallCamera().unproject(at.u_px, at.v_px, at.z_m);
      ASSERT_TRUE(back.isApprox(smallCamera().unproject(u, v, 0.7), 1e-5)) << u << " " << v;
    }
  }
}

TYPED_TEST(Projected, IsNeverInsideFromBehind)
{
  using Point = Eigen::Matrix<TypeParam, 3, 1>;
  EXPECT_TRUE(this->inside(Point(0, 0, 1)));
  EXPECT_FALSE(this->inside(Point(0, 0, -1)));
  EXPECT_FALSE(this->inside(Point(0, 0, 0)));
  EXPECT_FALSE(this->inside(Point(1, 1, 0)));
  EXPECT_FALSE(this->inside(Point(1, 1, std::numeric_limits<TypeParam>::denorm_min())));
}

TYPED_TEST(Projected, IsNotInsideWithoutNumbers)
{
  using Point = Eigen::Matrix<TypeParam, 3, 1>;
  const TypeParam nan = std::numeric_limits<TypeParam>::quiet_NaN();
  const TypeParam infinity = std::numeric_limits<TypeParam>::infinity();
  EXPECT_FALSE(this->inside(Point(nan, 0, 1)));
  EXPECT_FALSE(this->inside(Point(0, nan, 1)));
  EXPECT_FALSE(this->inside(Point(0, 0, nan)));
  EXPECT_FALSE(this->inside(Point(infinity, 0, 1)));
  EXPECT_FALSE(this->inside(Point(0, -infinity, 1)));
  EXPECT_FALSE(this->inside(Point(infinity, 0, infinity)));
}

TYPED_TEST(Projected, HasTheImageEndHalfAPixelBeyondTheOutermostCenters)
{
  EXPECT_TRUE(this->inside(-0.49, 24));
  EXPECT_TRUE(this->inside(63.49, 24));
  EXPECT_TRUE(this->inside(31, -0.49));
  EXPECT_TRUE(this->inside(31, 47.49));
  EXPECT_FALSE(this->inside(-0.51, 24));
  EXPECT_FALSE(this->inside(63.51, 24));
  EXPECT_FALSE(this->inside(31, -0.51));
  EXPECT_FALSE(this->inside(31, 47.51));
}

TYPED_TEST(Projected, OnTheRimIsInsideIfItsPixelIs)
{
  PinholeCamera exact = smallCamera();
  exact.fx = exact.fy = 32;  // no rounding
  const Projection<TypeParam> first = projectionOf(exact, Eigen::Matrix<TypeParam, 3, 1>(-1, -0.765625, 1));
  EXPECT_EQ(first.u_px, TypeParam(-0.5));
  EXPECT_EQ(first.v_px, TypeParam(-0.5));
  EXPECT_TRUE(first.inside);
  EXPECT_EQ(first.column, 0);
  EXPECT_EQ(first.row, 0);
  const Projection<TypeParam> last = projectionOf(exact, Eigen::Matrix<TypeParam, 3, 1>(1, 0.734375, 1));
  EXPECT_EQ(last.u_px, TypeParam(63.5));
  EXPECT_EQ(last.v_px, TypeParam(47.5));
  EXPECT_FALSE(last.inside);  // pixel (64, 48)
  exact.width = 65;
  exact.height = 49;
  EXPECT_TRUE(projectionOf(exact, Eigen::Matrix<TypeParam, 3, 1>(1, 0.734375, 1)).inside);
}

TYPED_TEST(Projected, KeepsTheBorderThatTheCallerAsksFor)
{
  EXPECT_TRUE(this->inside(1.01, 24, 1));
  EXPECT_FALSE(this->inside(0.99, 24, 1));
  EXPECT_TRUE(this->inside(61.99, 24, 1));
  EXPECT_FALSE(this->inside(62.01, 24, 1));
  EXPECT_TRUE(this->inside(31, 46.99, 0));
  EXPECT_FALSE(this->inside(31, 47.01, 0));
}

TYPED_TEST(Projected, TellsThePlaceBeyondTheRim)
{
  const Projection<TypeParam> at = seenAt<TypeParam>(70, 24, 2, -0.5);
  EXPECT_FALSE(at.inside);
  EXPECT_NEAR(at.u_px, 70, 1e-4);
  EXPECT_EQ(at.z_m, TypeParam(2));
}
}  // namespace
}  // namespace object_modelling::geometry
