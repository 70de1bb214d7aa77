#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::nodes
{
struct SessionPreviewOptions
{
  double voxel_size_m = 0.004;
  double max_depth_m = 2.0;  ///< farther points are left out
  int max_points = 500000;   ///< of the cloud
  int max_keyframes = 500;   ///< later ones show in the path only
  std::vector<std::string> violations() const;
};

/// Coarse coloured points of one session, for looking at: of the object where keyframes have masks, of everything as
/// long as none has. Free of ROS. Not thread safe.
class SessionPreview
{
public:
  using Color = Eigen::Matrix<std::uint8_t, 3, 1>;  ///< red, green, blue
  struct Cloud
  {
    std::vector<Eigen::Vector3f> points_session;
    std::vector<Color> colors_rgb;
  };
  struct View
  {
    double stamp_s = 0;
    geometry::PinholeCamera camera;
    Eigen::Isometry3d T_session_camera = Eigen::Isometry3d::Identity();
  };

  explicit SessionPreview(const SessionPreviewOptions& options);

  /// Forgets what is shown and begins with another session; an empty id shows nothing.
  void show(const std::string& session_id);
  const std::string& sessionId() const { return session_id_; }

  void add(const rgbd::Keyframe& keyframe);
  void move(const std::vector<keyframes::PoseUpdate>& updates);
  void mask(const std::vector<keyframes::MaskUpdate>& updates);

  /// One point per voxel, the earliest keyframe's.
  Cloud cloud() const;
  /// By ascending keyframe id.
  std::vector<View> views() const;

private:
  struct Sample
  {
    Eigen::Vector3f p_camera;
    Color color_rgb;
    std::int16_t u, v;  ///< px
    bool on_object;
  };
  struct Entry
  {
    View view;
    bool masked = false;
    std::vector<Sample> samples;
  };
  void applyMask(const cv::Mat& object_mask, Entry* entry) const;

  SessionPreviewOptions options_;
  std::string session_id_;
  std::map<int, Entry> entries_;
};

}  // namespace object_modelling::nodes
