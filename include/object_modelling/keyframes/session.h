#pragma once

#include <optional>
#include <string>

#include "object_modelling/geometry/plane.h"
#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::keyframes
{
/// That a stage has been done on a session, and how.
struct StageMark
{
  std::string by;       ///< what did it; empty: not done; `unknown`: done, by a store older than marks
  std::string options;  ///< YAML of the options; empty where not known
  bool done() const { return !by.empty(); }
  bool operator==(const StageMark& other) const { return by == other.by && options == other.options; }
};

/// Values of StageMark::by.
namespace stage_mark
{
constexpr char UNKNOWN[] = "unknown";
constexpr char AUTOMATIC[] = "automatic";  ///< segmented: the object was chosen by the program
constexpr char BY_HAND[] = "by_hand";      ///< segmented: a person named a point on it
}  // namespace stage_mark

/// One recording of one object in one resting pose.
struct Session
{
  std::string id;               ///< [A-Za-z0-9_.-]+, unique in the store
  std::string object_id;        ///< object it belongs to; empty until known
  std::string camera_frame_id;  ///< optical frame of the recording
  double started_s = 0;         ///< stamp of the first keyframe
  int keyframe_count = 0;       ///< filled by the store
  bool reference_is_object =
      false;            ///< tracked on the object's mask alone (turntable, object in motion): the rest moves
  bool closed = false;  ///< recording has ended
  std::optional<geometry::Plane> support_plane_session;  ///< normal up
  std::optional<Eigen::Isometry3d> T_model_session;      ///< placed in the model frame; empty until aligned
  /// Of the sensor that recorded it; the bias of the noise model is already removed from the stored depth.
  rgbd::SensorCalibration calibration;
  std::string refinement_report;  ///< YAML of the last bundle adjustment; empty if there was none
  StageMark refined;              ///< by a method of refinement (pipeline::RefinementMethod)
  StageMark segmented;            ///< masks are there, and the support plane if there is one to be found
};

/// Whether a name can be used as session or object id everywhere (files, topics, SQL): 1 to 64 of [A-Za-z0-9_.-], not
/// starting with '.' or '-'.
bool isValidId(const std::string& id);

}  // namespace object_modelling::keyframes
