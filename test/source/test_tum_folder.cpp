#include "object_modelling/source/tum_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <opencv2/imgcodecs.hpp>

#include "object_modelling/base/atomic_file.h"
#include "support/temp_dir.h"

namespace object_modelling::source
{
namespace
{
namespace fs = std::filesystem;

const char CAMERA[] =
    "width: 32\nheight: 24\nfx: 30.0\nfy: 31\ncx: 15.5\ncy: 11.5\ndepth_scale: 0.0002\n"
    "frame_id: camera_optical\n";

/// A recording of three frames that a test then breaks. Frame i is painted with colour and depth of its own.
class TumFolderTest : public ::testing::Test
{
protected:
  void SetUp() override
  {
    for (const char* name : { "rgb", "depth", "mask" })
      fs::create_directory(dir_.path(name));
    for (int i = 0; i < 3; ++i)
    {
      cv::imwrite(dir_.path(file("rgb", i)), cv::Mat(24, 32, CV_8UC3, cv::Scalar(10 * i, 50, 60)));
      cv::imwrite(dir_.path(file("depth", i)), cv::Mat(24, 32, CV_16UC1, cv::Scalar(5000 + i)));
    }
    write("camera.yaml", CAMERA);
    write("rgb.txt", "# colour\n1.0 rgb/0.png\n1.1 rgb/1.png\n1.2 rgb/2.png\n");
    write("depth.txt", "# depth\n1.005 depth/0.png\n1.105 depth/1.png\n1.205 depth/2.png\n");
  }
  static std::string file(const std::string& folder, int i) { return folder + "/" + std::to_string(i) + ".png"; }
  void write(const std::string& name, const std::string& text) { base::writeTextFile(dir_.path(name), text); }

  std::vector<rgbd::RawFrame> readAll(const TumFolderOptions& options = {})
  {
    const std::unique_ptr<FrameSource> source = openTumFolder(dir_.path(), options);
    std::vector<rgbd::RawFrame> frames;
    while (std::optional<rgbd::RawFrame> frame = source->next())
      frames.push_back(*frame);
    EXPECT_FALSE(source->next().has_value());
    return frames;
  }
  /// Opening and reading to the end must fail with this code and mention these words.
  void expectError(base::StatusCode code, const std::string& words)
  {
    try
    {
      readAll();
      ADD_FAILURE() << "accepted; expected: " << words;
    }
    catch (const base::Error& error)
    {
      EXPECT_EQ(error.code(), code) << error.what();
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }

  test_support::TempDir dir_;
};

TEST_F(TumFolderTest, DeliversWhatIsThere)
{
  const std::unique_ptr<FrameSource> source = openTumFolder(dir_.path());
  EXPECT_EQ(source->size(), 3u);
  EXPECT_EQ(source->frameId(), "camera_optical");
  EXPECT_EQ(source->name(), dir_.path());
  const std::vector<rgbd::RawFrame> frames = readAll();
  ASSERT_EQ(frames.size(), 3u);
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_DOUBLE_EQ(frames[i].stamp_s, 1.0 + 0.1 * i);
    EXPECT_DOUBLE_EQ(frames[i].depth_stamp_s, 1.005 + 0.1 * i);
    EXPECT_EQ(frames[i].color.at<cv::Vec3b>(3, 3), cv::Vec3b(static_cast<std::uint8_t>(10 * i), 50, 60));
    EXPECT_EQ(frames[i].depth.type(), CV_16UC1);
    EXPECT_EQ(frames[i].depth.at<std::uint16_t>(3, 3), 5000 + i);
    EXPECT_EQ(frames[i].depth_unit_m, 0.0002);
    EXPECT_EQ(frames[i].camera.fy, 31);
    EXPECT_FALSE(frames[i].camera.distorted());
    EXPECT_TRUE(frames[i].object_mask.empty());
    EXPECT_TRUE(rgbd::FrameBuilder().build(frames[i]).ok());
  }
}

TEST_F(TumFolderTest, AssociationsAreTakenAsGiven)
{
  write("associations.txt", "1.0 rgb/0.png 1.2 depth/2.png\n1.1 rgb/1.png 1.1 depth/1.png\n");
  const std::vector<rgbd::RawFrame> frames = readAll();
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].depth.at<std::uint16_t>(0, 0), 5002);
}

TEST_F(TumFolderTest, PairsTheNearestStampsOnceEach)
{
  write("depth.txt", "0.99 depth/1.png\n1.004 depth/0.png\n1.11 depth/2.png\n9.0 depth/2.png\n");
  const std::vector<rgbd::RawFrame> frames = readAll();
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].depth.at<std::uint16_t>(0, 0), 5000);
  EXPECT_EQ(frames[1].depth.at<std::uint16_t>(0, 0), 5002);
}

TEST_F(TumFolderTest, UnsortedListsAndDosLineEndings)
{
  write("rgb.txt", "1.2 rgb/2.png\r\n1.0 rgb/0.png\r\n\r\n1.1 rgb/1.png\r\n");
  write("depth.txt", "1.105 depth/1.png\r\n1.205 depth/2.png\r\n1.005 depth/0.png");
  const std::vector<rgbd::RawFrame> frames = readAll();
  ASSERT_EQ(frames.size(), 3u);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(frames[i].depth.at<std::uint16_t>(0, 0), 5000 + i);
}

TEST_F(TumFolderTest, MasksOfExactStampsAnyValue)
{
  cv::Mat mask = cv::Mat::zeros(24, 32, CV_8UC1);
  mask.colRange(4, 8) = 1;
  mask.colRange(8, 12) = 2;
  cv::imwrite(dir_.path("mask/1.png"), mask);
  write("mask.txt", "1.1 mask/1.png\n1.2004 mask/none.png\n");
  EXPECT_TRUE(readAll()[0].object_mask.empty());
  EXPECT_EQ(cv::countNonZero(readAll()[1].object_mask), 24 * 8);
  EXPECT_TRUE(readAll()[2].object_mask.empty());

  write("objects.yaml", "objects: []\n");  // values are instances now: the first is the object
  EXPECT_EQ(cv::countNonZero(readAll()[1].object_mask), 24 * 4);

  TumFolderOptions options;
  options.use_masks = false;
  EXPECT_TRUE(readAll(options)[1].object_mask.empty());
}

TEST_F(TumFolderTest, DistortionIsPassedOn)
{
  write("camera.yaml", std::string(CAMERA) + "distortion: [0.2624, -0.9531, -0.0054, 0.0026, 1.1633]\n");
  EXPECT_TRUE(readAll().front().camera.distorted());
}

TEST_F(TumFolderTest, MissingPieces)
{
  EXPECT_THROW(openTumFolder(dir_.path("none")), base::Error);
  fs::remove(dir_.path("depth.txt"));
  expectError(base::StatusCode::NOT_FOUND, "depth.txt");
  fs::remove(dir_.path("rgb.txt"));
  expectError(base::StatusCode::NOT_FOUND, ".txt");
  fs::remove(dir_.path("camera.yaml"));
  expectError(base::StatusCode::NOT_FOUND, "camera.yaml");
}

TEST_F(TumFolderTest, BadCameraNamesTheKey)
{
  const std::string good = CAMERA;
  write("camera.yaml", good.substr(good.find('\n') + 1));
  expectError(base::StatusCode::BAD_INPUT, "has no width");
  write("camera.yaml", "width: many\n" + good.substr(good.find('\n') + 1));
  expectError(base::StatusCode::BAD_INPUT, "width");
  write("camera.yaml", "width: -32\n" + good.substr(good.find('\n') + 1));
  expectError(base::StatusCode::BAD_INPUT, "camera/width = -32");
  write("camera.yaml", good + "distortion: [0.1, a]\n");
  expectError(base::StatusCode::BAD_INPUT, "distortion");
  write("camera.yaml", good + "distortion: 5\n");
  expectError(base::StatusCode::BAD_INPUT, "distortion");
  write("camera.yaml", good + "distortion: [1, 2]\n");
  expectError(base::StatusCode::BAD_INPUT, "2 coefficients");
  for (const char* text : { "", "just text", "[1, 2", "width: {a: b", "\t\x01" })
  {
    write("camera.yaml", text);
    expectError(base::StatusCode::BAD_INPUT, "camera.yaml");
  }
}

TEST_F(TumFolderTest, BadDepthScale)
{
  std::string text = CAMERA;
  for (const char* value : { "0", "-0.001", ".nan", ".inf", "[1]" })
  {
    const std::size_t at = std::string(CAMERA).find("0.0002");
    write("camera.yaml", std::string(text).replace(at, 6, value));
    expectError(base::StatusCode::BAD_INPUT, "depth_scale");
  }
}

TEST_F(TumFolderTest, BadListsNameTheLine)
{
  write("rgb.txt", "1.0 rgb/0.png\nlater rgb/1.png\n");
  expectError(base::StatusCode::BAD_INPUT, "rgb.txt:2: \"later\" is not a number");
  write("rgb.txt", "1.0\n");
  expectError(base::StatusCode::BAD_INPUT, "rgb.txt:1");
  write("rgb.txt", "# nothing\n");
  expectError(base::StatusCode::BAD_INPUT, "no pair");
  write("associations.txt", "1.0 rgb/0.png 1.0\n");
  expectError(base::StatusCode::BAD_INPUT, "associations.txt:1");
  write("associations.txt", "");
  expectError(base::StatusCode::BAD_INPUT, "no pair");
}

TEST_F(TumFolderTest, StampTwice)
{
  write("associations.txt", "1.0 rgb/0.png 1.0 depth/0.png\n1.0 rgb/1.png 1.0 depth/1.png\n");
  expectError(base::StatusCode::BAD_INPUT, "twice");
}

TEST_F(TumFolderTest, PathsStayInsideTheFolder)
{
  for (const char* path : { "../secret.png", "/etc/passwd", "rgb/../../secret.png", "..", ".", "rgb/.." })
  {
    write("rgb.txt", std::string("1.0 ") + path + "\n");
    expectError(base::StatusCode::BAD_INPUT, "not a path inside");
  }
  write("rgb.txt", "1.0 rgb/../rgb/./0.png\n");
  EXPECT_EQ(readAll().size(), 1u);
}

TEST_F(TumFolderTest, MissingImageIsNamedAndTheRestCanBeRead)
{
  fs::remove(dir_.path("depth/1.png"));
  expectError(base::StatusCode::NOT_FOUND, "depth/1.png");
  const std::unique_ptr<FrameSource> source = openTumFolder(dir_.path());
  EXPECT_TRUE(source->next().has_value());
  EXPECT_THROW(source->next(), base::Error);
  const std::optional<rgbd::RawFrame> last = source->next();
  ASSERT_TRUE(last.has_value());
  EXPECT_DOUBLE_EQ(last->stamp_s, 1.2);
}

TEST_F(TumFolderTest, DamagedImagesAreNamed)
{
  cv::Mat noise(240, 320, CV_16UC1);
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 65536);
  cv::imwrite(dir_.path("depth/0.png"), noise);
  fs::resize_file(dir_.path("depth/0.png"), fs::file_size(dir_.path("depth/0.png")) / 2);
  expectError(base::StatusCode::BAD_INPUT, "depth/0.png");
  write("depth/0.png", "");
  expectError(base::StatusCode::BAD_INPUT, "depth/0.png");
  write("depth/0.png", "this is no image");
  expectError(base::StatusCode::BAD_INPUT, "depth/0.png");
}

TEST_F(TumFolderTest, CutOffJpegIsNamed)
{
  cv::Mat noise(240, 320, CV_8UC3);
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::imwrite(dir_.path("rgb/0.jpg"), noise);
  write("rgb.txt", "1.0 rgb/0.jpg\n");
  EXPECT_EQ(readAll().size(), 1u);
  fs::resize_file(dir_.path("rgb/0.jpg"), fs::file_size(dir_.path("rgb/0.jpg")) / 2);
  expectError(base::StatusCode::BAD_INPUT, "rgb/0.jpg");
}

TEST_F(TumFolderTest, DestroyedWhileDecodingAhead)
{
  const std::unique_ptr<FrameSource> source = openTumFolder(dir_.path());
  EXPECT_TRUE(source->next().has_value());
}

TEST_F(TumFolderTest, RefusesBadOptions)
{
  TumFolderOptions options;
  options.max_stamp_difference_s = -1;
  EXPECT_THROW(openTumFolder(dir_.path(), options), base::Error);
}

}  // namespace
}  // namespace object_modelling::source
