#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "keyframe_map.h"
#include "object_modelling/registration/image_pyramid.h"
#include "surface_relocaliser.h"
#include "tracking_scene.h"

namespace object_modelling::tracking
{
namespace
{

/// A map of four views round a scene, and the question where a frame is in it.
class SurfaceMap
{
public:
  explicit SurfaceMap(const test_support::SyntheticScene& scene)
  {
    for (int i = 0; i < 4; ++i)
      T_world_cameras_.push_back(test_support::orbitPose(TARGET, 0.6, 1.5 * i, 0.6));
    for (const rgbd::Keyframe& keyframe :
         test_support::renderKeyframes(scene, TrackingScene::camera(), T_world_cameras_, sensorNoise(0)))
    {
      MapKeyframe known;
      known.id = keyframe.id;
      known.T_session_camera = keyframe.T_session_camera;
      known.frame = keyframe.frame;
      known.frame.object_mask.release();
      known.pyramid = registration::ImagePyramid(keyframe.frame.gray).copyLevels();
      known.median_depth_m = 0.6;
      map_.add(std::move(known));
    }
  }
  const Eigen::Isometry3d& T_world_camera(int i) const { return T_world_cameras_[static_cast<std::size_t>(i)]; }
  std::optional<registration::DenseAlignment> find(rgbd::Frame frame,
                                                   const std::optional<Eigen::Isometry3d>& T_hint = {}) const
  {
    frame.object_mask.release();
    const registration::ImagePyramid pyramid(frame.gray);
    const std::optional<RecognisedSurfaces> found = relocaliseBySurfaces(
        registration::DensePyramid(frame, pyramid.levels()), makeThumbnail(frame.gray), map_, T_hint);
    return found && found->rivals.empty() ? std::make_optional(found->aligned) : std::nullopt;
  }

private:
  std::vector<Eigen::Isometry3d> T_world_cameras_;
  KeyframeMap map_;
};

/// Other scenes of the same kinds of things.
std::vector<test_support::SyntheticScene> otherScenes()
{
  std::vector<test_support::SyntheticScene> scenes(4, plainScene());
  scenes[0].objects = { test_support::standingSphere(0.16, 0.05, -0.1), test_support::standingBox({ 0.2, 0.1, 0.05 }) };
  scenes[1].objects = { test_support::standingCylinder(0.12, 0.22), test_support::standingCylinder(0.06, 0.1, -0.15) };
  scenes[2].objects = { test_support::standingBox({ 0.25, 0.06, 0.1 }, -0.05, 0.1, 0.8) };
  for (test_support::SyntheticScene& scene : scenes)
    for (test_support::SceneObject& object : scene.objects)
      object.texture = test_support::plainTexture({ 80, 130, 190 });
  scenes[3] = test_support::boxOnTable();
  scenes[3].objects[0] = test_support::standingCylinder(0.14, 0.12, 0.05);
  return scenes;
}

Eigen::Isometry3d slightly(double size)
{
  geometry::Vector6d x;
  x << size, -size, 0.5 * size, size, 0.7 * size, -1.3 * size;
  return geometry::isometryFromVector(x);
}
}  // namespace

TEST(SurfaceRelocaliser, FindsTheRightOneOfFourViews)
{
  const SurfaceMap map(plainScene());
  for (int i = 0; i < 4; ++i)
  {
    const Eigen::Isometry3d T_world_camera = map.T_world_camera(i) * slightly(0.03);
    const rgbd::Frame frame =
        test_support::renderFrame(plainScene(), TrackingScene::camera(), T_world_camera, sensorNoise(7 + i));
    const std::optional<registration::DenseAlignment> found = map.find(frame);
    ASSERT_TRUE(found) << i;
    EXPECT_TRANSFORM_NEAR(found->T_world_camera, T_world_camera, 0.004, 0.006) << i;
    // A hint that is wrong does no harm.
    const std::optional<registration::DenseAlignment> misled = map.find(frame, map.T_world_camera((i + 1) % 4));
    ASSERT_TRUE(misled) << i;
    EXPECT_TRANSFORM_NEAR(misled->T_world_camera, T_world_camera, 0.004, 0.006) << i;
  }
}

TEST(SurfaceRelocaliser, NeverPlacesAnotherScene)
{
  const SurfaceMap map(plainScene());
  const std::vector<test_support::SyntheticScene> others = otherScenes();
  for (std::size_t k = 0; k < others.size(); ++k)
    for (int i = 0; i < 4; ++i)
    {
      const Eigen::Isometry3d T_world_camera = map.T_world_camera(i) * slightly(0.01);
      const std::optional<registration::DenseAlignment> found =
          map.find(test_support::renderFrame(others[k], TrackingScene::camera(), T_world_camera, sensorNoise(i)),
                   T_world_camera);
      EXPECT_FALSE(found) << k << " seen as from " << i;
    }
}

TEST(SurfaceRelocaliser, RefusesWhatLooksTheSameFromSeveralSides)
{
  test_support::SyntheticScene round = plainScene();
  round.table_half_size_m = 8;
  round.objects = { test_support::standingCylinder(0.12, 0.18) };
  round.objects[0].texture = test_support::plainTexture({ 80, 130, 190 });
  const SurfaceMap map(round);
  for (int i = 0; i < 4; ++i)
    EXPECT_FALSE(map.find(test_support::renderFrame(round, TrackingScene::camera(),
                                                    map.T_world_camera(i) * slightly(0.01), sensorNoise(7 + i))))
        << i;
}

TEST(SurfaceRelocaliser, FindsNothingWithoutAMapOrWithoutAView)
{
  const rgbd::Frame frame =
      test_support::renderFrame(plainScene(), TrackingScene::camera(), test_support::orbitPose(TARGET, 0.6, 0, 0.6));
  const registration::ImagePyramid pyramid(frame.gray);
  const registration::DensePyramid dense(frame, pyramid.levels());
  EXPECT_FALSE(relocaliseBySurfaces(dense, makeThumbnail(frame.gray), KeyframeMap(), {}));
  const SurfaceMap map(plainScene());
  EXPECT_FALSE(map.find(covered(TrackingScene(1), 0)));
  EXPECT_FALSE(map.find(covered(TrackingScene(1), 0), map.T_world_camera(0)));
}
}  // namespace object_modelling::tracking
