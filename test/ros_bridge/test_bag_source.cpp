#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "bag_writer.h"
#include "object_modelling/base/status.h"
#include "object_modelling/ros_bridge/bag_source.h"
#include "support/temp_dir.h"
#include "support/thrown_status.h"

namespace object_modelling::ros_bridge
{
namespace
{
using test::BagWriter;

constexpr char COLOR[] = "/camera/rgb/image_rect_color";
constexpr char DEPTH[] = "/camera/depth_registered/image_rect";
constexpr char INFO[] = "/camera/rgb/camera_info";

class BagSourceTest : public ::testing::Test
{
protected:
  std::string path(const std::string& name) const { return folder_.path(name); }

  std::string writeGood(int frames = 5) const
  {
    BagWriter writer(path("good.bag"));
    for (int i = 0; i < frames; ++i)
    {
      writer.info(INFO, 100 + 0.1 * i);
      writer.color(COLOR, 100 + 0.1 * i, i + 1);
      writer.depth(DEPTH, 100.01 + 0.1 * i, i + 1);
    }
    writer.close();
    return path("good.bag");
  }

  static std::string refusal(const std::string& file, base::StatusCode code, const BagSourceOptions& options = {})
  {
    try
    {
      const auto source = openBag(file, options);
      while (source->next())
      {
      }
    }
    catch (const base::Error& error)
    {
      EXPECT_EQ(code, error.code()) << error.what();
      EXPECT_NE(std::string::npos, std::string(error.what()).find(file)) << error.what();
      return error.what();
    }
    return "nothing was refused";
  }

  test_support::TempDir folder_;
};

TEST_F(BagSourceTest, FindsTopicsAndPairsFrames)
{
  const auto source = openBag(writeGood());
  EXPECT_EQ("cam", source->frameId());
  EXPECT_EQ(5u, source->size().value());
  for (int i = 0; i < 5; ++i)
  {
    const auto raw = source->next();
    ASSERT_TRUE(raw);
    EXPECT_NEAR(100 + 0.1 * i, raw->stamp_s, 1e-6);
    EXPECT_NEAR(100.01 + 0.1 * i, raw->depth_stamp_s, 1e-6);
    EXPECT_EQ(i + 1, raw->color.at<cv::Vec3b>(0, 0)[0]);
    EXPECT_EQ(i + 1, raw->depth.at<std::uint16_t>(0, 0));
    EXPECT_EQ(9, raw->camera.fx);  // P, since the topic is rectified
    EXPECT_TRUE(raw->object_mask.empty());
  }
  EXPECT_FALSE(source->next());
}

TEST_F(BagSourceTest, RawTopicsAreReadWithTheirDistortion)
{
  BagWriter writer(path("raw.bag"));
  writer.info("/cam/rgb/camera_info", 1);
  writer.info("/cam/depth/camera_info", 1);
  writer.color("/cam/rgb/image_color", 1, 1);
  writer.depth("/cam/depth_registered/image", 1, 1);
  writer.close();
  const auto raw = openBag(path("raw.bag"))->next();
  ASSERT_TRUE(raw);
  EXPECT_EQ(10, raw->camera.fx);
  EXPECT_TRUE(raw->camera.distorted());
}

TEST_F(BagSourceTest, PairsByStampWhateverTheOrderOfReceipt)
{
  BagWriter writer(path("late.bag"));
  writer.info(INFO, 99);
  for (int i = 0; i < 6; ++i)
  {
    writer.color(COLOR, 100 + 0.033 * i, i + 1);
    if (i != 2)
      writer.depth(DEPTH, 100 + 0.033 * i - 0.002, i + 1, 100 + 0.033 * i + 0.07);  // two frames late; one is lost
  }
  writer.close();
  const auto source = openBag(path("late.bag"));
  std::vector<int> seen;
  while (const auto raw = source->next())
  {
    EXPECT_EQ(raw->color.at<cv::Vec3b>(0, 0)[0], raw->depth.at<std::uint16_t>(0, 0));
    seen.push_back(raw->color.at<cv::Vec3b>(0, 0)[0]);
  }
  EXPECT_EQ((std::vector<int>{ 1, 2, 4, 5, 6 }), seen);
}

TEST_F(BagSourceTest, MasksComeWithTheirFrame)
{
  BagWriter writer(path("mask.bag"));
  writer.info(INFO, 1);
  for (int i = 0; i < 3; ++i)
  {
    if (i == 1)
      writer.mask("/camera/object_mask", 2);
    writer.color(COLOR, 1 + i, 1);
    writer.depth(DEPTH, 1 + i, 1);
  }
  writer.close();
  const auto source = openBag(path("mask.bag"));
  EXPECT_TRUE(source->next()->object_mask.empty());
  EXPECT_FALSE(source->next()->object_mask.empty());
  EXPECT_TRUE(source->next()->object_mask.empty());
}

TEST_F(BagSourceTest, AmbiguousTopicsAreListed)
{
  BagWriter writer(path("two.bag"));
  writer.info("/a/camera_info", 1);
  writer.info("/b/camera_info", 1);
  writer.color("/a/image_color", 1, 1);
  writer.color("/b/image_color", 1, 2);
  writer.depth("/a/depth", 1, 1);
  writer.close();
  const std::string text = refusal(path("two.bag"), base::StatusCode::BAD_INPUT);
  EXPECT_TRUE(test_support::mentions(text, "several colour topics") && test_support::mentions(text, "/a/image_color") &&
              test_support::mentions(text, "/b/image_color"))
      << text;
  BagSourceOptions options;
  options.topics.color = "/b/image_color";
  EXPECT_EQ(2, openBag(path("two.bag"), options)->next()->color.at<cv::Vec3b>(0, 0)[0]);
  options.topics.color = "/c/image_color";
  EXPECT_TRUE(test_support::mentions(refusal(path("two.bag"), base::StatusCode::NOT_FOUND, options), "/c/image_color"));
}

TEST_F(BagSourceTest, SaysWhatIsMissing)
{
  BagWriter empty(path("empty.bag"));
  empty.close();
  EXPECT_TRUE(test_support::mentions(refusal(path("empty.bag"), base::StatusCode::BAD_INPUT), "no colour topic"));

  BagWriter apart(path("apart.bag"));
  apart.info(INFO, 1);
  apart.color(COLOR, 1, 1);
  apart.depth(DEPTH, 1.5, 1);
  apart.close();
  EXPECT_TRUE(
      test_support::mentions(refusal(path("apart.bag"), base::StatusCode::BAD_INPUT), "max_stamp_difference_s"));

  BagWriter unregistered(path("unregistered.bag"));
  unregistered.info(INFO, 1);
  unregistered.color(COLOR, 1, 1);
  unregistered.depth("/camera/depth/image", 1, 1, 0, "ir");
  unregistered.close();
  EXPECT_TRUE(test_support::mentions(refusal(path("unregistered.bag"), base::StatusCode::BAD_INPUT), "not registered"));

  refusal(path("none.bag"), base::StatusCode::NOT_FOUND);
}

TEST_F(BagSourceTest, TruncatedAndForeignFiles)
{
  const std::string good = writeGood(50);
  const auto size = std::filesystem::file_size(good);
  std::filesystem::copy_file(good, path("cut.bag"));
  std::filesystem::resize_file(path("cut.bag"), size / 2);
  EXPECT_NE("nothing was refused", refusal(path("cut.bag"), base::StatusCode::BAD_INPUT));
  std::ofstream(path("text.bag")) << "this is no bag\n";
  EXPECT_NE("nothing was refused", refusal(path("text.bag"), base::StatusCode::BAD_INPUT));
  std::ofstream(path("nothing.bag"));
  EXPECT_NE("nothing was refused", refusal(path("nothing.bag"), base::StatusCode::BAD_INPUT));
}
}  // namespace
}  // namespace object_modelling::ros_bridge
