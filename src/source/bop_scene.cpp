#include "object_modelling/source/bop_scene.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <map>

#include <yaml-cpp/yaml.h>
#include <opencv2/imgcodecs.hpp>

#include "image_file.h"
#include "object_modelling/base/atomic_file.h"
#include "text_table.h"

namespace object_modelling::source
{
namespace
{
namespace fs = std::filesystem;

constexpr double RATE_HZ = 30;
constexpr double FIRST_STAMP_S = 1;  // zero would be no stamp

struct ImageCamera
{
  geometry::PinholeCamera camera;  ///< size not known
  double depth_unit_m = 0;
};

std::string cameraFileOf(const std::string& folder)
{
  return (fs::path(folder) / "scene_camera.json").string();
}

/// JSON is YAML in flow style.
std::map<int, ImageCamera> readCameras(const std::string& folder)
{
  const std::string path = cameraFileOf(folder);
  const std::string text = base::readTextFile(path);
  std::map<int, ImageCamera> cameras;
  try
  {
    for (const auto& entry : YAML::Load(text))
    {
      const auto K = entry.second["cam_K"].as<std::vector<double>>();
      if (K.size() != 9)
        throw badInput(path, "cam_K of image " + entry.first.as<std::string>() + " has not nine numbers");
      ImageCamera image;
      image.camera.fx = K[0];
      image.camera.cx = K[2];
      image.camera.fy = K[4];
      image.camera.cy = K[5];
      image.depth_unit_m = 0.001 * entry.second["depth_scale"].as<double>();
      cameras[entry.first.as<int>()] = image;
    }
  }
  catch (const YAML::Exception& error)
  {
    throw badInput(path, std::string("is no scene_camera.json of BOP: ") + error.what());
  }
  if (cameras.empty())
    throw badInput(path, "names no images");
  return cameras;
}

class BopScene : public FrameSource
{
public:
  explicit BopScene(const std::string& folder) : folder_(folder), cameras_(readCameras(folder)), next_(cameras_.begin())
  {
  }

  std::optional<rgbd::RawFrame> next() override
  {
    if (next_ == cameras_.end())
      return std::nullopt;
    const auto& [number, image] = *next_++;
    rgbd::RawFrame frame;
    frame.stamp_s = FIRST_STAMP_S + number / RATE_HZ;
    frame.depth_stamp_s = frame.stamp_s;
    frame.color = readImage(colorFileOf(number), cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
    const std::string depth_path = fileOf("depth", number, ".png");
    frame.depth = readImage(depth_path, cv::IMREAD_UNCHANGED);
    if (frame.depth.type() != CV_16UC1)
      throw badInput(depth_path, "is no 16 bit depth image");
    frame.depth_unit_m = image.depth_unit_m;
    frame.camera = image.camera;
    frame.camera.width = frame.color.cols;
    frame.camera.height = frame.color.rows;
    return frame;
  }
  std::optional<std::size_t> size() const override { return cameras_.size(); }
  std::string frameId() const override { return "camera_rgb_optical_frame"; }
  std::string name() const override { return folder_; }

private:
  std::string fileOf(const std::string& kind, int number, const std::string& extension) const
  {
    std::array<char, 16> digits{};
    std::snprintf(digits.data(), digits.size(), "%06d", number);
    return (fs::path(folder_) / kind / (digits.data() + extension)).string();
  }
  std::string colorFileOf(int number) const
  {
    for (const char* kind : { "rgb", "gray" })
      for (const char* extension : { ".png", ".jpg", ".tif" })
        if (fs::exists(fileOf(kind, number, extension)))
          return fileOf(kind, number, extension);
    return fileOf("rgb", number, ".png");  // which its reader then misses
  }

  std::string folder_;
  std::map<int, ImageCamera> cameras_;
  std::map<int, ImageCamera>::const_iterator next_;
};
}  // namespace

bool isBopScene(const std::string& folder)
{
  std::error_code ignored;
  return fs::exists(cameraFileOf(folder), ignored);
}

std::vector<int> bopImageNumbers(const std::string& folder)
{
  std::vector<int> numbers;
  for (const auto& [number, image] : readCameras(folder))
    numbers.push_back(number);
  return numbers;
}

std::unique_ptr<FrameSource> openBopScene(const std::string& folder)
{
  return std::make_unique<BopScene>(folder);
}

}  // namespace object_modelling::source
