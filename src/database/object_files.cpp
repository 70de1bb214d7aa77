#include "object_files.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "object_modelling/base/status.h"
#include "object_modelling/database/cloud_file.h"
#include "object_modelling/database/object_database.h"
#include "object_modelling/mesh/mesh_files.h"
#include "object_modelling/mesh/textured_mesh_files.h"
#include "pcd_files.h"
#include "properties_yaml.h"
#include "yaml_text.h"

namespace object_modelling::database
{
namespace
{
using base::Error;
using base::StatusCode;

constexpr int JPEG_QUALITY = 95;

[[noreturn]] void refuse(const ObjectModel& model, const std::string& reason)
{
  throw Error(StatusCode::INVALID_ARGUMENT, "object '" + model.id + "' cannot be written: " + reason);
}

void checkView(const ObjectModel& model, std::size_t index)
{
  const rgbd::View& view = model.views[index];
  const rgbd::Frame& frame = view.frame;
  const cv::Size size(frame.camera.width, frame.camera.height);
  const bool images = frame.color_bgr.type() == CV_8UC3 && frame.depth_m.type() == CV_32FC1 &&
                      frame.color_bgr.size() == size && frame.depth_m.size() == size;
  const bool mask =
      frame.object_mask.empty() || (frame.object_mask.type() == CV_8UC1 && frame.object_mask.size() == size);
  if (!images || !mask || size.area() == 0)
    refuse(model, "colour, depth, mask and camera of view " + std::to_string(index) + " do not fit together");
  if (!view.T_world_camera.matrix().allFinite())
    refuse(model, "the pose of view " + std::to_string(index) + " is not finite");
}

void writeText(const std::string& path, const std::string& text)
{
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file)
    throw Error(StatusCode::STORAGE, "cannot write " + path +
                                         ": check that its folder is writable and the disk has "
                                         "space");
}

void writeImage(const std::string& path, const cv::Mat& image, const std::vector<int>& parameters)
{
  std::vector<unsigned char> bytes;
  if (!cv::imencode(std::filesystem::path(path).extension().string(), image, bytes, parameters))
    throw Error(StatusCode::INTERNAL, "encoder failed for " + path);
  writeText(path, std::string(bytes.begin(), bytes.end()));
}

std::string poseText(const Eigen::Isometry3d& T_target_source)
{
  std::string text;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      text += yamlNumber(T_target_source(row, column)) + (column < 3 ? " " : "\n");
  return text;
}

std::string indicesText(const rgbd::Frame& frame)
{
  std::string text;
  for (int v = 0; v < frame.object_mask.rows; ++v)
    for (int u = 0; u < frame.object_mask.cols; ++u)
      if (frame.object_mask.at<unsigned char>(v, u) > 0 && frame.depthAt_m(u, v) > 0)
        text += std::to_string(v * frame.object_mask.cols + u) + "\n";
  return text;
}

/// V4R's layout: one set of files per view, numbered from 0.
void writeView(const std::string& folder, std::size_t index, const rgbd::View& view)
{
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%08zu", index);
  const std::string id = number.data();
  writeOrganizedCloud(folder + "/cloud_" + id + ".pcd", view.frame);
  writeText(folder + "/pose_" + id + ".txt", poseText(view.T_world_camera));
  writeText(folder + "/object_indices_" + id + ".txt", indicesText(view.frame));
  writeImage(folder + "/image_" + id + ".jpg", view.frame.color_bgr, { cv::IMWRITE_JPEG_QUALITY, JPEG_QUALITY });
}
}  // namespace

void checkModel(const ObjectModel& model)
{
  checkObjectId(model.id);
  if (model.mesh.empty())
    refuse(model, "its mesh is empty");
  const geometry::OrientedBox& box = model.box_model;
  bool finite = box.size_m.allFinite() && box.T_frame_box.matrix().allFinite() && std::isfinite(model.diameter_m);
  for (const Eigen::Isometry3d& T_support_model : model.T_support_model)
    finite &= T_support_model.matrix().allFinite();
  for (const ModelSession& session : model.sessions)
    finite &= session.T_model_session.matrix().allFinite();
  if (model.properties && !isFinite(*model.properties))
    refuse(model, "one of its properties is not finite");
  if (!finite)
    refuse(model, "its size or one of its poses is not finite");
  if (!model.preview_bgr.empty() && model.preview_bgr.type() != CV_8UC3)
    refuse(model, "its preview is not CV_8UC3");
  if (!model.turntable_bgr.empty() && model.turntable_bgr.type() != CV_8UC3)
    refuse(model, "its turntable picture is not CV_8UC3");
  for (std::size_t i = 0; i < model.views.size(); ++i)
    checkView(model, i);
}

void writeCollisionParts(const std::string& folder, const object_properties::ObjectProperties& properties)
{
  for (std::size_t i = 0; i < properties.collision_parts.size(); ++i)
    mesh::writeMesh(folder + "/" + collisionFile(static_cast<int>(i)), properties.collision_parts[i]);
}

void writeObjectFiles(const std::string& folder, const ObjectModel& model, base::JobControl& control)
{
  namespace fs = std::filesystem;
  const std::string stage = "write object '" + model.id + "'";
  const std::size_t total = model.views.size() + 2;
  fs::create_directory(folder + "/mesh");
  fs::create_directory(folder + "/views");
  control.report(stage, 0, total);
  mesh::writeMesh(folder + "/mesh/mesh.ply", model.mesh, model.mesh_sigmas_m);
  mesh::writeMesh(folder + "/mesh/mesh.obj", model.mesh);
  if (model.properties)
    writeCollisionParts(folder, *model.properties);
  if (!model.textured.empty())
  {
    mesh::writeTexturedMesh(folder + "/mesh/textured.obj", model.textured);
    mesh::writeTexturedMesh(folder + "/mesh/textured.glb", model.textured);
    writeImage(folder + "/mesh/textured_seen.png", model.textured.seen, {});
  }
  if (!model.preview_bgr.empty())
    writeImage(folder + "/preview.png", model.preview_bgr, {});
  if (!model.turntable_bgr.empty())
    writeImage(folder + "/turntable.png", model.turntable_bgr, {});
  if (!model.quality_yaml.empty())
    writeText(folder + "/quality.yaml", model.quality_yaml);
  control.report(stage, 1, total);
  writeCloud(folder + "/cloud.pcd", model.cloud);
  for (std::size_t i = 0; i < model.views.size(); ++i)
  {
    control.report(stage, i + 2, total);
    writeView(folder + "/views", i, model.views[i]);
  }
  control.report(stage, total, total);
}

}  // namespace object_modelling::database
