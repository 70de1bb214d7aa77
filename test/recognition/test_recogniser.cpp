#include "object_modelling/recognition/recogniser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "recognition_fixture.h"

namespace object_modelling::recognition
{
namespace
{
using test_support::SyntheticScene;

void expectPose(const Eigen::Isometry3d& T_camera_model, const Eigen::Isometry3d& T_camera_truth)
{
  const Eigen::Isometry3d off = T_camera_truth.inverse() * T_camera_model;
  EXPECT_LT(off.translation().norm(), 0.004);
  EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.04);
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

  /// Also the detections that are hardly likely, so that bounds of their confidence mean something.
  static RecogniserOptions everything()
  {
    RecogniserOptions options;
    options.min_confidence_ratio = 0.02;
    return options;
  }

  /// The known box at another size, found by shape alone.
  static std::shared_ptr<const ObjectKnowledge> other(int number, double scale)
  {
    ObjectKnowledge knowledge = *known_;
    knowledge.id = "other_" + std::to_string(number);
    knowledge.diameter_m *= scale;
    knowledge.box_model.size_m *= scale;
    knowledge.center_model *= static_cast<float>(scale);
    for (Eigen::Vector3f& vertex : knowledge.mesh.vertices)
      vertex *= static_cast<float>(scale);
    for (auto* surface : { &knowledge.surface, &knowledge.texture })
      for (Eigen::Vector3f& point : surface->oriented.points)
        point *= static_cast<float>(scale);
    knowledge.pairs = PairTable(knowledge.surface.oriented, knowledge.diameter_m);
    knowledge.descriptors = cv::Mat();
    knowledge.feature_points.clear();
    return std::make_shared<const ObjectKnowledge>(std::move(knowledge));
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
  const Recogniser recogniser({ known_ }, everything());
  for (const double yaw_rad : { 0.4, 2.6, 4.4 })
  {
    const SyntheticScene scene = boxBesideAnother(yaw_rad);
    const Eigen::Isometry3d T_world_camera = lookingAtTable(0.3, 0.45);
    const std::vector<Detection> detections = recogniser.recognise(noisyFrame(scene, T_world_camera));
    ASSERT_GE(detections.size(), 1U) << "turned by " << yaw_rad;
    SCOPED_TRACE(yaw_rad);
    expectPose(detections[0].T_camera_model, T_world_camera.inverse() * scene.objects[0].T_world_object);
    EXPECT_GT(detections[0].confidence_ratio, 0.5);
    for (std::size_t i = 1; i < detections.size(); ++i)
      EXPECT_LT(detections[i].confidence_ratio, 0.5) << "the unknown box is taken for the known one";
  }
}

TEST_F(RecogniserTest, FindsEveryInstance)
{
  SyntheticScene scene;
  scene.objects = { test_support::standingBox(SIZE_M, 0.1, -0.13, 0.5, TEXTURE_SEED),
                    test_support::standingBox(SIZE_M, -0.08, 0.12, 2.0, TEXTURE_SEED) };
  const std::vector<Detection> detections =
      Recogniser({ known_ }, everything()).recognise(noisyFrame(scene, lookingAtTable(0.3, 0.5)));
  ASSERT_GE(detections.size(), 2U);
  EXPECT_GT(detections[1].confidence_ratio, 0.3);
  EXPECT_GT((detections[0].T_camera_model.translation() - detections[1].T_camera_model.translation()).norm(), 0.2);
}

TEST_F(RecogniserTest, FindsNothingOnAnEmptyTable)
{
  const rgbd::Frame frame = noisyFrame(SyntheticScene(), lookingAtTable(0.3, 0.5));
  for (const Detection& detection : Recogniser({ known_ }, everything()).recognise(frame))
    EXPECT_LT(detection.confidence_ratio, 0.1);
}

TEST_F(RecogniserTest, FindsNothingWithoutDepth)
{
  rgbd::Frame frame = noisyFrame(SyntheticScene(), lookingAtTable(0.3, 0.5));
  frame.depth_m.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(Recogniser({ known_ }, everything()).recognise(frame).empty());
}

TEST_F(RecogniserTest, FindsTheBoxInTheAir)
{
  SyntheticScene scene;
  scene.has_table = false;
  scene.objects = { test_support::standingBox(SIZE_M, 0.03, -0.02, 2.3, TEXTURE_SEED) };
  const Eigen::Isometry3d T_world_camera = lookingAtTable(0.3, 0.45);
  const std::vector<Detection> detections = Recogniser({ known_ }).recognise(noisyFrame(scene, T_world_camera));
  ASSERT_EQ(detections.size(), 1U);
  expectPose(detections[0].T_camera_model, T_world_camera.inverse() * scene.objects[0].T_world_object);
}

TEST_F(RecogniserTest, AQuickSearchChoosesAmongManyObjects)
{
  std::vector<std::shared_ptr<const ObjectKnowledge>> objects;
  for (int i = 0; i < 8; ++i)
    objects.push_back(other(i, i < 4 ? 0.4 + 0.1 * i : 0.8 + 0.15 * i));
  objects.push_back(known_);
  RecogniserOptions options = everything();
  options.use_texture = false;
  options.objects_per_cluster = 2;
  SyntheticScene scene;
  scene.objects = { test_support::standingBox(SIZE_M, 0.05, -0.04, 2.6, TEXTURE_SEED) };
  const Eigen::Isometry3d T_world_camera = lookingAtTable(0.3, 0.45);
  const std::vector<Detection> detections = Recogniser(objects, options).recognise(noisyFrame(scene, T_world_camera));
  ASSERT_GE(detections.size(), 1U);
  EXPECT_EQ(detections[0].object_id, "box");
  expectPose(detections[0].T_camera_model, T_world_camera.inverse() * scene.objects[0].T_world_object);
}

TEST_F(RecogniserTest, WhenTheTimeIsUpTextureIsEnough)
{
  RecogniserOptions options;
  options.time_budget_s = 1e-6;
  SyntheticScene scene;
  scene.objects = { test_support::standingBox(SIZE_M, 0.05, -0.04, 2.6, TEXTURE_SEED) };
  const Eigen::Isometry3d T_world_camera = lookingAtTable(0.3, 0.45);
  const std::vector<Detection> detections =
      Recogniser({ known_ }, options).recognise(noisyFrame(scene, T_world_camera));
  ASSERT_EQ(detections.size(), 1U);
  EXPECT_GT(detections[0].matched_features, 0);
  expectPose(detections[0].T_camera_model, T_world_camera.inverse() * scene.objects[0].T_world_object);
}

TEST_F(RecogniserTest, OfPosesAtOnePlaceOneIsConfident)
{
  SyntheticScene scene;
  scene.objects = { test_support::standingBox(SIZE_M, 0.05, -0.04, 2.6, TEXTURE_SEED) };
  const Recogniser recogniser({ known_, other(0, 0.9) });
  const std::vector<Candidate> candidates = recogniser.candidates(noisyFrame(scene, lookingAtTable(0.3, 0.45)));
  ASSERT_GE(candidates.size(), 2U);
  EXPECT_TRUE(std::is_sorted(candidates.begin(), candidates.end(),
                             [](const Candidate& a, const Candidate& b) { return a.score > b.score; }));
  EXPECT_GT(candidates[0].confidence, 0.7);
  EXPECT_GT(candidates[0].score, candidates[0].rival_score);
  for (std::size_t i = 1; i < candidates.size(); ++i)
    EXPECT_LT(candidates[i].confidence, 0.1) << i;
}

TEST_F(RecogniserTest, SameImageSameDetections)
{
  SyntheticScene scene;
  scene.objects = { test_support::standingBox(SIZE_M, 0.05, -0.04, 1.4, TEXTURE_SEED) };
  const rgbd::Frame frame = noisyFrame(scene, lookingAtTable(0.3, 0.45));
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
