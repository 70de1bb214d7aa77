#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/features/keyframe_features.h"
#include "object_modelling/recognition/pair_features.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::recognition
{
/// What hypotheses are compared with, made once of a frame.
struct Scene
{
  rgbd::Frame frame;
  cv::Mat normals;                            ///< CV_32FC3, optical frame, NaN where unknown
  cv::Mat lab;                                ///< CV_32FC3
  cv::Mat lightness, gradient_x, gradient_y;  ///< CV_32FC1: L smoothed, and its change per pixel
  cv::Mat segments;                           ///< CV_32SC1: smooth cluster that is no background, from 0; -1: none
  int segment_count = 0;

  Eigen::Vector3f normal(int u, int v) const
  {
    const cv::Vec3f& n = normals.at<cv::Vec3f>(v, u);
    return { n[0], n[1], n[2] };
  }
};

/// Background: planes that are larger than the largest object, and what is further than `max_distance_m`.
Scene makeScene(const rgbd::Frame& frame, double largest_object_m, double max_distance_m);

/// Points with normals of a segment; every `step_px`-th pixel.
OrientedPoints pointsOf(const Scene& scene, int segment, int step_px);

/// Axial sigma (m) of the depth at a distance, seen from the front.
inline double sigmaAt(const Scene& scene, double z_m)
{
  return scene.frame.noise_model.axialSigma_m(z_m, 0);
}

}  // namespace object_modelling::recognition
