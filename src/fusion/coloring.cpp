#include "coloring.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "object_modelling/geometry/image_sampling.h"
#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::fusion
{
namespace
{
constexpr int BEST_VIEWS = 8;             ///< per surfel; more blur the texture
constexpr float MIN_COSINE = 0.05f;       ///< flatter sights count as if they were so flat
constexpr float FULL_RIM_DISTANCE = 4.f;  ///< px from the mask's rim from which on colour has full weight
constexpr int GAIN_ITERATIONS = 3;

struct Sample
{
  int view = -1;
  float weight = 0;
  Eigen::Vector3f rgb = Eigen::Vector3f::Zero();
};

std::vector<Sample> bestSamples(const std::vector<PreparedView>& views, const std::vector<cv::Mat>& rim_distances_px,
                                const Surfel& surfel, double consistency_sigmas)
{
  std::vector<Sample> samples;
  for (int i = 0; i < static_cast<int>(views.size()); ++i)
  {
    const PreparedView& view = views[i];
    if (rim_distances_px[i].empty())
      continue;
    const Eigen::Vector3f to_camera = view.p_world_camera - surfel.point;
    const float cosine = surfel.normal.dot(to_camera) / to_camera.norm();
    if (!(cosine > 0))
      continue;
    const geometry::Projection<float> at = project(view, surfel.point);
    if (!at.inside)
      continue;
    const double tolerance_m =
        consistency_sigmas * std::hypot(surfel.sigma_m, view.frame->noise_model.axialSigma_m(at.z_m, 0));
    const float rim_px = rim_distances_px[i].at<float>(at.row, at.column);
    if (rgbd::visibilityOf(at, view.frame->depth_m, tolerance_m) != rgbd::Visibility::ON || rim_px <= 0)
      continue;
    Sample sample;
    sample.view = i;
    sample.weight =
        std::pow(std::max(cosine, MIN_COSINE), 2.f) / (at.z_m * at.z_m) * std::min(1.f, rim_px / FULL_RIM_DISTANCE);
    sample.rgb =
        geometry::colorAt(view.frame->color_bgr, Eigen::Vector2f(at.u_px, at.v_px) + view.color_offset_px).reverse();
    samples.push_back(sample);
  }
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.weight > b.weight; });
  if (samples.size() > BEST_VIEWS)
    samples.resize(BEST_VIEWS);
  return samples;
}

Eigen::Vector3f mean(const std::vector<Sample>& samples, const std::vector<Eigen::Vector3f>& gains)
{
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float weight = 0;
  for (const Sample& sample : samples)
  {
    sum += sample.weight * gains[sample.view].cwiseProduct(sample.rgb);
    weight += sample.weight;
  }
  return weight > 0 ? Eigen::Vector3f(sum / weight) : Eigen::Vector3f::Zero();
}

/// Gain per view and channel that brings its samples to the mean of all views; their geometric mean stays 1.
std::vector<Eigen::Vector3f> estimateGains(const std::vector<std::vector<Sample>>& samples, std::size_t view_count)
{
  std::vector<Eigen::Vector3f> gains(view_count, Eigen::Vector3f::Ones());
  for (int iteration = 0; iteration < GAIN_ITERATIONS; ++iteration)
  {
    std::vector<Eigen::Vector3d> mean_sum(view_count, Eigen::Vector3d::Zero());
    std::vector<Eigen::Vector3d> own_sum(view_count, Eigen::Vector3d::Zero());
    for (const std::vector<Sample>& of_surfel : samples)
    {
      const Eigen::Vector3f common = mean(of_surfel, gains);
      for (const Sample& sample : of_surfel)
      {
        mean_sum[sample.view] += (sample.weight * common).cast<double>();
        own_sum[sample.view] += (sample.weight * sample.rgb).cast<double>();
      }
    }
    Eigen::Vector3d log_sum = Eigen::Vector3d::Zero();
    int used = 0;
    for (std::size_t i = 0; i < view_count; ++i)
    {
      if (!(mean_sum[i].minCoeff() > 0 && own_sum[i].minCoeff() > 0))
        continue;
      gains[i] = mean_sum[i].cwiseQuotient(own_sum[i]).cast<float>();
      log_sum += gains[i].cast<double>().array().log().matrix();
      ++used;
    }
    if (used == 0)
      break;
    const Eigen::Vector3f common_gain = (log_sum / used).array().exp().matrix().cast<float>();
    for (Eigen::Vector3f& gain : gains)
      gain = gain.cwiseQuotient(common_gain);
  }
  return gains;
}

}  // namespace

std::vector<Eigen::Matrix<std::uint8_t, 3, 1>> colorSurfels(const std::vector<PreparedView>& views,
                                                            const std::vector<Surfel>& surfels,
                                                            double consistency_sigmas)
{
  std::vector<cv::Mat> rim_distances_px(views.size());
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < static_cast<int>(views.size()); ++i)
  {
    if (hasObject(*views[i].frame) && !views[i].frame->color_bgr.empty())
      cv::distanceTransform(views[i].frame->object_mask, rim_distances_px[i], cv::DIST_L2, 3);
  }
  std::vector<std::vector<Sample>> samples(surfels.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(surfels.size()); ++i)
    samples[i] = bestSamples(views, rim_distances_px, surfels[i], consistency_sigmas);

  const std::vector<Eigen::Vector3f> gains = estimateGains(samples, views.size());
  std::vector<Eigen::Matrix<std::uint8_t, 3, 1>> colors(surfels.size());
  for (std::size_t i = 0; i < surfels.size(); ++i)
  {
    const Eigen::Vector3f rgb = mean(samples[i], gains);
    for (int c = 0; c < 3; ++c)
      colors[i][c] = static_cast<std::uint8_t>(std::clamp(rgb[c] + 0.5f, 0.f, 255.f));
  }
  return colors;
}

}  // namespace object_modelling::fusion
