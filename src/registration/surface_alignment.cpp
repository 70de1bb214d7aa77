#include "object_modelling/registration/surface_alignment.h"

#include <opencv2/imgproc.hpp>

#include "object_modelling/registration/dense_alignment.h"
#include "object_modelling/registration/dense_quality.h"

namespace object_modelling::registration
{
namespace
{
constexpr int PYRAMID_LEVELS = 4;  // as the tracker's pyramids

std::vector<cv::Mat> grayLevels(const cv::Mat& gray)
{
  std::vector<cv::Mat> levels;
  cv::buildPyramid(gray, levels, PYRAMID_LEVELS);
  return levels;
}
}  // namespace

struct SurfaceView::Data
{
  explicit Data(const rgbd::Frame& frame) : pyramid(frame, grayLevels(frame.gray)), reference(pyramid) {}
  DensePyramid pyramid;
  DenseReference reference;
};

struct SurfaceAccess
{
  static const SurfaceView::Data& data(const SurfaceView& view) { return *view.data_; }
};

SurfaceView::SurfaceView(const rgbd::Frame& frame) : data_(std::make_unique<Data>(frame))
{
}
SurfaceView::~SurfaceView() = default;
SurfaceView::SurfaceView(SurfaceView&&) noexcept = default;
SurfaceView& SurfaceView::operator=(SurfaceView&&) noexcept = default;

std::optional<SurfaceAlignment> alignFrames(const SurfaceView& a, const SurfaceView& b,
                                            const Eigen::Isometry3d& T_a_b_start, SurfaceStart start)
{
  DenseAlignmentOptions options;
  if (start == SurfaceStart::NEAR)
    options.coarsest_level = 0;
  // b is the reference with the session frame in its camera, so that a's T_camera_world is T_a_b.
  const DenseAlignment aligned =
      alignDense(SurfaceAccess::data(b).reference, Eigen::Isometry3d::Identity(), SurfaceAccess::data(a).pyramid,
                 T_a_b_start.inverse(), geometry::Matrix6d::Zero(), options);
  if (!convincing(aligned.term))
    return std::nullopt;
  return SurfaceAlignment{ aligned.T_world_camera.inverse(), aligned.term.equations.A, aligned.term.overlap };
}

}  // namespace object_modelling::registration
