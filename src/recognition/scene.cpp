#include "scene.h"

#include <opencv2/imgproc.hpp>

#include "lab_color.h"
#include "object_modelling/rgbd/normals.h"
#include "object_modelling/segmentation/scene_segmenter.h"

namespace object_modelling::recognition
{
Scene makeScene(const rgbd::Frame& frame)
{
  Scene scene;
  scene.frame = frame;
  scene.normals = rgbd::computeNormals(frame);
  scene.lab = labOf(frame.color_bgr);
  cv::extractChannel(scene.lab, scene.lightness, 0);
  cv::GaussianBlur(scene.lightness, scene.lightness, {}, 1.2);
  cv::Sobel(scene.lightness, scene.gradient_x, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(scene.lightness, scene.gradient_y, CV_32F, 0, 1, 3, 1.0 / 8);
  scene.segments = cv::Mat(frame.depth_m.size(), CV_32SC1, cv::Scalar(-1));
  const segmentation::SceneSegmentation segmentation = segmentation::SceneSegmenter().segment(frame);
  for (const segmentation::Hypothesis& hypothesis : segmentation.hypotheses)
    scene.segments.setTo(scene.segment_count++, hypothesis.mask);
  if (segmentation.support_plane < 0)
  {
    // Nothing stands on anything: all that has depth is one segment.
    scene.segments.setTo(0, frame.depth_m > 0);
    scene.segment_count = 1;
  }
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
