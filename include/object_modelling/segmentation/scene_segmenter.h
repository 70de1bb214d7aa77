#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/base/status.h"
#include "object_modelling/geometry/oriented_box.h"
#include "object_modelling/geometry/plane.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::segmentation
{
struct SceneSegmenterOptions
{
  double plane_angle_rad = 0.17453293;  ///< 10 deg: normals of one plane agree within this
  double plane_distance_sigmas = 3.0;   ///< points of a plane lie within so many axial sigmas of it
  double min_plane_ratio = 0.02;        ///< of the pixels with depth; smaller ones are no support
  double min_height_m = 0.003;          ///< above the support plane, plus the noise: what is lower is the table
  double height_noise_sigmas = 2.0;     ///< the noise meant by min_height_m: axial sigmas along the plane's normal
  double max_height_m = 0.6;
  double max_distance_m = 2.0;              ///< hypotheses further from the camera are background
  double cluster_depth_step_ratio = 0.015;  ///< neighbours closer than this share of depth are connected
  int min_cluster_px = 300;                 ///< at 640x480; scaled with the image's area
  std::vector<std::string> violations() const;
};

/// A possible object: a connected set of pixels that stands on, or hangs over, the support plane.
struct Hypothesis
{
  int id = -1;   ///< index in SceneSegmentation::hypotheses; stable ids: ObjectMaskPropagator
  cv::Mat mask;  ///< CV_8UC1, 255 inside
  int pixel_count = 0;
  Eigen::Vector3d centroid_camera = Eigen::Vector3d::Zero();
  geometry::OrientedBox box_camera;  ///< standing on the support plane; T_frame_box is T_camera_box
};

struct SupportedPlane
{
  geometry::Plane plane_camera;  ///< normal towards the camera
  int pixel_count = 0;
  cv::Mat mask;  ///< CV_8UC1
};

struct SceneSegmentation
{
  base::Status status;                 ///< NO_RESULT: no plane, or no hypothesis; the message says which
  std::vector<SupportedPlane> planes;  ///< largest first
  int support_plane = -1;  ///< index into planes: the largest that objects can rest on below the view's centre; -1 none
  std::vector<Hypothesis> hypotheses;  ///< most pixels first
};

/// Multi-plane extraction by region growing on organised normals, then smooth clustering of what stands above the
/// support plane (Aldoma et al. 2015, section 3.2). Stateless; one object may serve several threads.
class SceneSegmenter
{
public:
  explicit SceneSegmenter(const SceneSegmenterOptions& options = {});
  SceneSegmentation segment(const rgbd::Frame& frame) const;

private:
  SceneSegmenterOptions options_;
};

/// Ways of choosing; each gives an index into `hypotheses`, or NO_RESULT with the reason.
base::Result<int> selectByPixel(const SceneSegmentation& segmentation, int u, int v);
/// Hypothesis whose box (grown by `margin_m`) contains the point, or the one nearest to it within the margin.
base::Result<int> selectByPoint(const SceneSegmentation& segmentation, const Eigen::Vector3d& p_camera,
                                double margin_m = 0.02);
/// How clearly a hypothesis is the object that a camera is pointed at: large, near the image centre, not cut off by the
/// image border. Comparable between views of one camera.
double clearness(const Hypothesis& hypothesis, const geometry::PinholeCamera& camera);
/// For unattended use: the largest cluster nearest to the image centre on the support plane, by clearness().
base::Result<int> selectAutomatically(const SceneSegmentation& segmentation, const geometry::PinholeCamera& camera);

}  // namespace object_modelling::segmentation
