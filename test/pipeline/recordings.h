#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "object_modelling/keyframes/session_store.h"
#include "object_modelling/source/frame_source.h"
#include "object_modelling/source/trajectory_file.h"
#include "support/synthetic_scene.h"
#include "support/thrown_status.h"

// Small recordings (320x240) of ray-cast scenes, and stores with sessions made from them.
namespace object_modelling::pipeline
{
using test_support::smallCamera;

/// Edges of the box in test_support::boxOnTable(), as an object frame has them: the longer horizontal one is x.
const Eigen::Vector3d BOX_SIZE_M(0.12, 0.08, 0.2);

struct Recording
{
  std::vector<rgbd::Frame> frames;  ///< with masks of the object
  std::vector<Eigen::Isometry3d> T_object_cameras;
};

/// A walk of `turn_rad` round the box, with the noise of a sensor. Rendered once per set of arguments.
const Recording& walkRoundBox(int frame_count, double turn_rad);

/// The camera and the table stand still, the box turns by `turn_rad` about its vertical axis.
Recording turningBox(int frame_count, double turn_rad);
/// The same with a plain box and a printed round table top under it that turns with it.
Recording turntable(int frame_count, double turn_rad);

/// Frames from memory as a device would deliver them, without masks. Each can be spoilt before it is delivered.
class MemorySource : public source::FrameSource
{
public:
  using Spoil = std::function<void(int index, rgbd::RawFrame* raw)>;

  explicit MemorySource(const Recording& recording, Spoil spoil = {}) : recording_(recording), spoil_(std::move(spoil))
  {
  }
  std::optional<rgbd::RawFrame> next() override;
  std::optional<std::size_t> size() const override { return recording_.frames.size(); }
  std::string frameId() const override { return "camera_optical"; }
  std::string name() const override { return "synthetic recording"; }

private:
  const Recording& recording_;
  Spoil spoil_;
  std::size_t next_ = 0;
};

/// As a frame whose depth camera saw nothing.
void removeDepth(rgbd::RawFrame* raw);

keyframes::Session named(const std::string& session_id);

/// Views of the first object all round with exact poses, masks and support plane; the session frame is the world frame.
void storeRenderedSession(keyframes::SessionStore& store, const std::string& session_id, int view_count = 12,
                          const test_support::SyntheticScene& scene = test_support::boxOnTable());

/// Largest distance and angle between a trajectory and the truth, both with respect to their first pose.
struct TrajectoryError
{
  double position_m = 0;
  double angle_rad = 0;
};
TrajectoryError trajectoryError(const std::vector<source::StampedPose>& trajectory, const Recording& truth);

using test_support::statusOf;

/// Everything of a session that a stage may change, to tell whether one did.
std::string fingerprint(keyframes::SessionStore& store, const std::string& session_id);

}  // namespace object_modelling::pipeline
