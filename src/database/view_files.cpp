#include "object_modelling/database/view_files.h"

#include <array>
#include <cstdio>
#include <fstream>
#include <limits>

#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <yaml-cpp/yaml.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "object_modelling/base/status.h"
#include "pcd_files.h"

namespace object_modelling::database
{
namespace
{
geometry::PinholeCamera cameraOf(const YAML::Node& view)
{
  geometry::PinholeCamera camera;
  camera.width = view["width_px"].as<int>();
  camera.height = view["height_px"].as<int>();
  camera.fx = view["fx_px"].as<double>();
  camera.fy = view["fy_px"].as<double>();
  camera.cx = view["cx_px"].as<double>();
  camera.cy = view["cy_px"].as<double>();
  return camera;
}

Eigen::Isometry3d readPose(const std::string& path)
{
  std::ifstream file(path);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      file >> T.matrix()(row, column);
  if (!file || !T.matrix().allFinite())
    damaged(path, "it holds no 4x4 transform");
  return T;
}

cv::Mat readDepth_m(const std::string& path, const geometry::PinholeCamera& camera)
{
  pcl::PCLPointCloud2 file;
  pcl::PointCloud<pcl::PointXYZ> cloud;
  if (pcl::io::loadPCDFile(path, file) != 0)
    damaged(path, "it is no whole PCD file");
  pcl::fromPCLPointCloud2(file, cloud);
  if (static_cast<int>(cloud.width) != camera.width || static_cast<int>(cloud.height) != camera.height)
    damaged(path, "its size is not that of the view");
  cv::Mat depth_m(camera.height, camera.width, CV_32FC1);
  for (int v = 0; v < depth_m.rows; ++v)
    for (int u = 0; u < depth_m.cols; ++u)
      depth_m.at<float>(v, u) = cloud(u, v).z;
  return depth_m;
}

cv::Mat readMask(const std::string& path, const geometry::PinholeCamera& camera)
{
  std::ifstream file(path);
  if (!file)
    damaged(path, "it is missing");
  cv::Mat mask(camera.height, camera.width, CV_8UC1, cv::Scalar(0));
  std::size_t index = 0;
  while (file >> index)
  {
    if (index >= mask.total())
      damaged(path, "it names pixels beyond the image");
    mask.data[index] = 255;
  }
  return mask;
}

/// Place of a view's session among those of the object; 0 where the file does not tell.
int sessionIndexOf(const YAML::Node& view, const YAML::Node& object)
{
  if (!view["session"])
    return 0;
  const auto id = view["session"].as<std::string>();
  for (std::size_t i = 0; i < object["sessions"].size(); ++i)
    if (object["sessions"][i]["id"].as<std::string>() == id)
      return static_cast<int>(i);
  return 0;
}

rgbd::View readView(const std::string& folder, const YAML::Node& description)
{
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%08d", description["index"].as<int>());
  const std::string id = number.data(), views = folder + "/views/";
  rgbd::View view;
  view.frame.camera = cameraOf(description);
  view.frame.stamp_s = description["stamp_s"].as<double>();
  view.frame.color_bgr = cv::imread(views + "image_" + id + ".jpg", cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  if (view.frame.color_bgr.size() != cv::Size(view.frame.camera.width, view.frame.camera.height))
    damaged(views + "image_" + id + ".jpg", "its size is not that of the view");
  cv::cvtColor(view.frame.color_bgr, view.frame.gray, cv::COLOR_BGR2GRAY);
  view.frame.depth_m = readDepth_m(views + "cloud_" + id + ".pcd", view.frame.camera);
  view.frame.object_mask = readMask(views + "object_indices_" + id + ".txt", view.frame.camera);
  view.T_world_camera = readPose(views + "pose_" + id + ".txt");
  return view;
}
}  // namespace

std::vector<rgbd::View> readViews(const std::string& object_folder, std::size_t max_views)
{
  const std::string path = object_folder + "/object.yaml";
  YAML::Node object;
  try
  {
    object = YAML::LoadFile(path);
  }
  catch (const YAML::Exception& error)
  {
    damaged(path, error.what());
  }
  const YAML::Node views = object["views"];
  const std::size_t count = views.size(), wanted = max_views == 0 ? count : std::min(max_views, count);
  std::vector<rgbd::View> result;
  for (std::size_t i = 0; i < wanted; ++i)
  {
    const YAML::Node& view = views[i * count / wanted];
    result.push_back(readView(object_folder, view));
    result.back().session_index = sessionIndexOf(view, object);
  }
  return result;
}

}  // namespace object_modelling::database
