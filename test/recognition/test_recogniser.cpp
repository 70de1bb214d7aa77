#include "object_modelling/recognition/recogniser.h"

#include <gtest/gtest.h>

#include <cmath>

#include "object_modelling/fusion/cloud_fusion.h"
#include "support/synthetic_scene.h"
#include "support/temp_dir.h"
#include "support/thrown_status.h"

namespace object_modelling::recognition
{
namespace
{
using test_support::SceneObject;
using test_support::SyntheticScene;

const Eigen::Vector3d SIZE_M(0.08, 0.12, 0.2);
constexpr std::uint32_t TEXTURE_SEED = 2;

Eigen::Isometry3d lookingAtTable(double angle_rad, double height_m)
{
  const Eigen::Vector3d eye(0.65 * std::cos(angle_rad), 0.65 * std::sin(angle_rad), height_m);
  const Eigen::Vector3d z = (Eigen::Vector3d(0, 0, 0.08) - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = eye;
  return T;
}

mesh::TriangleMesh boxMesh()
{
  mesh::TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d sign((corner & 1) - 0.5, ((corner >> 1) & 1) - 0.5, ((corner >> 2) & 1) - 0.5);
    mesh.vertices.push_back(sign.cwiseProduct(SIZE_M).cast<float>());
    mesh.colors.emplace_back(std::uint8_t{ 120 }, std::uint8_t{ 120 }, std::uint8_t{ 120 });
  }
  mesh.triangles = { { 0, 2, 1 }, { 1, 2, 3 }, { 4, 5, 6 }, { 5, 7, 6 }, { 0, 1, 4 }, { 1, 5, 4 },
                     { 2, 6, 3 }, { 3, 6, 7 }, { 0, 4, 2 }, { 2, 4, 6 }, { 1, 3, 5 }, { 3, 7, 5 } };
  mesh::computeNormals(&mesh);
  return mesh;
}

/// A textured box, seen from all around but not from below.
database::ObjectModel boxModel()
{
  SyntheticScene scene;
  scene.objects = { test_support::standingBox(SIZE_M, 0, 0, 0, TEXTURE_SEED) };
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 10; ++i)
    poses.push_back(lookingAtTable(2 * M_PI * i / 10, i % 2 == 0 ? 0.35 : 0.55));
  database::ObjectModel model;
  model.id = "box";
  model.views = test_support::renderViews(scene, test_support::vgaCamera(), poses);
  const Eigen::Isometry3d T_model_world = scene.objects[0].T_world_object.inverse();
  for (rgbd::View& view : model.views)
    rgbd::transform(T_model_world, &view);
  base::JobControl control;
  model.cloud = fusion::fuse(model.views, {}, control).cloud;
  model.mesh = boxMesh();
  model.box_model.size_m = SIZE_M;
  model.diameter_m = SIZE_M.norm();
  return model;
}

class RecogniserTest : public ::testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    dir_ = std::make_unique<test_support::TempDir>();
    database::ObjectDatabase database(dir_->path("objects"), true);
    base::JobControl control;
    database.write(boxModel(), control);
    known_ = learnObject(database, database.entry("box"), {}, control);
  }
  static void TearDownTestSuite()
  {
    known_.reset();
    dir_.reset();
  }

  static rgbd::Frame frameOf(const SyntheticScene& scene, const Eigen::Isometry3d& T_world_camera)
  {
    test_support::SensorNoise noise;
    noise.depth_sigma_scale = 1;
    noise.depth_quantum_m = 0.001;
    noise.color_sigma = 2;
    rgbd::Frame frame = test_support::renderFrame(scene, test_support::vgaCamera(), T_world_camera, noise);
    frame.object_mask = cv::Mat();  // a recogniser is given none
    return frame;
  }

  static std::unique_ptr<test_support::TempDir> dir_;
  static std::shared_ptr<const ObjectKnowledge> known_;
};
std::unique_ptr<test_support::TempDir> RecogniserTest::dir_;
std::shared_ptr<const ObjectKnowledge> RecogniserTest::known_;

TEST_F(RecogniserTest, LearnsSurfaceTextureAndPairs)
{
  EXPECT_EQ(known_->id, "box");
  EXPECT_FALSE(known_->content_hash.empty());
  EXPECT_GT(known_->surface.oriented.size(), 500U);
  EXPECT_EQ(known_->surface.oriented.size(), known_->surface.lab.size());
  EXPECT_GT(known_->descriptors.rows, 50);
  EXPECT_EQ(static_cast<std::size_t>(known_->descriptors.rows), known_->feature_points.size());
}

TEST_F(RecogniserTest, FindsTheBoxWhereItStands)
{
  const Recogniser recogniser({ known_ });
  for (const double yaw_rad : { 0.4, 2.6, 4.4 })
  {
    SyntheticScene scene;
    const SceneObject unknown = test_support::standingBox({ 0.1, 0.07, 0.05 }, -0.15, 0.1, 1, 9);
    scene.objects = { test_support::standingBox(SIZE_M, 0.05, -0.04, yaw_rad, TEXTURE_SEED), unknown };
    const Eigen::Isometry3d T_world_camera = lookingAtTable(0.3, 0.45);
    const std::vector<Detection> detections = recogniser.recognise(frameOf(scene, T_world_camera));
    ASSERT_GE(detections.size(), 1U) << "turned by " << yaw_rad;
    const Eigen::Isometry3d off =
        scene.objects[0].T_world_object.inverse() * T_world_camera * detections[0].T_camera_model;
    EXPECT_LT(off.translation().norm(), 0.004) << "turned by " << yaw_rad;
    EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.04) << "turned by " << yaw_rad;
    EXPECT_GT(detections[0].confidence_ratio, 0.5);
    for (std::size_t i = 1; i < detections.size(); ++i)
      EXPECT_LT(detections[i].confidence_ratio, 0.3) << "the unknown box is taken for the known one";
  }
}

TEST_F(RecogniserTest, FindsEveryInstance)
{
  SyntheticScene scene;
  scene.objects = { test_support::standingBox(SIZE_M, 0.1, -0.13, 0.5, TEXTURE_SEED),
                    test_support::standingBox(SIZE_M, -0.08, 0.12, 2.0, TEXTURE_SEED) };
  const std::vector<Detection> detections = Recogniser({ known_ }).recognise(frameOf(scene, lookingAtTable(0.3, 0.5)));
  ASSERT_GE(detections.size(), 2U);
  EXPECT_GT(detections[1].confidence_ratio, 0.3);
  EXPECT_GT((detections[0].T_camera_model.translation() - detections[1].T_camera_model.translation()).norm(), 0.2);
}

TEST_F(RecogniserTest, FindsNothingOnAnEmptyTable)
{
  const rgbd::Frame frame = frameOf(SyntheticScene(), lookingAtTable(0.3, 0.5));
  for (const Detection& detection : Recogniser({ known_ }).recognise(frame))
    EXPECT_LT(detection.confidence_ratio, 0.1);
}

TEST_F(RecogniserTest, FindsNothingWithoutDepth)
{
  rgbd::Frame frame = frameOf(SyntheticScene(), lookingAtTable(0.3, 0.5));
  frame.depth_m.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(Recogniser({ known_ }).recognise(frame).empty());
}

TEST_F(RecogniserTest, SameImageSameDetections)
{
  SyntheticScene scene;
  scene.objects = { test_support::standingBox(SIZE_M, 0.05, -0.04, 1.4, TEXTURE_SEED) };
  const rgbd::Frame frame = frameOf(scene, lookingAtTable(0.3, 0.45));
  const std::vector<Detection> first = Recogniser({ known_ }).recognise(frame);
  const std::vector<Detection> second = Recogniser({ known_ }).recognise(frame);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i)
  {
    EXPECT_EQ(first[i].confidence_ratio, second[i].confidence_ratio);
    EXPECT_TRUE(first[i].T_camera_model.matrix() == second[i].T_camera_model.matrix());
  }
}

TEST_F(RecogniserTest, RefusesOptionsOutOfRange)
{
  RecogniserOptions options;
  options.reference_points = 0;
  EXPECT_FALSE(options.violations().empty());
  EXPECT_TRUE(RecogniserOptions().violations().empty());
}

}  // namespace
}  // namespace object_modelling::recognition
