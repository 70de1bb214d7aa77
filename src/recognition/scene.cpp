#include "scene.h"

#include <opencv2/imgproc.hpp>

#include "lab_color.h"
#include "object_modelling/rgbd/normals.h"
#include "object_modelling/segmentation/scene_segmenter.h"
#include "object_modelling/segmentation/smooth_clustering.h"

namespace object_modelling::recognition
{
namespace
{
constexpr double BACKGROUND_RATIO = 1.3;    // of the largest object, that a plane of the background exceeds
constexpr double DEPTH_STEP_RATIO = 0.015;  // of depth, that divides clusters
constexpr double MIN_CLUSTER_RATIO = 5e-4;  // of the image
constexpr int PLANE_STEP_PX = 8;

/// Diagonal of the box along the camera's axes.
double extentOf_m(const rgbd::Frame& frame, const cv::Mat& mask)
{
  Eigen::AlignedBox3f box;
  for (int v = 0; v < mask.rows; v += PLANE_STEP_PX)
    for (int u = 0; u < mask.cols; u += PLANE_STEP_PX)
      if (mask.at<std::uint8_t>(v, u) > 0 && frame.point(u, v).allFinite())
        box.extend(frame.point(u, v));
  return box.isEmpty() ? 0 : static_cast<double>(box.diagonal().norm());
}

/// What stands on the support plane, thing by thing, then what is elsewhere: a thing on a shelf, or in a hand.
void addSegments(double largest_object_m, double max_distance_m, Scene* scene)
{
  const rgbd::Frame& frame = scene->frame;
  const segmentation::SceneSegmentation segmentation = segmentation::SceneSegmenter().segment(frame);
  scene->segments = cv::Mat(frame.depth_m.size(), CV_32SC1, cv::Scalar(-1));
  cv::Mat elsewhere = (frame.depth_m > 0) & (frame.depth_m < max_distance_m);
  for (const segmentation::SupportedPlane& plane : segmentation.planes)
    if (extentOf_m(frame, plane.mask) > BACKGROUND_RATIO * largest_object_m)
      elsewhere.setTo(0, plane.mask);
  for (const segmentation::Hypothesis& hypothesis : segmentation.hypotheses)
  {
    scene->segments.setTo(scene->segment_count++, hypothesis.mask);
    elsewhere.setTo(0, hypothesis.mask);
  }
  const auto min_pixels = static_cast<int>(MIN_CLUSTER_RATIO * static_cast<double>(elsewhere.total()));
  const segmentation::Clusters clusters = segmentation::clusterSmooth(frame, elsewhere, DEPTH_STEP_RATIO, min_pixels);
  for (const segmentation::Cluster& cluster : clusters.clusters)
    scene->segments.setTo(scene->segment_count++, clusters.mask(cluster));
}
}  // namespace

Scene makeScene(const rgbd::Frame& frame, double largest_object_m, double max_distance_m)
{
  Scene scene;
  scene.frame = frame;
  scene.normals = rgbd::computeNormals(frame);
  scene.lab = labOf(frame.color_bgr);
  cv::extractChannel(scene.lab, scene.lightness, 0);
  cv::GaussianBlur(scene.lightness, scene.lightness, {}, 1.2);
  cv::Sobel(scene.lightness, scene.gradient_x, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(scene.lightness, scene.gradient_y, CV_32F, 0, 1, 3, 1.0 / 8);
  addSegments(largest_object_m, max_distance_m, &scene);
  return scene;
}

OrientedPoints pointsOf(const Scene& scene, int segment, int step_px)
{
  OrientedPoints result;
  for (int v = 0; v < scene.segments.rows; v += step_px)
    for (int u = 0; u < scene.segments.cols; u += step_px)
    {
      if (scene.segments.at<int>(v, u) != segment)
        continue;
      const Eigen::Vector3f p = scene.frame.point(u, v), n = scene.normal(u, v);
      if (!p.allFinite() || !n.allFinite())
        continue;
      result.points.push_back(p);
      result.normals.push_back(n);
    }
  return result;
}

}  // namespace object_modelling::recognition
