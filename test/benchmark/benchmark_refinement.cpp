// Tracks recordings, refines their keyframes in several ways, and prints accuracy, time and memory as a table.
// benchmark_refinement --help; docs/refinement.md.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include <CLI/CLI.hpp>

#include "benchmark_program.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "refinement_table.h"

namespace
{
using namespace object_modelling;
using namespace object_modelling::benchmark_refinement;

struct Arguments
{
  std::vector<std::string> recordings;
  std::vector<std::string> methods = { "ba", "icp", "ba+icp" };
  std::vector<std::size_t> keyframes;
  std::vector<double> disturbance = { 0, 0 };
  double keyframe_angle_deg = 0;
  bool object_reference = false, from_truth = false;
  MeasureOptions measure;
  std::string store, out, json;
};

/// The last two path components, since "session_1" is not unique.
std::string nameOf(const std::string& recording)
{
  const std::filesystem::path path = std::filesystem::absolute(recording + "/").parent_path().lexically_normal();
  return path.parent_path().filename().string() + "_" + path.filename().string();
}

/// Keyframes of a recording, with masks if only the object counts; kept in the store, if there is one, for next time.
std::vector<rgbd::Keyframe> keyframesOf(const std::string& recording, const Arguments& arguments)
{
  std::unique_ptr<keyframes::SessionStore> store;
  const std::string id = nameOf(recording);
  if (!arguments.store.empty())
  {
    store = keyframes::openSqlStore(arguments.store);
    for (const keyframes::Session& session : store->listSessions())
      if (session.id == id)
        return keyframes::loadKeyframes(*store, id);
  }
  benchmark_tracking::RunOptions options;
  options.object_reference = arguments.object_reference;
  options.seed = arguments.measure.seed;
  options.keep_keyframes = true;
  options.keyframe_angle_rad = arguments.keyframe_angle_deg * M_PI / 180;
  std::vector<rgbd::Keyframe> tracked = benchmark_tracking::trackRecording(recording, options).keyframes;
  if (arguments.measure.object_only && !arguments.object_reference)
  {
    const segmentation::SessionMasks masks = segmentation::segmentSession(tracked, std::nullopt, {});
    if (!masks.status.ok())
      throw base::Error(masks.status.code, "'" + recording + "': " + masks.status.message);
    for (std::size_t k = 0; k < tracked.size(); ++k)
      tracked[k].frame.object_mask = masks.masks[k];
  }
  if (!store)
    return tracked;
  keyframes::Session session;
  session.id = id;
  session.reference_is_object = arguments.object_reference;
  store->createSession(session);
  for (const rgbd::Keyframe& keyframe : tracked)
    store->addKeyframe(id, keyframe);
  return tracked;
}

void writePoses(const std::string& path, const std::vector<rgbd::Keyframe>& keyframes,
                const std::vector<Eigen::Isometry3d>& T_session_camera)
{
  std::vector<source::StampedPose> poses;
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    poses.push_back({ keyframes[k].frame.stamp_s, T_session_camera[k] });
  source::writeTrajectory(path, poses);
}

/// The true poses, as a start, in place of the tracker's; those without a truth keep theirs and are dropped.
void placeByTruth(const std::vector<source::StampedPose>& truth, std::vector<rgbd::Keyframe>* keyframes)
{
  constexpr double TOLERANCE_S = 0.02;
  std::vector<rgbd::Keyframe> placed;
  for (rgbd::Keyframe& keyframe : *keyframes)
  {
    const auto nearest = std::min_element(
        truth.begin(), truth.end(),
        [&](const source::StampedPose& a, const source::StampedPose& b)
        { return std::abs(a.stamp_s - keyframe.frame.stamp_s) < std::abs(b.stamp_s - keyframe.frame.stamp_s); });
    if (nearest == truth.end() || std::abs(nearest->stamp_s - keyframe.frame.stamp_s) > TOLERANCE_S)
      continue;
    keyframe.T_session_camera = nearest->T_map_camera;
    placed.push_back(keyframe);
  }
  *keyframes = std::move(placed);
}

void measureRecording(const std::string& recording, const Arguments& arguments, nlohmann::json* json)
{
  const std::string truth_path = recording + "/groundtruth.txt";
  std::vector<source::StampedPose> truth;
  if (std::filesystem::exists(truth_path))
    truth = source::readTrajectory(truth_path);
  std::vector<rgbd::Keyframe> all = keyframesOf(recording, arguments);
  if (arguments.from_truth)
    placeByTruth(truth, &all);
  std::vector<std::size_t> counts = arguments.keyframes;
  if (counts.empty())
    counts.push_back(all.size());
  for (const std::size_t count : counts)
  {
    std::vector<rgbd::Keyframe> keyframes = evenlyChosen(all, count);
    disturb(1e-3 * arguments.disturbance[0], arguments.disturbance[1] * M_PI / 180, arguments.measure.seed, &keyframes);
    for (const std::string& method : arguments.methods)
    {
      const Measurement measurement = measure(method, keyframes, truth, arguments.measure);
      std::cout << toRow(nameOf(recording), measurement) << std::flush;
      json->push_back(toJson(nameOf(recording), measurement));
      if (!arguments.out.empty())
        writePoses(
            arguments.out + "/" + nameOf(recording) + "_" + std::to_string(keyframes.size()) + "_" + method + ".txt",
            keyframes, measurement.T_session_camera);
    }
  }
}

void run(const Arguments& arguments)
{
  nlohmann::json json = nlohmann::json::array();
  std::cout << tableHeader();
  for (const std::string& recording : arguments.recordings)
    measureRecording(recording, arguments, &json);
  benchmark_program::writeJson(arguments.json, json);
}
}  // namespace

int main(int argc, char** argv)
{
  CLI::App app("Accuracy, time and memory of keyframe refinement on TUM-style recordings.");
  app.footer(
      "Errors are those of the keyframes after rigid alignment with groundtruth.txt, before -> after. A recording "
      "that\n"
      "is in the store already is not tracked again. Exit codes: 1 failed, 2 wrong usage.");
  Arguments arguments;
  multi_view_icp::MultiViewIcpOptions& icp = arguments.measure.icp;
  app.add_option("recordings", arguments.recordings, "TUM-style folders")->required()->check(CLI::ExistingDirectory);
  app.add_option("--methods", arguments.methods, "Steps joined by '+': ba (bundle adjustment), icp (multi-view)")
      ->delimiter(',');
  app.add_option("--keyframes", arguments.keyframes, "So many of the keyframes, evenly; several: one row each")
      ->delimiter(',');
  app.add_option("--keyframe-angle", arguments.keyframe_angle_deg, "Degrees between keyframes, for more or fewer")
      ->check(CLI::PositiveNumber);
  app.add_option("--disturb", arguments.disturbance, "Move every pose but the first: RMS in mm, in degrees")
      ->expected(2);
  app.add_flag("--from-truth", arguments.from_truth, "Start from the true poses, not the tracker's");
  app.add_flag("--object", arguments.object_reference, "Track the object on the masks, not the scene");
  app.add_flag("--object-only", arguments.measure.object_only, "Refine by the object alone, found by segmentation");
  app.add_option("--color-weight", icp.color_weight, "Of multi-view ICP; 0: geometry alone")->capture_default_str();
  app.add_option("--start-error", icp.start_error_m, "Of multi-view ICP, m")->capture_default_str();
  app.add_option("--points", icp.points_per_keyframe, "Of multi-view ICP")->capture_default_str();
  app.add_option("--partners", icp.max_partners, "Of multi-view ICP")->capture_default_str();
  app.add_flag_callback(
      "--nearest", [&] { icp.association = multi_view_icp::IcpAssociation::NEAREST; },
      "Multi-view ICP by nearest points, not along viewing rays");
  app.add_option("--threads", arguments.measure.threads)->capture_default_str()->check(CLI::PositiveNumber);
  app.add_option("--seed", arguments.measure.seed, "Of tracker, bundle adjustment and disturbance");
  app.add_option("--store", arguments.store, "SQLite file that keeps the tracked keyframes for next time");
  app.add_option("--out", arguments.out, "Folder for the refined keyframe poses, TUM format")
      ->check(CLI::ExistingDirectory);
  app.add_option("--json", arguments.json, "Also write all figures to this file");
  return benchmark_program::run(app, argc, argv, [&] { run(arguments); });
}
