#pragma once

#include <mutex>
#include <optional>

#include <object_modelling/ClearSelection.h>
#include <object_modelling/Keyframe.h>
#include <object_modelling/Segment.h>
#include <object_modelling/SegmentSessionAction.h>
#include <object_modelling/SelectHypothesis.h>
#include <object_modelling/SetRoi.h>

#include "../common/job_server.h"
#include "../common/newest_frame.h"
#include "hypotheses_publisher.h"
#include "live_masks.h"
#include "object_modelling/ros_bridge/remote_session_store.h"
#include "segmenter_options.h"
#include "selection.h"
#include "session_frame.h"

namespace object_modelling::nodes
{
/// Node segmenter: docs/nodes/segmenter.md. Callbacks run on the spinning thread, ~segment_session on its own.
class Segmenter
{
public:
  Segmenter(ros::NodeHandle& node, ros::NodeHandle& private_node, const SegmenterOptions& options);

private:
  /// The view that ids of hypotheses refer to.
  struct View
  {
    StampedFrame frame;
    segmentation::SceneSegmentation segmentation;
    std::optional<Eigen::Isometry3d> T_session_camera;
  };

  /// Segments the newest frame into view_; throws base::Error if there is none. The segmentation's status may be
  /// NO_RESULT.
  void look();
  int selectedInView() const;
  int pick(const object_modelling::SelectHypothesis::Request& request);
  void choose(int hypothesis);

  bool segment(object_modelling::Segment::Request& request, object_modelling::Segment::Response& response);
  bool select(object_modelling::SelectHypothesis::Request& request,
              object_modelling::SelectHypothesis::Response& response);
  bool setRoi(object_modelling::SetRoi::Request& request, object_modelling::SetRoi::Response& response);
  bool clear(object_modelling::ClearSelection::Request& request, object_modelling::ClearSelection::Response& response);
  object_modelling::SegmentSessionResult segmentSession(const object_modelling::SegmentSessionGoal& goal,
                                                        base::JobControl& control);
  void onKeyframe(const object_modelling::KeyframeConstPtr& message);
  void onClickedPoint(const geometry_msgs::PointStampedConstPtr& point);
  void onPreviewTimer();

  SegmenterOptions options_;
  segmentation::SceneSegmenter segmenter_;
  std::mutex mutex_;  ///< guards what the job's thread uses as well: selection_, final_session_id_
  Selection selection_;
  std::string final_session_id_;  ///< session that ~segment_session has taken over
  LiveMasks masks_;
  std::optional<View> view_;

  NewestFrame newest_;
  SessionFrame session_;
  HypothesesPublisher publisher_;
  ros::Publisher mask_publisher_;
  ros::Subscriber keyframe_subscriber_, clicked_point_subscriber_;
  ros::ServiceServer segment_service_, select_service_, set_roi_service_, clear_service_;
  ros::Timer preview_timer_;
  ros_bridge::RemoteSessionStore store_;
  JobServer<object_modelling::SegmentSessionAction> server_;
};

}  // namespace object_modelling::nodes
