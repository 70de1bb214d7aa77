// Time per keyframe of the store: benchmark_keyframe_store <folder of PNG colour images> <store connection>
#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "store_fixtures.h"

namespace
{
using namespace object_modelling;

struct Timing
{
  double wall_ms, cpu_ms;  ///< CPU of all threads: what remains comparable on a busy machine
};

Timing timed(const std::function<void()>& call)
{
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu_start = std::clock();
  call();
  return { std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count(),
           1000.0 * static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC };
}

void print(const std::string& name, const std::vector<Timing>& timings)
{
  std::vector<double> wall_ms, cpu_ms;
  for (const Timing& timing : timings)
  {
    wall_ms.push_back(timing.wall_ms);
    cpu_ms.push_back(timing.cpu_ms);
  }
  std::sort(wall_ms.begin(), wall_ms.end());
  std::sort(cpu_ms.begin(), cpu_ms.end());
  std::cout << name << ": median " << wall_ms[wall_ms.size() / 2] << " ms, p95 " << wall_ms[wall_ms.size() * 95 / 100]
            << " ms, CPU median " << cpu_ms[cpu_ms.size() / 2] << " ms, n " << timings.size() << "\n";
}
}  // namespace

int main(int argc, char** argv)
{
  if (argc != 3)
    return 2;
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
    paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  const auto store = keyframes::openSqlStore(argv[2]);
  store->createSession(keyframes::makeSession("benchmark"));
  std::vector<Timing> add, read;
  std::vector<keyframes::PoseUpdate> poses;
  const int count = std::min<int>(100, static_cast<int>(paths.size()));
  for (int id = 0; id < count; ++id)
  {
    const cv::Mat color = cv::imread(paths[id], cv::IMREAD_COLOR);
    rgbd::Keyframe keyframe = keyframes::makeKeyframe(id, color.cols, color.rows);
    keyframe.frame.color_bgr = color;
    std::string depth_path = paths[id];
    depth_path.replace(depth_path.rfind("rgb"), 3, "depth");
    const cv::Mat depth = cv::imread(depth_path, cv::IMREAD_UNCHANGED);
    if (!depth.empty())
      depth.convertTo(keyframe.frame.depth_m, CV_32FC1, 1.0 / 5000);
    keyframe.observations.resize(1000);
    add.push_back(timed([&] { store->addKeyframe("benchmark", keyframe); }));
    poses.push_back({ id, keyframe.T_session_camera, keyframe.covariance });
  }
  for (int id = 0; id < count; ++id)
    read.push_back(timed([&] { store->keyframe("benchmark", id); }));
  print("addKeyframe", add);
  print("keyframe", read);
  print("poses of all", { timed([&] { store->update("benchmark", SessionChange::ofPoses(poses)); }) });
  print("listSessions", { timed([&] { store->listSessions(); }) });
  print("exportSession", { timed([&] { store->exportSession("benchmark", "/tmp/benchmark.session"); }) });
  std::filesystem::remove("/tmp/benchmark.session");
  print("deleteSession", { timed([&] { store->deleteSession("benchmark"); }) });
}
