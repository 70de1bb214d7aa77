#pragma once

#include <algorithm>

#include "object_modelling/segmentation/scene_segmenter.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::segmentation
{
/// Half the size of VGA: a quarter of the time for the same geometry.
inline geometry::PinholeCamera smallCamera()
{
  return test_support::vgaCamera().scaled(0.5);
}

inline test_support::SensorNoise kinectNoise(std::uint64_t seed = 1)
{
  test_support::SensorNoise noise;
  noise.depth_sigma_scale = 1;
  noise.depth_quantum_m = 0.001;
  noise.missing_ratio = 0.01;
  noise.seed = seed;
  return noise;
}

/// Intersection over union of two masks, where `depth_m` has depth.
inline double overlap(const cv::Mat& a, const cv::Mat& b, const cv::Mat& depth_m)
{
  const cv::Mat valid = depth_m == depth_m;
  const int either = cv::countNonZero((a | b) & valid);
  return either > 0 ? static_cast<double>(cv::countNonZero(a & b & valid)) / either : 1;
}

/// Best overlap of any hypothesis with the object of that number in the scene.
inline double bestOverlap(const SceneSegmentation& segmentation, const test_support::SceneImage& image, int object)
{
  double best = 0;
  for (const Hypothesis& hypothesis : segmentation.hypotheses)
    best = std::max(best, overlap(hypothesis.mask, image.instances == object + 1, image.frame.depth_m));
  return best;
}

}  // namespace object_modelling::segmentation
