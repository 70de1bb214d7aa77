#include <benchmark/benchmark.h>

#include "object_modelling/rgbd/depth_edges.h"
#include "object_modelling/rgbd/depth_units.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/rgbd/normals.h"
#include "object_modelling/rgbd/observation_weight.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

// One 640x480 view of a table with objects, with a Kinect's noise, on one core.

namespace object_modelling
{
namespace
{
test_support::SyntheticScene scene()
{
  test_support::SyntheticScene result = test_support::boxOnTable();
  result.objects.push_back(test_support::standingCylinder(0.08, 0.15, 0.2, 0.1));
  result.objects.push_back(test_support::standingSphere(0.1, -0.1, 0.2));
  return result;
}

const Eigen::Isometry3d& viewpoint()
{
  static const Eigen::Isometry3d T_world_camera = test_support::orbitPose({ 0, 0, 0.08 }, 0.7, 0.8, 0.6);
  return T_world_camera;
}

const rgbd::Frame& frame()
{
  static const rgbd::Frame result = []
  {
    test_support::SensorNoise noise;
    noise.depth_sigma_scale = 1;
    noise.depth_quantum_m = 0.001;
    noise.missing_edge_px = 1;
    noise.missing_ratio = 0.002;
    return test_support::renderFrame(scene(), test_support::vgaCamera(), viewpoint(), noise);
  }();
  return result;
}

rgbd::RawFrame rawFrame()
{
  rgbd::RawFrame raw;
  raw.color = frame().color_bgr;
  raw.depth = rgbd::depthAs16Bit(frame().depth_m, 0.001);
  raw.camera = frame().camera;
  return raw;
}

void buildFrame(benchmark::State& state)
{
  rgbd::FrameBuilderOptions options;
  if (state.range(1) != 0)
    options.noise_model.color_offset_x_px = 0.3;
  if (state.range(2) != 0)
    options.noise_model.depth_distortion_ratio[3] = 0.001;
  rgbd::FrameBuilder builder(options);
  rgbd::RawFrame raw = rawFrame();
  if (state.range(0) != 0)
    raw.camera.distortion = { 0.2624, -0.9531, -0.0054, 0.0026, 1.1633 };
  for (auto _ : state)
    benchmark::DoNotOptimize(builder.build(raw));
}
BENCHMARK(buildFrame)
    ->ArgNames({ "distorted", "color_offset", "depth_distortion" })
    ->Args({ 0, 0, 0 })
    ->Args({ 0, 1, 0 })
    ->Args({ 0, 0, 1 })
    ->Args({ 1, 0, 0 })
    ->Unit(benchmark::kMillisecond);

void depthInMeters(benchmark::State& state)
{
  const cv::Mat depth = rawFrame().depth;
  for (auto _ : state)
    benchmark::DoNotOptimize(rgbd::depthInMeters(depth, 0.001));
}
BENCHMARK(depthInMeters)->Unit(benchmark::kMillisecond);

void computeNormals(benchmark::State& state)
{
  rgbd::NormalOptions options;
  options.radius_px = static_cast<int>(state.range(0));
  for (auto _ : state)
    benchmark::DoNotOptimize(rgbd::computeNormals(frame(), options));
}
BENCHMARK(computeNormals)->ArgName("radius_px")->Arg(2)->Arg(4)->Arg(8)->Unit(benchmark::kMillisecond);

void findDepthEdges(benchmark::State& state)
{
  for (auto _ : state)
    benchmark::DoNotOptimize(rgbd::findDepthEdges(frame()));
}
BENCHMARK(findDepthEdges)->Unit(benchmark::kMillisecond);

void distanceToEdges(benchmark::State& state)
{
  const cv::Mat edges = rgbd::findDepthEdges(frame());
  for (auto _ : state)
    benchmark::DoNotOptimize(rgbd::distanceToEdges_px(edges));
}
BENCHMARK(distanceToEdges)->Unit(benchmark::kMillisecond);

void observationWeights(benchmark::State& state)
{
  const cv::Mat normals = rgbd::computeNormals(frame());
  const cv::Mat distance_px = rgbd::distanceToEdges_px(rgbd::findDepthEdges(frame()));
  for (auto _ : state)
    benchmark::DoNotOptimize(rgbd::observationWeights(frame(), normals, distance_px));
}
BENCHMARK(observationWeights)->Unit(benchmark::kMillisecond);

void renderSyntheticFrame(benchmark::State& state)
{
  for (auto _ : state)
    benchmark::DoNotOptimize(test_support::renderFrame(scene(), test_support::vgaCamera(), viewpoint()));
}
BENCHMARK(renderSyntheticFrame)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace object_modelling

int main(int argc, char** argv)
{
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
