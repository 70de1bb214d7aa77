#include "prepared_view.h"

#include <limits>

#include <opencv2/imgproc.hpp>

namespace object_modelling::fusion
{
std::vector<PreparedView> prepareViews(const std::vector<rgbd::View>& views)
{
  std::vector<PreparedView> prepared(views.size());
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < static_cast<int>(views.size()); ++i)
  {
    PreparedView& view = prepared[i];
    view.frame = &views[i].frame;
    view.T_camera_world = views[i].T_world_camera.inverse().cast<float>();
    view.p_world_camera = views[i].T_world_camera.translation().cast<float>();
    view.color_offset_px = views[i].color_offset_px.cast<float>();
    cv::Mat depth_m = view.frame->depth_m.clone();
    cv::patchNaNs(depth_m, std::numeric_limits<float>::infinity());
    cv::erode(depth_m, view.nearest_depth_m, cv::Mat::ones(3, 3, CV_8UC1));
  }
  return prepared;
}

bool hasObject(const rgbd::Frame& frame)
{
  return !frame.object_mask.empty() && cv::countNonZero(frame.object_mask) > 0;
}

}  // namespace object_modelling::fusion
