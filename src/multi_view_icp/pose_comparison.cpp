#include "object_modelling/multi_view_icp/pose_comparison.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/image_sampling.h"
#include "object_modelling/geometry/projection.h"

namespace object_modelling::multi_view_icp
{
namespace
{
constexpr double LOSS_SIGMAS = 2.4;        // beyond, differences count robustly (Cauchy)
constexpr double GRAY_SIGMA = 8;           // grey levels: noise, and what another direction does
constexpr double MAX_OFF_SIGMAS = 12;      // at the best of the poses: beyond, another surface is in front
constexpr double SLANT = 1.5;              // what slanted surfaces and the grid of pixels add to the noise of depth
constexpr int MAX_DRAWS = 20;              // for a sample with depth
constexpr std::size_t MAX_PARTNERS = 100;  // of a view, evenly over the others: time grows with their product
constexpr std::size_t FIRST = 64;          // samples that decide whether two views may be a pair

struct Sample
{
  Eigen::Vector3d p_camera;
  Eigen::Vector2d pixel;
};

/// What one sample meets in another view.
struct SampleResidual
{
  bool seen = false;
  double depth_sigmas = 0, gray = 0;
};

double robust(double sigmas)
{
  return std::log1p(std::pow(sigmas / LOSS_SIGMAS, 2));
}

/// Grey level of what the depth image has at a pixel; false near the rim.
bool grayAt(const rgbd::Frame& frame, const Eigen::Vector2d& pixel, const Eigen::Vector2d& color_offset_px,
            double* gray)
{
  const Eigen::Vector2f shifted = (pixel + color_offset_px).cast<float>();
  float value = 0;
  Eigen::Vector2f gradient;
  if (!geometry::sampleGray(frame.gray, shifted.x(), shifted.y(), &value, &gradient))
    return false;
  *gray = value;
  return true;
}

bool usable(const rgbd::Frame& frame, int u, int v, bool object_only)
{
  return u >= 1 && v >= 1 && u < frame.depth_m.cols - 1 && v < frame.depth_m.rows - 1 && frame.depthAt_m(u, v) > 0 &&
         (!object_only || (!frame.object_mask.empty() && frame.object_mask.at<std::uint8_t>(v, u) != 0));
}

std::vector<Sample> samplesOf(const rgbd::Frame& frame, const PoseComparisonOptions& options, std::mt19937_64* random)
{
  std::vector<Sample> samples;
  if (frame.depth_m.empty() || frame.gray.empty())
    return samples;
  const int draws = MAX_DRAWS * options.samples_per_keyframe;
  for (int i = 0; i < draws && static_cast<int>(samples.size()) < options.samples_per_keyframe; ++i)
  {
    // Not std::uniform_int_distribution, which is another one in every library.
    const auto u = static_cast<int>((*random)() % frame.depth_m.cols);
    const auto v = static_cast<int>((*random)() % frame.depth_m.rows);
    if (usable(frame, u, v, options.object_only))
      samples.push_back({ frame.point(u, v).cast<double>(), { u, v } });
  }
  return samples;
}

/// Depth and grey level of a sample of `frame` against those of `other`.
SampleResidual residualOf(const Sample& sample, const rgbd::Frame& frame, const rgbd::Frame& other,
                          const Eigen::Isometry3d& T_other_camera, const Eigen::Vector2d& color_offset_px,
                          bool object_only)
{
  SampleResidual residual;
  const Eigen::Vector3d q = T_other_camera * sample.p_camera;
  const geometry::Projection<double> at = geometry::projectionOf(other.camera, q, 1);
  double here = 0, there = 0;
  if (!at.inside || !usable(other, at.column, at.row, object_only) ||
      !grayAt(frame, sample.pixel, color_offset_px, &here) || !grayAt(other, at.pixel(), color_offset_px, &there))
    return residual;
  residual.seen = true;
  residual.depth_sigmas =
      (at.z_m - other.depthAt_m(at.column, at.row)) / (SLANT * M_SQRT2 * other.noise_model.axialSigma_m(at.z_m, 0));
  residual.gray = here - there;
  return residual;
}

/// Adds to the score of each set the residuals of the samples of view i in view j.
void addPair(const std::vector<rgbd::View>& views, std::size_t i, std::size_t j, const std::vector<Sample>& samples,
             const std::vector<PoseSet>& sets, const PoseComparisonOptions& options, std::vector<PoseScore>* scores)
{
  std::vector<Eigen::Isometry3d> T_j_i;
  for (const PoseSet& set : sets)
    T_j_i.push_back(set.T_world_camera.at(j).inverse() * set.T_world_camera.at(i));
  std::vector<std::vector<SampleResidual>> residuals(sets.size());  // of samples that all sets see there
  std::vector<SampleResidual> of_sample;
  for (std::size_t n = 0; n < samples.size(); ++n)
  {
    const Sample& sample = samples[n];
    if (n == FIRST && static_cast<double>(residuals.front().size()) < options.min_overlap_ratio / 2 * FIRST)
      return;  // most of many views have nothing in common
    of_sample.clear();
    double nearest_sigmas = MAX_OFF_SIGMAS;
    for (std::size_t k = 0; k < sets.size() && (of_sample.empty() || of_sample.back().seen); ++k)
    {
      of_sample.push_back(
          residualOf(sample, views[i].frame, views[j].frame, T_j_i[k], sets[k].color_offset_px, options.object_only));
      nearest_sigmas = std::min(nearest_sigmas, std::abs(of_sample.back().depth_sigmas));
    }
    if (of_sample.size() < sets.size() || !of_sample.back().seen || nearest_sigmas >= MAX_OFF_SIGMAS)
      continue;
    for (std::size_t k = 0; k < of_sample.size(); ++k)
      residuals[k].push_back(of_sample[k]);
  }
  const std::size_t count = residuals.front().size();
  if (count == 0 || static_cast<double>(count) < options.min_overlap_ratio * static_cast<double>(samples.size()))
    return;
  for (std::size_t k = 0; k < residuals.size(); ++k)
  {
    std::vector<double> grays;
    for (const SampleResidual& residual : residuals[k])
      grays.push_back(residual.gray);
    const double exposure = base::median(&grays);
    double depth = 0, gray = 0;
    for (const SampleResidual& residual : residuals[k])
    {
      depth += robust(residual.depth_sigmas);
      gray += robust((residual.gray - exposure) / GRAY_SIGMA);
    }
    (*scores)[k].depth += depth / static_cast<double>(count);
    (*scores)[k].gray += gray / static_cast<double>(count);
    ++(*scores)[k].pair_count;
  }
}
}  // namespace

std::vector<PoseScore> comparePoses(const std::vector<rgbd::View>& views, const std::vector<PoseSet>& sets,
                                    const PoseComparisonOptions& options, base::JobControl& control)
{
  std::vector<PoseScore> scores(sets.size());
  if (sets.empty())
    return scores;
  std::mt19937_64 random(options.seed);
  const std::size_t step = (views.size() + MAX_PARTNERS - 1) / MAX_PARTNERS;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    control.report("compare poses", i, views.size());
    const std::vector<Sample> samples = samplesOf(views[i].frame, options, &random);
    for (std::size_t j = i % step; j < views.size() && !samples.empty(); j += step)
      if (i != j && !views[j].frame.depth_m.empty() && !views[j].frame.gray.empty())
        addPair(views, i, j, samples, sets, options, &scores);
  }
  for (PoseScore& score : scores)
  {
    score.depth /= std::max(1, score.pair_count);
    score.gray /= std::max(1, score.pair_count);
  }
  return scores;
}

}  // namespace object_modelling::multi_view_icp
