// Quality of the texture at keyframes that it was not made from. Each recording goes through the whole chain (tracking,
// refinement, segmentation, fusion, surface); then every n-th keyframe is held out, the mesh is textured with the
// others and drawn from where the held-out ones stood. benchmark_texture --help; docs/surface.md.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>

#include <glog/logging.h>
#include <yaml-cpp/yaml.h>
#include <CLI/CLI.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/mesh/mesh_files.h"
#include "object_modelling/mesh/textured_mesh_files.h"
#include "object_modelling/mesh/textured_renderer.h"
#include "object_modelling/pipeline/record_session.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/rgbd/keyframe_view.h"
#include "object_modelling/source/tum_folder.h"
#include "object_modelling/surface/surface_reconstruction.h"
#include "object_modelling/texture/texturing.h"
#include "support/temp_dir.h"
#include "texture_quality.h"

namespace
{
using namespace object_modelling;
using benchmark_texture::psnrAfterFit_dB;
using benchmark_texture::psnrUnderLight_dB;

constexpr int RIM_PX = 2;  ///< pixels nearer to the rim of mask or silhouette show background too and do not count
constexpr int SAMPLES_PER_SIDE = 3, TRUTH_SAMPLES_PER_SIDE = 8;  ///< the truth has finer texels
constexpr double SAME_STAMP_S = 0.005;

struct Arguments
{
  std::vector<std::string> recordings;
  std::string truth, store, out;
  int hold_out = 5, object = 0;
  double resolution_mm = 2;
  bool color_offset = true;
  texture::TextureOptions texture;
};

/// What the chain makes of a recording.
struct Model
{
  std::vector<rgbd::Keyframe> keyframes;
  Eigen::Vector2d color_offset_px = Eigen::Vector2d::Zero();
  mesh::TriangleMesh mesh;
};

void throwUnlessOk(const base::Status& status)
{
  if (!status.ok())
    throw base::Error(status.code, status.message);
}

/// Keeps the processed sessions in `store` if one was given; they are then not made again.
Model makeModel(const std::string& recording, const Arguments& arguments)
{
  base::JobControl control;
  const test_support::TempDir folder;
  const auto store = keyframes::openSqlStore(arguments.store.empty() ? folder.path("store.db") : arguments.store);
  const std::filesystem::path path = std::filesystem::absolute(recording).lexically_normal();
  const std::string id = path.parent_path().filename().string() + "_" + path.filename().string();
  bool known = false;
  for (const keyframes::Session& session : store->listSessions())
    known |= session.id == id;
  if (!known)
  {
    const std::unique_ptr<source::FrameSource> source = source::openTumFolder(recording);
    keyframes::Session session;
    session.id = id;
    pipeline::recordSession(*source, session, store.get(), {}, control);
    throwUnlessOk(pipeline::segmentStoredSession(*store, id, std::nullopt, {}, control).status);
  }
  const bundle_adjustment::BundleAdjustmentResult refined = pipeline::refineStoredSession(*store, id, {}, control);
  throwUnlessOk(refined.status);
  Model model;
  model.color_offset_px = refined.color_offset_px;
  for (rgbd::Keyframe& keyframe : keyframes::loadKeyframes(*store, id))
    if (!keyframe.frame.object_mask.empty())
      model.keyframes.push_back(std::move(keyframe));

  fusion::CloudFusionOptions fusion_options;
  surface::SurfaceOptions surface_options;
  fusion_options.resolution_m = surface_options.resolution_m = arguments.resolution_mm / 1000;
  const fusion::CloudFusionResult fused = fusion::fuse(rgbd::viewsOf(model.keyframes), fusion_options, control);
  throwUnlessOk(fused.status);
  surface::SurfaceResult surface = surface::reconstructSurface(fused.cloud, std::nullopt, surface_options, control);
  throwUnlessOk(surface.status);
  model.mesh = std::move(surface.mesh);
  return model;
}

/// A true mesh without texture is of one colour, which a fit per channel finds.
mesh::TexturedMesh readTruth(const std::string& path)
{
  try
  {
    return mesh::readTexturedMesh(path);
  }
  catch (const base::Error& error)
  {
    if (error.code() != base::StatusCode::BAD_INPUT)
      throw;
  }
  mesh::TexturedMesh plain;
  plain.mesh = mesh::readMesh(path);
  mesh::computeNormals(&plain.mesh);
  plain.texture_bgr = cv::Mat(4, 4, CV_8UC3, cv::Scalar(128, 128, 128));
  plain.uvs.assign(plain.mesh.triangles.size(),
                   { Eigen::Vector2f(0.5f, 0.5f), Eigen::Vector2f(0.5f, 0.5f), Eigen::Vector2f(0.5f, 0.5f) });
  return plain;
}

/// Where the true mesh stands in the frames of a recording.
class Truth
{
public:
  Truth(const std::string& recording, const std::string& mesh, int object)
      : textured_(readTruth(mesh)), trajectory_(source::readTrajectory(recording + "/groundtruth.txt"))
  {
    const YAML::Node objects = YAML::LoadFile(recording + "/objects.yaml")["objects"];
    const YAML::Node rows = objects[object]["T_world_object"];
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        T_world_object_(row, column) = rows[row][column].as<double>();
  }
  /// Of one colour.
  bool plain() const { return textured_.texture_bgr.total() <= 16; }
  /// Seen at a frame of the recording.
  mesh::MeshView render(const geometry::PinholeCamera& camera, double stamp_s) const
  {
    for (const source::StampedPose& pose : trajectory_)
      if (std::abs(pose.stamp_s - stamp_s) < SAME_STAMP_S)
        return mesh::renderTexturedMesh(textured_, camera, pose.T_map_camera.inverse() * T_world_object_,
                                        TRUTH_SAMPLES_PER_SIDE);
    throw base::Error(base::StatusCode::NOT_FOUND, "groundtruth.txt has no pose at " + std::to_string(stamp_s));
  }

private:
  mesh::TexturedMesh textured_;
  std::vector<source::StampedPose> trajectory_;
  Eigen::Isometry3d T_world_object_ = Eigen::Isometry3d::Identity();
};

/// Camera of the colour image: the poses are those of the depth image's.
geometry::PinholeCamera colorCamera(geometry::PinholeCamera camera, const Eigen::Vector2d& color_offset_px)
{
  camera.cx += color_offset_px.x();
  camera.cy += color_offset_px.y();
  return camera;
}

/// Of the triangles that a picture shows, in the frame of the mesh.
cv::Mat normalsOf(const mesh::MeshView& view, const mesh::TriangleMesh& mesh)
{
  cv::Mat normals = cv::Mat::zeros(view.triangle_id.size(), CV_32FC3);
  for (int v = 0; v < normals.rows; ++v)
    for (int u = 0; u < normals.cols; ++u)
      if (const int triangle = view.triangle_id.at<int>(v, u); triangle >= 0)
      {
        const Eigen::Vector3f& n = mesh.normals[mesh.triangles[triangle][0]];
        normals.at<cv::Vec3f>(v, u) = { n.x(), n.y(), n.z() };
      }
  return normals;
}

cv::Mat cutOut(const cv::Mat& image, const cv::Mat& mask, const cv::Rect& box)
{
  cv::Mat shown(image.size(), CV_8UC3, cv::Scalar(255, 255, 255));
  image.copyTo(shown, mask);
  cv::Mat large;
  cv::resize(shown(box), large, cv::Size(), 3, 3, cv::INTER_NEAREST);
  return large;
}

void measure(const std::string& recording, const Arguments& arguments)
{
  const Model model = makeModel(recording, arguments);
  std::vector<rgbd::Keyframe> used, held_out;
  for (std::size_t i = 0; i < model.keyframes.size(); ++i)
    (static_cast<int>(i) % arguments.hold_out == arguments.hold_out / 2 ? held_out : used)
        .push_back(model.keyframes[i]);
  const Eigen::Vector2d offset_px = arguments.color_offset ? model.color_offset_px : Eigen::Vector2d(0, 0);
  base::JobControl control;
  const auto start = std::chrono::steady_clock::now();
  const texture::TextureResult result =
      texture::textureMesh(model.mesh, rgbd::viewsOf(used, offset_px), arguments.texture, control);
  const double texture_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  throwUnlessOk(result.status);

  std::optional<Truth> truth;
  if (!arguments.truth.empty())
    truth.emplace(recording, arguments.truth, arguments.object);
  double image_sum = 0, truth_sum = 0, lit_sum = 0, image_worst = INFINITY, truth_worst = INFINITY,
         lit_worst = INFINITY;
  if (!arguments.out.empty())
    std::filesystem::create_directories(arguments.out);
  for (const rgbd::Keyframe& view : held_out)
  {
    const geometry::PinholeCamera camera = colorCamera(view.frame.camera, offset_px);
    const mesh::MeshView drawn =
        mesh::renderTexturedMesh(result.textured, camera, view.T_session_camera.inverse(), SAMPLES_PER_SIDE);
    cv::Mat mask;  // without the pinholes that missing depth leaves
    cv::morphologyEx(view.frame.object_mask, mask, cv::MORPH_CLOSE, cv::Mat::ones(5, 5, CV_8UC1));
    mask &= drawn.triangle_id >= 0;
    std::optional<mesh::MeshView> true_view;
    if (truth)
    {
      true_view = truth->render(view.frame.camera, view.frame.stamp_s);
      mask &= true_view->triangle_id >= 0;
    }
    cv::erode(mask, mask, cv::Mat::ones(2 * RIM_PX + 1, 2 * RIM_PX + 1, CV_8UC1));
    cv::Mat fitted, lit_truth;
    const double image_dB = psnrAfterFit_dB(drawn.color_bgr, view.frame.color_bgr, mask, false, &fitted);
    image_sum += image_dB;
    image_worst = std::min(image_worst, image_dB);
    if (truth)
    {
      // Any picture fits one colour.
      const double truth_dB = truth->plain() ? NAN : psnrAfterFit_dB(drawn.color_bgr, true_view->color_bgr, mask, true);
      const double lit_dB =
          psnrUnderLight_dB(drawn.color_bgr, true_view->color_bgr, normalsOf(drawn, model.mesh), mask, &lit_truth);
      lit_sum += lit_dB;
      lit_worst = std::min(lit_worst, lit_dB);
      truth_sum += truth_dB;
      truth_worst = std::min(truth_worst, truth_dB);
    }
    if (!arguments.out.empty())
    {
      const cv::Rect box = cv::boundingRect(mask);
      std::vector<cv::Mat> row{ cutOut(view.frame.color_bgr, mask, box), cutOut(fitted, mask, box) };
      if (truth)
      {
        row.push_back(cutOut(lit_truth, mask, box));
        row.push_back(cutOut(true_view->color_bgr, mask, box));
      }
      cv::Mat sheet;
      cv::hconcat(row, sheet);
      cv::imwrite(arguments.out + "/view_" + std::to_string(view.id) + ".png", sheet);
    }
  }
  if (!arguments.out.empty())
  {
    mesh::writeTexturedMesh(arguments.out + "/textured.obj", result.textured);
    cv::imwrite(arguments.out + "/seen.png", result.textured.seen);
    cv::imwrite(arguments.out + "/sides.png", mesh::renderFourSides(result.textured, 600));
  }
  const auto count = static_cast<double>(held_out.size());
  std::printf(
      "%-60s %3zu used %2zu held out  image %.2f dB (worst %.2f)  truth %.2f dB (worst %.2f)  lit %.2f dB (worst %.2f) "
      " %.2f s  seen %.3f  "
      "%zu charts  atlas %dx%d  seam %.2f -> %.2f  offset %.2f %.2f px\n",
      recording.c_str(), used.size(), held_out.size(), image_sum / count, image_worst, truth_sum / count, truth_worst,
      lit_sum / count, lit_worst, texture_s, result.seen_ratio, result.chart_count, result.textured.texture_bgr.cols,
      result.textured.texture_bgr.rows, result.seam_step_before, result.seam_step_after, offset_px.x(), offset_px.y());
}
}  // namespace

int main(int argc, char** argv)
{
  google::InitGoogleLogging(argv[0]);
  Arguments arguments;
  CLI::App app("Quality of the texture at keyframes that it was not made from");
  app.add_option("recordings", arguments.recordings, "TUM-style folders")->required();
  app.add_option("--truth", arguments.truth,
                 "True textured mesh (.obj); the recordings then need groundtruth.txt and "
                 "objects.yaml");
  app.add_option("--object", arguments.object, "Index of the object in objects.yaml")->capture_default_str();
  app.add_option("--store", arguments.store, "Keep the sessions here (SQLite), and take those that are there");
  app.add_option("--hold-out", arguments.hold_out, "Every n-th keyframe is not used")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  app.add_option("--resolution", arguments.resolution_mm, "Of points and mesh, mm")->capture_default_str();
  app.add_option("--view-preference", arguments.texture.view_preference, "Of TextureOptions")->capture_default_str();
  app.add_option("--outlier-tolerance", arguments.texture.outlier_tolerance, "Of TextureOptions")
      ->capture_default_str();
  app.add_option("--texel-size", arguments.texture.texel_size_m, "m")->capture_default_str();
  app.add_flag("!--no-color-offset", arguments.color_offset, "Take colours where depth is");
  app.add_option("--out", arguments.out, "Folder for pictures: image, model, truth lit as the model, truth");
  CLI11_PARSE(app, argc, argv);
  try
  {
    for (const std::string& recording : arguments.recordings)
      measure(recording, arguments);
  }
  catch (const std::exception& error)
  {
    std::cerr << "benchmark_texture: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
