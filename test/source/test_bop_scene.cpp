#include "object_modelling/source/bop_scene.h"

#include <gtest/gtest.h>

#include <filesystem>

#include <opencv2/imgcodecs.hpp>

#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/status.h"
#include "support/temp_dir.h"

namespace object_modelling::source
{
namespace
{
class BopSceneTest : public ::testing::Test
{
protected:
  void SetUp() override
  {
    for (const char* name : { "rgb", "depth" })
      std::filesystem::create_directory(dir_.path(name));
    for (const char* name : { "000003", "000011" })
    {
      cv::imwrite(dir_.path(std::string("rgb/") + name + ".png"), cv::Mat(24, 32, CV_8UC3, cv::Scalar(10, 50, 60)));
      cv::imwrite(dir_.path(std::string("depth/") + name + ".png"), cv::Mat(24, 32, CV_16UC1, cv::Scalar(5000)));
    }
    base::writeTextFile(dir_.path("scene_camera.json"),
                        "{\n \"11\": {\"cam_K\": [30.0, 0, 15.5, 0, 31, 11.5, 0, 0, 1], \"depth_scale\": 0.1},\n"
                        " \"3\": {\"cam_K\": [30.0, 0, 15.5, 0, 31, 11.5, 0, 0, 1], \"depth_scale\": 1.0}\n}\n");
  }
  void expectBadInput(const std::string& what)
  {
    try
    {
      const auto scene = openBopScene(dir_.path(""));
      while (scene->next())
        ;
      ADD_FAILURE() << "no error: " << what;
    }
    catch (const base::Error& error)
    {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  }

  test_support::TempDir dir_;
};

TEST_F(BopSceneTest, GivesTheImagesByNumber)
{
  EXPECT_TRUE(isBopScene(dir_.path("")));
  EXPECT_EQ(bopImageNumbers(dir_.path("")), (std::vector<int>{ 3, 11 }));
  const auto scene = openBopScene(dir_.path(""));
  EXPECT_EQ(scene->size(), 2U);
  const auto first = scene->next(), second = scene->next();
  ASSERT_TRUE(first && second);
  EXPECT_FALSE(scene->next());
  EXPECT_DOUBLE_EQ(first->depth_unit_m, 0.001);
  EXPECT_DOUBLE_EQ(second->depth_unit_m, 0.0001);
  EXPECT_DOUBLE_EQ(first->camera.fy, 31);
  EXPECT_DOUBLE_EQ(first->camera.cx, 15.5);
  EXPECT_EQ(first->camera.width, 32);
  EXPECT_EQ(first->color.type(), CV_8UC3);
  EXPECT_LT(first->stamp_s, second->stamp_s);
}

TEST_F(BopSceneTest, NamesWhatIsMissing)
{
  std::filesystem::remove(dir_.path("depth/000011.png"));
  expectBadInput("000011.png");
}

TEST_F(BopSceneTest, NamesWhatIsMalformed)
{
  base::writeTextFile(dir_.path("scene_camera.json"), "{\"0\": {\"cam_K\": [1, 2], \"depth_scale\": 1.0}}");
  expectBadInput("cam_K");
  base::writeTextFile(dir_.path("scene_camera.json"), "{\"0\": ");
  expectBadInput("scene_camera.json");
  base::writeTextFile(dir_.path("scene_camera.json"), "{}");
  expectBadInput("names no images");
}

TEST_F(BopSceneTest, GoesOnBehindAnUnreadableImage)
{
  base::writeTextFile(dir_.path("rgb/000003.png"), "no image");
  const auto scene = openBopScene(dir_.path(""));
  EXPECT_THROW(scene->next(), base::Error);
  ASSERT_TRUE(scene->next());
  EXPECT_FALSE(scene->next());
}

TEST_F(BopSceneTest, DepthOfEightBitsIsRefused)
{
  cv::imwrite(dir_.path("depth/000003.png"), cv::Mat(24, 32, CV_8UC1, cv::Scalar(50)));
  expectBadInput("000003.png");
}

TEST(BopScene, AnotherFolderIsNone)
{
  const test_support::TempDir dir;
  EXPECT_FALSE(isBopScene(dir.path("")));
}

}  // namespace
}  // namespace object_modelling::source
