#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/pipeline/session_sink.h"
#include "object_modelling/segmentation/object_follower.h"
#include "object_modelling/tracking/camera_tracker.h"

namespace object_modelling::pipeline
{
struct SessionRecorderOptions
{
  tracking::CameraTrackerOptions tracker;
  segmentation::ObjectFollowerOptions follower;  ///< finds the object in `object` mode where frames bring no masks
  rgbd::SensorNoiseModel noise_model;            ///< of the sensor that the frames come from
  std::vector<std::string> violations() const;
};

/// Of the session that is being recorded, or of the last one.
struct RecordingCounts
{
  int frame_count = 0;
  int tracked_count = 0;  ///< frames with a pose
  int lost_count = 0;     ///< times that tracking was lost
  int relocalised_count = 0;
  int keyframe_count = 0;  ///< committed; those of before a resume too
};

/// What became of one frame.
struct RecordedFrame
{
  rgbd::Frame frame;                     ///< in `object` mode with the masks that it was tracked by
  tracking::TrackingResult result;       ///< its keyframe has been committed
  base::Status object;                   ///< in `object` mode: NO_RESULT where the object cannot be segmented
  std::optional<double> newest_stamp_s;  ///< of the session; set where this frame is not newer and was not tracked
  double track_ms = 0;                   ///< tracker alone
};

/// A session that has ended and may not be closed yet.
struct EndedSession
{
  std::string id;
  int keyframe_count = 0;
  bool created = false;  ///< in the sink
};

/// From frames to a stored session: follows the object, tracks, counts, and commits the session's record and its
/// keyframes as they come. Not thread safe, except for close().
class SessionRecorder
{
public:
  /// `sink` may be null: nothing is kept then. It must outlive this.
  SessionRecorder(const SessionRecorderOptions& options, SessionSink* sink);

  /// Begins a session of this id and object. One whose camera_frame_id is set is created in the sink now, another with
  /// its first frame, which gives that id and the start time. FAILED_PRECONDITION while one is being recorded.
  void start(const keyframes::Session& session);
  /// Continues a session of the sink: its keyframes become the map. INVALID_ARGUMENT without a sink.
  void resume(const std::string& session_id);
  /// The next frame, in time order. `T_robot_camera` as for CameraTracker::track(). Throws base::Error
  /// (FAILED_PRECONDITION: nothing is being recorded) and what the sink throws; the recording goes on, without a
  /// keyframe that could not be committed.
  RecordedFrame process(rgbd::Frame frame, const std::string& camera_frame_id,
                        const std::optional<Eigen::Isometry3d>& T_robot_camera = {});
  /// Closes the session and ends it; where the sink throws, it goes on. FAILED_PRECONDITION if nothing is being
  /// recorded.
  void finish();
  /// Ends the session, without waiting for the sink: close() is left to do. FAILED_PRECONDITION as above.
  EndedSession end();
  /// May wait for the sink; other calls may come meanwhile.
  void close(const EndedSession& ended) const;
  /// Back to idle, with nothing left of the session. One that is being recorded is discarded, unless it was resumed:
  /// then it stays open.
  void reset();

  bool recording() const { return recording_; }
  const keyframes::Session& session() const { return session_; }
  const RecordingCounts& counts() const { return counts_; }

private:
  void requireIdle() const;
  EndedSession current() const;
  void begin(const keyframes::Session& session);
  void create(const keyframes::Session& session);
  RecordedFrame notNewer(rgbd::Frame frame);
  void track(const std::optional<Eigen::Isometry3d>& T_robot_camera, RecordedFrame* recorded);
  void count(const tracking::TrackingResult& result);
  bool onObject() const { return options_.tracker.reference == tracking::Reference::OBJECT; }

  SessionRecorderOptions options_;
  SessionSink* sink_;
  segmentation::ObjectFollower follower_;
  tracking::CameraTracker tracker_;
  keyframes::Session session_;
  bool recording_ = false;
  bool created_ = false;  ///< the session exists in the sink
  bool resumed_ = false;
  bool lost_ = false;
  std::optional<double> newest_stamp_s_;  ///< of the session since it was started or resumed
  RecordingCounts counts_;
};

}  // namespace object_modelling::pipeline
