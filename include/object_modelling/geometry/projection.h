#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "object_modelling/geometry/pinhole_camera.h"

namespace object_modelling::geometry
{
/// Where a point falls in a rectified image.
template <typename Scalar>
struct Projection
{
  bool inside = false;        ///< in front of the camera and within the image
  Scalar u_px = 0, v_px = 0;  ///< of points in front of the camera, within the image or not
  Scalar z_m = 0;             ///< the same
  int column = 0, row = 0;    ///< nearest pixel, of points inside

  Eigen::Matrix<Scalar, 2, 1> pixel() const { return { u_px, v_px }; }
};

/// PinholeCamera::project in the precision of the point.
template <typename Scalar>
Eigen::Matrix<Scalar, 2, 1> pixelOf(const PinholeCamera& camera, const Eigen::Matrix<Scalar, 3, 1>& p_camera)
{
  return { static_cast<Scalar>(camera.fx) * p_camera.x() / p_camera.z() + static_cast<Scalar>(camera.cx),
           static_cast<Scalar>(camera.fy) * p_camera.y() / p_camera.z() + static_cast<Scalar>(camera.cy) };
}

/// Inside is what is `border_px` or more within the centres of the outermost pixels; -0.5, the least, is the rim of the
/// image. Half a pixel rounds to the even one.
template <typename Scalar>
Projection<Scalar> projectionOf(const PinholeCamera& camera, const Eigen::Matrix<Scalar, 3, 1>& p_camera,
                                double border_px = -0.5)
{
  Projection<Scalar> at;
  if (!(p_camera.z() > 0))
    return at;
  const Eigen::Matrix<Scalar, 2, 1> pixel = pixelOf(camera, p_camera);
  at.u_px = pixel.x();
  at.v_px = pixel.y();
  at.z_m = p_camera.z();
  if (!camera.contains(pixel.template cast<double>(), border_px))
    return at;
  at.column = cvRound(at.u_px);
  at.row = cvRound(at.v_px);
  at.inside = at.column < camera.width && at.row < camera.height;  // the rim may round to beyond
  return at;
}

}  // namespace object_modelling::geometry
