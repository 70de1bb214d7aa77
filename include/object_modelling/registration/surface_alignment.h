#pragma once

#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include "object_modelling/geometry/transform.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::registration
{
/// Points, normals and grey levels of one frame for alignFrames(), made once.
class SurfaceView
{
public:
  /// Only pixels of the frame's object mask count, if it has one.
  explicit SurfaceView(const rgbd::Frame& frame);
  ~SurfaceView();
  SurfaceView(SurfaceView&&) noexcept;
  SurfaceView& operator=(SurfaceView&&) noexcept;

private:
  friend struct SurfaceAccess;
  struct Data;
  std::unique_ptr<Data> data_;
};

struct SurfaceAlignment
{
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  /// Inverse covariance of T_a_b, as a motion applied on the left of T_a_b.
  geometry::Matrix6d information = geometry::Matrix6d::Zero();
  double overlap = 0;  ///< share of b's surfaces that a sees
};

enum class SurfaceStart
{
  ROUGH,  ///< several degrees off: coarse to fine
  NEAR    ///< a fraction of a pixel off: the finest images alone
};

/// Aligns two frames by depth and intensity (see the camera tracker). Nothing if the surfaces do not fit; surfaces may
/// fit and yet have slid along each other, so align a with b and b with a, and compare.
std::optional<SurfaceAlignment> alignFrames(const SurfaceView& a, const SurfaceView& b,
                                            const Eigen::Isometry3d& T_a_b_start,
                                            SurfaceStart start = SurfaceStart::ROUGH);

}  // namespace object_modelling::registration
