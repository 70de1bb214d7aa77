#include "support/sensor_simulation.h"

#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "object_modelling/rgbd/depth_edges.h"
#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::test_support
{
namespace
{
constexpr float MISSING = std::numeric_limits<float>::quiet_NaN();

double angleToRay_rad(const cv::Vec3f& n, const Eigen::Vector3d& ray)
{
  const double cosine = -(n[0] * ray.x() + n[1] * ray.y() + n[2] * ray.z()) / ray.norm();
  return std::acos(std::min(1.0, std::max(0.0, cosine)));
}

cv::Mat nearDepthSteps(const rgbd::Frame& frame, int reach_px)
{
  const cv::Mat edges = rgbd::findDepthEdges(frame);
  cv::Mat near;
  cv::compare(rgbd::distanceToEdges_px(edges), reach_px, near, cv::CMP_LE);
  return near;
}

void addDepthNoise(const SensorNoise& noise, SceneImage* image)
{
  cv::RNG random(noise.seed * 0x9e3779b97f4a7c15ULL + 1);
  const geometry::PinholeCamera& camera = image->frame.camera;
  cv::Mat& depth = image->frame.depth_m;
  const cv::Mat near_step =
      noise.missing_edge_px > 0 ? nearDepthSteps(image->frame, noise.missing_edge_px) : cv::Mat::zeros(depth.size(), 0);
  for (int v = 0; v < depth.rows; ++v)
  {
    for (int u = 0; u < depth.cols; ++u)
    {
      auto& z = depth.at<float>(v, u);
      if (!(z > 0))
        continue;
      const double theta = angleToRay_rad(image->normals.at<cv::Vec3f>(v, u), camera.unproject(u, v, 1));
      const bool dropped = noise.missing_ratio > 0 && random.uniform(0.0, 1.0) < noise.missing_ratio;
      if (dropped || near_step.at<std::uint8_t>(v, u) || theta > noise.max_theta_rad)
      {
        z = MISSING;
        continue;
      }
      if (noise.depth_sigma_scale > 0)  // close to 90 deg the model has no bound, a sensor has
        z += static_cast<float>(noise.depth_sigma_scale *
                                random.gaussian(rgbd::SensorNoiseModel().axialSigma_m(z, std::min(theta, 1.4))));
      if (noise.depth_quantum_m > 0)
        z = static_cast<float>(noise.depth_quantum_m * std::round(z / noise.depth_quantum_m));
    }
  }
}

void addColorNoise(const SensorNoise& noise, cv::Mat* color)
{
  cv::RNG random(noise.seed * 0xc2b2ae3d27d4eb4fULL + 2);
  cv::Mat offset(color->size(), CV_16SC3);
  random.fill(offset, cv::RNG::NORMAL, 0, noise.color_sigma);
  cv::add(*color, offset, *color, cv::noArray(), CV_8UC3);
}

}  // namespace

void addSensorNoise(const SensorNoise& noise, SceneImage* image)
{
  const bool depth_noise = noise.depth_sigma_scale > 0 || noise.depth_quantum_m > 0 || noise.missing_edge_px > 0 ||
                           noise.missing_ratio > 0 || noise.max_theta_rad < M_PI / 2;
  if (depth_noise)
    addDepthNoise(noise, image);
  if (noise.color_sigma > 0)
    addColorNoise(noise, &image->frame.color_bgr);
}

}  // namespace object_modelling::test_support
