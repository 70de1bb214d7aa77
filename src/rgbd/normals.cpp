#include "object_modelling/rgbd/normals.h"

#include <limits>

#include "object_modelling/base/options.h"
#include "window_fit.h"

namespace object_modelling::rgbd
{
std::vector<std::string> NormalOptions::violations() const
{
  base::OptionsCheck check("normals");
  check.inRange("radius_px", radius_px, 1, 50);
  check.inRange("max_depth_step_ratio", max_depth_step_ratio, 1e-5, 1.0);
  check.atLeast("min_neighbors", min_neighbors, 3);
  return check.violations();
}

cv::Mat computeNormals(const Frame& frame, const NormalOptions& options)
{
  base::checked(options);
  const PaddedDepth padded(frame.depth_m, options.radius_px);
  const cv::Mat whole = wholeWindows(padded, static_cast<float>(options.max_depth_step_ratio));
  cv::Mat normals(frame.depth_m.size(), CV_32FC3, cv::Scalar::all(std::numeric_limits<float>::quiet_NaN()));
  WholeWindowFit whole_fit(padded, frame.camera);
  const GatedWindowFit gated_fit(padded, frame.camera, options);
  for (int v = 0; v < normals.rows; ++v)
  {
    auto* out = normals.ptr<cv::Vec3f>(v);
    const auto* is_whole = whole.ptr<std::uint8_t>(v);
    whole_fit.row(v, is_whole, out);
    gated_fit.row(v, is_whole, out);
  }
  return normals;
}

}  // namespace object_modelling::rgbd
