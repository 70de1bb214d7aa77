#include <benchmark/benchmark.h>

#include "object_modelling/segmentation/object_mask_propagator.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

// 640x480 views of a table with three objects, with a Kinect's noise, on one core.

namespace object_modelling
{
namespace
{
const std::vector<rgbd::Keyframe>& keyframes()
{
  static const std::vector<rgbd::Keyframe> result = []
  {
    test_support::SyntheticScene scene = test_support::boxOnTable();
    scene.objects.push_back(test_support::standingCylinder(0.08, 0.15, 0.2, 0.1));
    scene.objects.push_back(test_support::standingSphere(0.1, -0.15, 0.2));
    test_support::SensorNoise noise;
    noise.depth_sigma_scale = 1;
    noise.depth_quantum_m = 0.001;
    std::vector<rgbd::Keyframe> made =
        test_support::renderKeyframes(scene, test_support::vgaCamera(), test_support::orbitPoses(12), noise);
    for (rgbd::Keyframe& keyframe : made)
      keyframe.frame.object_mask = cv::Mat();
    return made;
  }();
  return result;
}

void segment(benchmark::State& state)
{
  const segmentation::SceneSegmenter segmenter;
  const rgbd::Frame& frame = keyframes().front().frame;  // rendered here, not in the loop
  for (auto _ : state)
    benchmark::DoNotOptimize(segmenter.segment(frame));
}
BENCHMARK(segment)->Unit(benchmark::kMillisecond);

void segmentSession(benchmark::State& state)
{
  for (auto _ : state)
    benchmark::DoNotOptimize(segmentation::segmentSession(keyframes(), {}));
  state.counters["keyframes"] = static_cast<double>(keyframes().size());
}
BENCHMARK(segmentSession)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace object_modelling

BENCHMARK_MAIN();
