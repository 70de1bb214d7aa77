#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "object_modelling/registration/dense_alignment.h"
#include "object_modelling/registration/dense_quality.h"
#include "object_modelling/registration/image_pyramid.h"
#include "tracking_scene.h"

namespace object_modelling::tracking
{
namespace
{
const Eigen::Isometry3d IDENTITY = Eigen::Isometry3d::Identity();
constexpr double TOLERANCE_M = 0.002;
constexpr double TOLERANCE_RAD = 0.003;

/// A frame with what dense alignment makes of it.
struct View
{
  explicit View(const rgbd::Frame& frame) : pyramid(frame.gray), dense(frame, pyramid.levels()), reference(dense) {}
  registration::ImagePyramid pyramid;
  registration::DensePyramid dense;
  registration::DenseReference reference;
};

/// Two looks at the same things, 5 degrees and 7 cm apart.
Eigen::Isometry3d poseA()
{
  return test_support::orbitPose(TARGET, 0.6, 0.4, 0.6);
}
Eigen::Isometry3d poseB()
{
  geometry::Vector6d x;
  x << 0.01, -0.015, 0.01, 0.02, -0.01, 0.04;
  return test_support::orbitPose(TARGET, 0.6, 0.5, 0.63) * geometry::isometryFromVector(x);
}
const Eigen::Isometry3d T_A_B = poseA().inverse() * poseB();

rgbd::Frame renderUnmasked(const test_support::SyntheticScene& scene, const Eigen::Isometry3d& T_world_camera, int seed)
{
  rgbd::Frame frame = test_support::renderFrame(scene, TrackingScene::camera(), T_world_camera, sensorNoise(seed));
  frame.object_mask.release();
  return frame;
}

registration::DenseAlignment align(const View& reference, const View& frame,
                                   const Eigen::Isometry3d& T_start = IDENTITY)
{
  return registration::alignDense(reference.reference, IDENTITY, frame.dense, T_start, geometry::Matrix6d::Zero());
}

/// Something plain held close before the left of the image.
void occlude(double ratio, rgbd::Frame* frame)
{
  const cv::Rect hidden(0, 0, static_cast<int>(ratio * frame->gray.cols), frame->gray.rows);
  frame->gray(hidden).setTo(200);
  frame->depth_m(hidden).setTo(0.3F);
}
}  // namespace

TEST(DenseAlignment, RecoversSeveralDegreesAndCentimetersBothWays)
{
  ASSERT_GT(geometry::rotationAngle_rad(T_A_B), 0.09);
  ASSERT_GT(T_A_B.translation().norm(), 0.05);
  for (const test_support::SyntheticScene& scene : { test_support::boxOnTable(), plainScene() })
  {
    const View a(renderUnmasked(scene, poseA(), 0));
    const View b(renderUnmasked(scene, poseB(), 1));
    const registration::DenseAlignment forwards = align(a, b);
    const registration::DenseAlignment backwards = align(b, a);
    EXPECT_TRANSFORM_NEAR(forwards.T_world_camera, T_A_B, TOLERANCE_M, TOLERANCE_RAD);
    EXPECT_TRANSFORM_NEAR(backwards.T_world_camera, T_A_B.inverse(), TOLERANCE_M, TOLERANCE_RAD);
    EXPECT_TRANSFORM_NEAR(forwards.T_world_camera * backwards.T_world_camera, IDENTITY, TOLERANCE_M, TOLERANCE_RAD);
    for (const registration::DenseAlignment& aligned : { forwards, backwards })
    {
      EXPECT_TRUE(registration::convincing(aligned.term)) << registration::describe(aligned.term);
      EXPECT_GT(aligned.term.depth_agreement, 0.9);
    }
  }
}

TEST(DenseAlignment, WherePointsLieInTheSessionDoesNotMatter)
{
  const View a(renderUnmasked(test_support::boxOnTable(), poseA(), 0));
  const View b(renderUnmasked(test_support::boxOnTable(), poseB(), 1));
  const registration::DenseAlignment aligned =
      registration::alignDense(a.reference, poseA(), b.dense, poseA(), geometry::Matrix6d::Zero());
  EXPECT_TRANSFORM_NEAR(aligned.T_world_camera, poseB(), TOLERANCE_M, TOLERANCE_RAD);
}

TEST(DenseAlignment, ATightPriorHoldsTheStart)
{
  const View a(renderUnmasked(test_support::boxOnTable(), poseA(), 0));
  const View b(renderUnmasked(test_support::boxOnTable(), poseB(), 1));
  const geometry::Matrix6d prior = 1e14 * geometry::Matrix6d::Identity();
  EXPECT_TRANSFORM_NEAR(registration::alignDense(a.reference, IDENTITY, b.dense, IDENTITY, prior).T_world_camera,
                        IDENTITY, 1e-4, 1e-4);
}

TEST(DenseAlignment, ExposureDoesNotCount)
{
  const rgbd::Frame frame_a = renderUnmasked(test_support::boxOnTable(), poseA(), 0);
  rgbd::Frame frame_b = renderUnmasked(test_support::boxOnTable(), poseB(), 1);
  frame_b.gray.convertTo(frame_b.gray, CV_8U, 0.8, 15);
  const View a(frame_a), b(frame_b);
  const registration::DenseAlignment forwards = align(a, b);
  EXPECT_TRANSFORM_NEAR(forwards.T_world_camera, T_A_B, TOLERANCE_M, TOLERANCE_RAD);
  EXPECT_TRANSFORM_NEAR(align(b, a).T_world_camera, T_A_B.inverse(), TOLERANCE_M, TOLERANCE_RAD);
  EXPECT_TRUE(registration::convincing(forwards.term)) << registration::describe(forwards.term);
}

TEST(DenseAlignment, AThirdOfTheViewHiddenDoesNotCount)
{
  const rgbd::Frame frame_a = renderUnmasked(test_support::boxOnTable(), poseA(), 0);
  rgbd::Frame frame_b = renderUnmasked(test_support::boxOnTable(), poseB(), 1);
  occlude(0.3, &frame_b);
  const View a(frame_a), b(frame_b);
  const registration::DenseAlignment forwards = align(a, b);
  EXPECT_TRANSFORM_NEAR(forwards.T_world_camera, T_A_B, TOLERANCE_M, TOLERANCE_RAD);
  EXPECT_TRUE(registration::convincing(forwards.term)) << registration::describe(forwards.term);
  EXPECT_LT(forwards.term.overlap, 0.85);
  // The other way round what was close is gone.
  EXPECT_TRANSFORM_NEAR(align(b, a).T_world_camera, T_A_B.inverse(), TOLERANCE_M, TOLERANCE_RAD);
}

TEST(DenseAlignment, WithMasksTheObjectAloneCounts)
{
  test_support::SyntheticScene before;
  before.objects.push_back(test_support::standingBox({ 0.16, 0.2, 0.2 }));
  test_support::SyntheticScene after = before;
  Eigen::Isometry3d T_moved = IDENTITY;
  T_moved.translation() = Eigen::Vector3d(0.015, -0.02, 0);
  T_moved.linear() = Eigen::AngleAxisd(0.07, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  after.objects[0].T_world_object = T_moved * before.objects[0].T_world_object;
  rgbd::Frame frame_a = test_support::renderFrame(before, TrackingScene::camera(), poseA(), sensorNoise(0));
  rgbd::Frame frame_b = test_support::renderFrame(after, TrackingScene::camera(), poseA(), sensorNoise(1));
  const Eigen::Isometry3d T_a_b = poseA().inverse() * T_moved.inverse() * poseA();
  {
    const View a(frame_a), b(frame_b);
    EXPECT_TRANSFORM_NEAR(align(a, b).T_world_camera, T_a_b, 0.003, 0.005);
    EXPECT_TRANSFORM_NEAR(align(b, a).T_world_camera, T_a_b.inverse(), 0.003, 0.005);
  }
  frame_a.object_mask.release();
  frame_b.object_mask.release();
  const View a(frame_a), b(frame_b);
  const double angle_rad = geometry::rotationAngle_rad(align(a, b).T_world_camera.inverse() * T_a_b);
  EXPECT_GT(angle_rad, 0.01) << "without masks the table has its say";
}

TEST(DenseAlignment, TheTrueMotionFitsBest)
{
  const View a(renderUnmasked(test_support::boxOnTable(), poseA(), 0));
  const View b(renderUnmasked(test_support::boxOnTable(), poseB(), 1));
  const auto termAt = [&](const Eigen::Isometry3d& T_a_b)
  { return registration::evaluateDense(a.reference.levels()[0], b.dense.levels()[0], T_a_b.inverse(), IDENTITY, {}); };
  const registration::DenseTerm truth = termAt(T_A_B);
  EXPECT_TRUE(registration::certain(truth)) << registration::describe(truth);
  for (int axis = 0; axis < 6; ++axis)
    for (const double sign : { -1.0, 1.0 })
    {
      const geometry::Vector6d off = sign * 0.04 * geometry::Vector6d::Unit(axis);
      const registration::DenseTerm wrong = termAt(T_A_B * geometry::isometryFromVector(off));
      EXPECT_LT(registration::quality(wrong), registration::quality(truth)) << axis;
      EXPECT_FALSE(registration::certain(wrong)) << axis << ": " << registration::describe(wrong);
    }
  // Information is symmetric and nowhere negative.
  EXPECT_TRUE(truth.equations.A.isApprox(truth.equations.A.transpose(), 1e-6));
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<geometry::Matrix6d>(truth.equations.A).eigenvalues()(0), 0);
}

TEST(DenseAlignment, APlainPlaneLeavesThreeDirectionsFree)
{
  test_support::SyntheticScene wall;
  wall.table = test_support::plainTexture();
  wall.table_half_size_m = 5;
  const View a(renderUnmasked(wall, poseA(), 0));
  const registration::DenseTerm plane =
      registration::evaluateDense(a.reference.levels()[0], a.dense.levels()[0], IDENTITY, IDENTITY, {});
  const geometry::Vector6d weak = Eigen::SelfAdjointEigenSolver<geometry::Matrix6d>(plane.equations.A).eigenvalues();
  EXPECT_LT(weak(2), 0.01 * weak(3)) << weak.transpose();
  EXPECT_FALSE(registration::plausible(plane)) << registration::describe(plane);
  // Things on it fix the rest, with texture and without.
  for (const test_support::SyntheticScene& scene : { test_support::boxOnTable(), plainScene() })
  {
    const View b(renderUnmasked(scene, poseA(), 0));
    const registration::DenseTerm shape =
        registration::evaluateDense(b.reference.levels()[0], b.dense.levels()[0], IDENTITY, IDENTITY, {});
    const geometry::Vector6d strong =
        Eigen::SelfAdjointEigenSolver<geometry::Matrix6d>(shape.equations.A).eigenvalues();
    EXPECT_GT(strong(0), 10 * weak(2)) << strong.transpose() << " against " << weak.transpose();
  }
}

TEST(DenseAlignment, NoiseIsNoKnowledge)
{
  // Along a bar without end there is nothing but noise, staircases of edges and unsure normals to tell the place.
  for (const double turn_m : { 0.0, 0.3 })
  {
    const Eigen::Isometry3d T = test_support::lookAt({ 0.5, 1.2, 0.6 }, { -0.1, 1.2 + turn_m, 0.05 });
    const View a(renderUnmasked(endlessBarScene(), T, 1));
    const View b(renderUnmasked(endlessBarScene(), T, 2));
    // Next to nothing is known beforehand: 1 m, 1 rad.
    const geometry::Matrix6d covariance =
        (registration::evaluateDense(a.reference.levels()[0], b.dense.levels()[0], IDENTITY, IDENTITY, {}).equations.A +
         geometry::Matrix6d::Identity())
            .inverse();
    const auto sigma_m = [&](const Eigen::Vector3d& direction_world)
    {
      geometry::Vector6d direction = geometry::Vector6d::Zero();
      direction.head<3>() = T.linear().transpose() * direction_world;
      return std::sqrt(direction.dot(covariance * direction));
    };
    const double along_m = sigma_m(Eigen::Vector3d::UnitY());
    EXPECT_GT(along_m, 0.5) << "looking " << turn_m << " m along it";
    EXPECT_LT(sigma_m(Eigen::Vector3d::UnitX()), 0.1 * along_m);
    EXPECT_LT(sigma_m(Eigen::Vector3d::UnitZ()), 0.1 * along_m);
  }
}

TEST(DenseAlignment, NothingToGoByIsNeverPlausible)
{
  const rgbd::Frame good = renderUnmasked(test_support::boxOnTable(), poseA(), 0);
  std::vector<rgbd::Frame> hopeless;
  rgbd::Frame frame = good;  // no depth at all
  frame.depth_m = cv::Mat(good.depth_m.size(), CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  hopeless.push_back(frame);
  frame.gray = cv::Mat(good.gray.size(), CV_8UC1, cv::Scalar(128));
  hopeless.push_back(frame);
  frame = good;  // depth without texture or shade
  frame.gray = cv::Mat(good.gray.size(), CV_8UC1, cv::Scalar(128));
  hopeless.push_back(frame);
  frame = good;  // nothing belongs to the object
  frame.object_mask = cv::Mat::zeros(good.gray.size(), CV_8UC1);
  hopeless.push_back(frame);
  for (const cv::Size& size : { cv::Size(16, 12), cv::Size(8, 6), cv::Size(4, 3) })
  {
    frame = good;
    frame.gray = good.gray(cv::Rect(cv::Point(150, 110), size)).clone();
    frame.depth_m = good.depth_m(cv::Rect(cv::Point(150, 110), size)).clone();
    frame.camera.width = size.width;
    frame.camera.height = size.height;
    hopeless.push_back(frame);
  }
  const View view(good);
  for (std::size_t i = 0; i < hopeless.size(); ++i)
  {
    const View poor(hopeless[i]);
    for (const registration::DenseAlignment& aligned : { align(view, poor), align(poor, view), align(poor, poor) })
    {
      EXPECT_FALSE(registration::plausible(aligned.term)) << i << ": " << registration::describe(aligned.term);
      EXPECT_FALSE(registration::certain(aligned.term)) << i;
      EXPECT_TRUE(aligned.T_world_camera.matrix().allFinite()) << i;
      EXPECT_TRUE(aligned.term.equations.A.allFinite()) << i;
      EXPECT_GE(registration::quality(aligned.term), 0) << i;
    }
  }
}

TEST(DenseAlignment, LooksThatShareNothingAreNotCertain)
{
  const View a(renderUnmasked(test_support::boxOnTable(), poseA(), 0));
  test_support::SyntheticScene other = test_support::boxOnTable();
  other.table.seed += 50;
  other.objects[0].texture.seed += 50;
  const View b(renderUnmasked(other, poseB(), 1));
  EXPECT_FALSE(registration::certain(align(a, b).term)) << registration::describe(align(a, b).term);
  // Behind the camera, and off to the side.
  Eigen::Isometry3d T_turned = IDENTITY;
  T_turned.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const registration::DenseAlignment away = align(a, a, T_turned);
  EXPECT_EQ(away.term.in_view, 0);
  EXPECT_FALSE(away.converged);
  EXPECT_FALSE(registration::plausible(away.term));
}

TEST(DensePyramid, ThinsDepthWithoutMovingSurfacesOrJoiningThem)
{
  rgbd::Frame frame;
  frame.camera = TrackingScene::camera();
  frame.gray = cv::Mat(240, 320, CV_8UC1, cv::Scalar(100));
  frame.depth_m = cv::Mat(240, 320, CV_32FC1);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u)
      frame.depth_m.at<float>(v, u) = u < 161 ? 0.6F + 0.0005F * static_cast<float>(u) : 1.2F;
  const registration::ImagePyramid pyramid(frame.gray);
  const registration::DensePyramid dense(frame, pyramid.levels());
  ASSERT_EQ(dense.levels().size(), 3u);
  for (const registration::DenseLevel& level : dense.levels())
  {
    EXPECT_EQ(level.gray.size(), level.depth_m.size());
    EXPECT_NEAR(level.fx * static_cast<float>(level.step), frame.camera.fx, 1e-3);
    for (int u = 1; u + 1 < level.depth_m.cols; ++u)
    {
      const float z_m = level.depth_m.at<float>(level.depth_m.rows / 2, u);
      if (std::isnan(z_m))
        continue;
      const int full = u * level.step;
      EXPECT_NEAR(z_m, full < 161 ? 0.6F + 0.0005F * static_cast<float>(full) : 1.2F, 1e-4) << full;
    }
  }
}
}  // namespace object_modelling::tracking
