#include "wall_view.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/linear_systems.h"
#include "object_modelling/segmentation/scene_segmenter.h"

namespace object_modelling::calibration
{
namespace
{
constexpr int BLOCK_PX = 32;
constexpr int RIM_PX = 5;  ///< whose depth may be of what is behind
constexpr double MIN_BLOCK_RATIO = 0.6;
constexpr double MAX_OUTLIER_RATIO = 0.05;
constexpr double CLIP_SIGMAS = 3.5;
constexpr double MAX_THETA_RAD = 1.45;

struct Pixel
{
  int u = 0, v = 0;
  double x = 0, y = 0, z_m = 0;
};

base::Status unusable(const char* reason)
{
  return { base::StatusCode::NO_RESULT, reason };
}

Pixel pixelAt(const rgbd::Frame& frame, int u, int v)
{
  return { u, v, (u - frame.camera.cx) / frame.camera.fx, (v - frame.camera.cy) / frame.camera.fy,
           frame.depthAt_m(u, v) };
}

cv::Mat square(int size_px)
{
  return cv::getStructuringElement(cv::MORPH_RECT, { size_px, size_px });
}

/// Least squares on the relative error of inverse depth, pixels beyond the clip left out and taken in again as the
/// plane settles.
bool fitInversePlane(const std::vector<Pixel>& pixels, WallView* view)
{
  std::vector<double> sizes_m(pixels.size());
  for (int iteration = 0; iteration < 6; ++iteration)
  {
    for (std::size_t i = 0; i < pixels.size(); ++i)
      sizes_m[i] = std::abs(pixels[i].z_m - view->depthAt_m(pixels[i].x, pixels[i].y));
    view->noise_m = 1.4826 * base::median(&sizes_m);
    const double gate_m = CLIP_SIGMAS * view->noise_m;
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const Pixel& pixel : pixels)
    {
      if (std::abs(pixel.z_m - view->depthAt_m(pixel.x, pixel.y)) > gate_m)
        continue;
      const Eigen::Vector3d row = pixel.z_m * Eigen::Vector3d(pixel.x, pixel.y, 1);
      A += row * row.transpose();
      b += row;
    }
    const Eigen::LDLT<Eigen::Matrix3d> ldlt(A);
    if (ldlt.info() != Eigen::Success || !(ldlt.rcond() > 1e-12))
      return false;
    view->inverse_plane = ldlt.solve(b);
  }
  return view->inverse_plane.allFinite();
}

/// Residuals about a plane of the block's own: their standard deviation, and the plane's value at the block's centre.
bool measureBlock(const std::vector<Pixel>& pixels, const WallView& view, double u_px, double v_px, WallBlock* block)
{
  std::vector<Eigen::Vector3d> rows;
  std::vector<double> residuals_m;
  for (const Pixel& pixel : pixels)
  {
    rows.emplace_back((pixel.u - u_px) / BLOCK_PX, (pixel.v - v_px) / BLOCK_PX, 1);
    residuals_m.push_back(pixel.z_m - view.depthAt_m(pixel.x, pixel.y));
  }
  Eigen::Vector3d local = Eigen::Vector3d::Zero();
  double sigma_m = 2 * view.noise_m;
  int inliers = 0;
  for (int iteration = 0; iteration < 5; ++iteration)
  {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double sum = 0;
    inliers = 0;
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      const double error_m = residuals_m[i] - rows[i].dot(local);
      if (std::abs(error_m) > CLIP_SIGMAS * sigma_m)
        continue;
      A += rows[i] * rows[i].transpose();
      b += rows[i] * residuals_m[i];
      sum += error_m * error_m;
      ++inliers;
    }
    if (inliers < 10)
      return false;
    if (iteration > 0)
      sigma_m = std::sqrt(sum / (inliers - 3));
    local = geometry::solveSymmetric(A, b);
  }
  block->sigma_m = sigma_m;
  block->offset_ratio = local[2] / block->z_m;
  return sigma_m > 0 && inliers >= (1 - MAX_OUTLIER_RATIO) * static_cast<double>(rows.size());
}

void measureBlocks(const rgbd::Frame& frame, const cv::Mat& interior, WallView* view)
{
  std::vector<Pixel> pixels;
  for (int top = 0; top + BLOCK_PX <= interior.rows; top += BLOCK_PX)
    for (int left = 0; left + BLOCK_PX <= interior.cols; left += BLOCK_PX)
    {
      if (cv::countNonZero(interior({ left, top, BLOCK_PX, BLOCK_PX })) < BLOCK_PX * BLOCK_PX)
        continue;
      pixels.clear();
      for (int v = top; v < top + BLOCK_PX; ++v)
        for (int u = left; u < left + BLOCK_PX; ++u)
          if (frame.depthAt_m(u, v) > 0)
            pixels.push_back(pixelAt(frame, u, v));
      if (pixels.size() < MIN_BLOCK_RATIO * BLOCK_PX * BLOCK_PX)
        continue;
      WallBlock block;
      block.u_px = left + 0.5 * (BLOCK_PX - 1);
      block.v_px = top + 0.5 * (BLOCK_PX - 1);
      const double x = (block.u_px - frame.camera.cx) / frame.camera.fx;
      const double y = (block.v_px - frame.camera.cy) / frame.camera.fy;
      block.z_m = view->depthAt_m(x, y);
      block.theta_rad = view->theta_rad(x, y);
      if (block.theta_rad < MAX_THETA_RAD && measureBlock(pixels, *view, block.u_px, block.v_px, &block))
        view->blocks.push_back(block);
    }
}

}  // namespace

double WallView::theta_rad(double x, double y) const
{
  const Eigen::Vector3d ray(x, y, 1);
  return std::acos(std::min(1.0, std::abs(inverse_plane.dot(ray)) / (inverse_plane.norm() * ray.norm())));
}

base::Result<WallView> viewWall(const rgbd::Frame& frame, double min_wall_ratio)
{
  base::Result<WallView> result;
  const segmentation::SceneSegmentation scene = segmentation::SceneSegmenter().segment(frame);
  if (scene.planes.empty())
  {
    result.status = unusable("no plane in view");
    return result;
  }
  const segmentation::SupportedPlane& largest = scene.planes.front();
  const int with_depth = cv::countNonZero(frame.depth_m > 0);
  if (largest.pixel_count < min_wall_ratio * with_depth)
  {
    result.status = unusable("no dominant plane: too much else in view");
    return result;
  }
  WallView& view = result.value;
  view.stamp_s = frame.stamp_s;
  view.inverse_plane = -largest.plane_camera.normal / largest.plane_camera.offset_m;
  // Readings beyond the segmentation's gate belong to the noise: their holes are closed.
  cv::morphologyEx(largest.mask, view.region, cv::MORPH_CLOSE, square(2 * RIM_PX + 1));
  cv::Mat interior;
  cv::erode(view.region, interior, square(2 * RIM_PX + 1), { -1, -1 }, 1, cv::BORDER_CONSTANT, cv::Scalar(255));

  std::vector<Pixel> pixels;
  for (int v = 0; v < interior.rows; v += 2)
    for (int u = 0; u < interior.cols; u += 2)
      if (interior.at<std::uint8_t>(v, u) != 0 && frame.depthAt_m(u, v) > 0)
        pixels.push_back(pixelAt(frame, u, v));
  if (pixels.size() < BLOCK_PX * BLOCK_PX || !fitInversePlane(pixels, &view))
  {
    result.status = unusable("too little of the wall has depth");
    return result;
  }
  measureBlocks(frame, interior, &view);
  if (view.blocks.empty())
    result.status = unusable("nowhere flat over 32 x 32 px");
  return result;
}

}  // namespace object_modelling::calibration
