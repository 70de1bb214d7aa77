#include "observation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "object_modelling/rgbd/depth_edges.h"
#include "object_modelling/rgbd/normals.h"

namespace object_modelling::fusion
{
namespace
{
constexpr int MARGIN_PX = 12;  ///< round the mask, more than any window of normals and edges

/// The part of a frame round its mask; images are shared.
rgbd::Frame cropToMask(const rgbd::Frame& frame, cv::Rect* roi)
{
  cv::Rect box = cv::boundingRect(frame.object_mask);
  box -= cv::Point(MARGIN_PX, MARGIN_PX);
  box += cv::Size(2 * MARGIN_PX, 2 * MARGIN_PX);
  *roi = box & cv::Rect(0, 0, frame.camera.width, frame.camera.height);
  rgbd::Frame crop;
  crop.depth_m = frame.depth_m(*roi);
  crop.object_mask = frame.object_mask(*roi);
  crop.camera = frame.camera;
  crop.noise_model = frame.noise_model;
  crop.camera.width = roi->width;
  crop.camera.height = roi->height;
  crop.camera.cx -= roi->x;
  crop.camera.cy -= roi->y;
  return crop;
}

/// Mean depth round every pixel, 0 where there is none. The sigma of a reading must not follow its own noise, or
/// readings that are too near by chance weigh more than those that are too far.
cv::Mat smoothed(const cv::Mat& depth_m)
{
  constexpr int WINDOW_PX = 9;
  cv::Mat known = depth_m == depth_m, zero_filled = depth_m.clone(), sum_m, share;
  cv::patchNaNs(zero_filled, 0);
  known.convertTo(known, CV_32F, 1 / 255.0);
  cv::boxFilter(zero_filled, sum_m, CV_32F, { WINDOW_PX, WINDOW_PX });
  cv::boxFilter(known, share, CV_32F, { WINDOW_PX, WINDOW_PX });
  return sum_m / share;
}

}  // namespace

std::vector<Observation> collectObservations(const rgbd::View& view, int index, const CloudFusionOptions& options)
{
  cv::Rect roi;
  rgbd::Frame crop = cropToMask(view.frame, &roi);
  // Depth edges as the sensor saw them; normals of the object alone, or its rim leans towards what it touches.
  cv::Mat edges = rgbd::findDepthEdges(crop);
  cv::Mat object_depth_m(crop.depth_m.size(), CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  crop.depth_m.copyTo(object_depth_m, crop.object_mask);
  crop.depth_m = object_depth_m;
  const cv::Mat normals = rgbd::computeNormals(crop);
  const cv::Mat weights = rgbd::observationWeights(crop, normals, rgbd::distanceToEdges_px(edges), options.weight);

  const rgbd::SensorNoiseModel& noise_model = crop.noise_model;
  const cv::Mat smooth_depth_m = smoothed(crop.depth_m);
  const Eigen::Isometry3f T_world_camera = view.T_world_camera.cast<float>();
  std::vector<Observation> observations;
  for (int v = 0; v < roi.height; ++v)
  {
    for (int u = 0; u < roi.width; ++u)
    {
      const float weight = weights.at<float>(v, u);
      if (!(weight >= static_cast<float>(options.min_weight)))
        continue;
      const Eigen::Vector3f point = crop.point(u, v);
      const cv::Vec3f& n = normals.at<cv::Vec3f>(v, u);
      const Eigen::Vector3f normal(n[0], n[1], n[2]);
      const float cosine = std::min(1.f, std::max(0.f, -normal.dot(point.normalized())));
      const double theta_rad = std::acos(cosine);

      Observation observation;
      observation.point = T_world_camera * point;
      observation.normal = T_world_camera.linear() * normal;
      observation.weight = weight;
      observation.view = index;
      const double z_m = smooth_depth_m.at<float>(v, u);
      observation.axial_sigma_m = static_cast<float>(noise_model.axialSigma_m(z_m, theta_rad));
      observation.lateral_sigma_m = static_cast<float>(noise_model.lateralSigma_m(z_m, theta_rad, crop.camera.fx));
      observation.sigma_m =
          std::hypot(observation.axial_sigma_m * cosine, observation.lateral_sigma_m * std::sqrt(1 - cosine * cosine));
      observations.push_back(observation);
    }
  }
  return observations;
}

}  // namespace object_modelling::fusion
