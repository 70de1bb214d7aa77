// Time and accuracy of fusion and surface on a simulated sphere with the noise of a Kinect:
//   benchmark_fusion [keyframes = 60] [repetitions = 3]

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/surface/surface_reconstruction.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

using namespace object_modelling;

namespace
{
std::vector<rgbd::View> record(const test_support::SyntheticScene& scene, int count)
{
  test_support::SensorNoise noise;
  noise.depth_sigma_scale = 1;
  noise.depth_quantum_m = 0.001;
  noise.missing_edge_px = 1;
  std::vector<Eigen::Isometry3d> poses = test_support::orbitPoses(count - count / 2, { 0, 0, 0.1 }, 0.6, 0.35);
  for (const Eigen::Isometry3d& pose : test_support::orbitPoses(count / 2, { 0, 0, 0.1 }, 0.6, 0.9))
    poses.push_back(pose);
  return test_support::renderViews(scene, test_support::vgaCamera(), poses, noise);
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv)
{
  const int count = argc > 1 ? std::atoi(argv[1]) : 60, repetitions = argc > 2 ? std::atoi(argv[2]) : 3;
  if (count < 2 || repetitions < 1)
  {
    std::fprintf(stderr, "usage: %s [keyframes >= 2] [repetitions >= 1]\n", argv[0]);
    return 1;
  }
  test_support::SyntheticScene scene;
  scene.objects.push_back(test_support::standingSphere(0.2));
  const std::vector<rgbd::View> views = record(scene, count);
  base::JobControl control;
  for (int i = 0; i < repetitions; ++i)
  {
    auto start = std::chrono::steady_clock::now();
    const fusion::CloudFusionResult fused = fusion::fuse(views, {}, control);
    const double fusion_s = secondsSince(start);
    start = std::chrono::steady_clock::now();
    const surface::SurfaceResult surface = surface::reconstructSurface(fused.cloud, std::nullopt, {}, control);
    const double surface_s = secondsSince(start);
    double sum_m = 0;
    for (const Eigen::Vector3f& point : fused.cloud.points)
      sum_m += std::abs(scene.objects[0].signedDistance_m(point.cast<double>()));
    std::printf(
        "%d keyframes, %zu observations: fusion %.2f s, %zu points, mean distance %.3f mm; surface %.2f s, "
        "%zu triangles\n",
        count, fused.observations_used, fusion_s, fused.cloud.size(),
        1000 * sum_m / static_cast<double>(fused.cloud.size()), surface_s, surface.mesh.triangles.size());
  }
  return 0;
}
