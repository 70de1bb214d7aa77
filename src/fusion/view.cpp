#include "view.h"

#include <limits>

#include <opencv2/imgproc.hpp>

namespace object_modelling::fusion
{
std::vector<View> prepareViews(const std::vector<rgbd::Keyframe>& keyframes)
{
  std::vector<View> views(keyframes.size());
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < static_cast<int>(keyframes.size()); ++i)
  {
    View& view = views[i];
    view.frame = &keyframes[i].frame;
    view.T_camera_session = keyframes[i].T_session_camera.inverse().cast<float>();
    view.p_session_camera = keyframes[i].T_session_camera.translation().cast<float>();
    cv::Mat depth_m = view.frame->depth_m.clone();
    cv::patchNaNs(depth_m, std::numeric_limits<float>::infinity());
    cv::erode(depth_m, view.nearest_depth_m, cv::Mat::ones(3, 3, CV_8UC1));
  }
  return views;
}

bool hasObject(const rgbd::Frame& frame)
{
  return !frame.object_mask.empty() && cv::countNonZero(frame.object_mask) > 0;
}

}  // namespace object_modelling::fusion
