#include "segmenter.h"

#include "hypotheses_message.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/ros_bridge/keyframe_conversion.h"
#include "object_modelling/ros_bridge/names.h"

namespace object_modelling::nodes
{
namespace names = ros_bridge::names;

namespace
{
constexpr double MAX_ROI_SIZE_M = 10;
constexpr double WARN_INTERVAL_S = 5;

void throwUnlessOk(const base::Status& status)
{
  if (!status.ok())
    throw base::Error(status.code, status.message);
}
}  // namespace

Segmenter::Segmenter(ros::NodeHandle& node, ros::NodeHandle& private_node, const SegmenterOptions& options)
    : options_(options),
      segmenter_(options.propagator.segmenter),
      selection_(options.selection_margin_m),
      masks_(options.propagator, options.automatic),
      newest_(node, options.frame),
      session_(node, options.session_frame_id, options.tf_timeout_s),
      publisher_(private_node),
      mask_publisher_(private_node.advertise<object_modelling::ObjectMask>(names::MASK, 50)),
      keyframe_subscriber_(node.subscribe(names::KEYFRAME, 50, &Segmenter::onKeyframe, this)),
      clicked_point_subscriber_(node.subscribe("/clicked_point", 5, &Segmenter::onClickedPoint, this)),
      segment_service_(private_node.advertiseService("segment", &Segmenter::segment, this)),
      select_service_(private_node.advertiseService("select", &Segmenter::select, this)),
      set_roi_service_(private_node.advertiseService("set_roi", &Segmenter::setRoi, this)),
      clear_service_(private_node.advertiseService("clear", &Segmenter::clear, this)),
      store_(node, options.store),
      server_(
          private_node, "segment_session",
          [](const object_modelling::SegmentSessionGoal& goal) { return "segment " + goal.session_id; },
          [this](const object_modelling::SegmentSessionGoal& goal, base::JobControl& control)
          { return segmentSession(goal, control); })
{
  if (options.preview_rate_hz > 0)
    preview_timer_ = node.createTimer(ros::Duration(1 / options.preview_rate_hz),
                                      [this](const ros::TimerEvent&) { onPreviewTimer(); });
}

void Segmenter::look()
{
  base::Result<StampedFrame> newest = newest_.get();
  throwUnlessOk(newest.status);
  View view;
  view.segmentation = segmenter_.segment(newest.value.frame);
  view.T_session_camera = session_.T_session_camera(newest.value.header);
  view.frame = std::move(newest.value);
  const std::lock_guard<std::mutex> lock(mutex_);
  selection_.applyRoi(view.T_session_camera, &view.segmentation);
  view_ = std::move(view);
}

int Segmenter::selectedInView() const
{
  const base::Result<int> found = selection_.find(view_->segmentation, session_.recorded(), view_->T_session_camera);
  return found.ok() ? found.value : -1;
}

int Segmenter::pick(const object_modelling::SelectHypothesis::Request& request)
{
  using Request = object_modelling::SelectHypothesis::Request;
  if (request.method == Request::BY_ID)
  {
    if (!view_)
      throw base::Error(base::StatusCode::FAILED_PRECONDITION, "nothing has been segmented yet: call segment first");
    const std::size_t count = view_->segmentation.hypotheses.size();
    if (request.id < 0 || static_cast<std::size_t>(request.id) >= count)
      throw base::Error(base::StatusCode::NOT_FOUND, "hypothesis " + std::to_string(request.id) +
                                                         " does not exist: the last segmentation has " +
                                                         std::to_string(count) + ", counted from 0");
    return request.id;
  }
  look();
  const segmentation::SceneSegmentation& segmentation = view_->segmentation;
  throwUnlessOk(segmentation.status);
  base::Result<int> picked;
  if (request.method == Request::AUTOMATIC)
    picked = segmentation::selectAutomatically(segmentation, view_->frame.frame.camera);
  else if (request.method == Request::BY_PIXEL)
    picked = segmentation::selectByPixel(segmentation, request.u_px, request.v_px);
  else if (request.method == Request::BY_POINT)
    picked = segmentation::selectByPoint(segmentation, session_.inCamera(request.point, view_->frame.header),
                                         options_.selection_margin_m);
  else
    picked.status = { base::StatusCode::INVALID_ARGUMENT,
                      "method " + std::to_string(request.method) +
                          " is unknown: 0 automatic, 1 by id, 2 by pixel, 3 by point" };
  throwUnlessOk(picked.status);
  return picked.value;
}

void Segmenter::choose(int hypothesis)
{
  if (!session_.recorded().empty() && !view_->T_session_camera)
    throw base::Error(
        base::StatusCode::FAILED_PRECONDITION,
        "the camera's place in session '" + session_.recorded() +
            "' is not known for this frame, so the choice would be lost: point the camera back to what it "
            "has seen and select again");
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    selection_.choose(view_->segmentation.hypotheses[static_cast<std::size_t>(hypothesis)].centroid_camera,
                      session_.recorded(), view_->T_session_camera);
    masks_.restart();
  }
  publisher_.publish(view_->frame, view_->segmentation, hypothesis);
}

bool Segmenter::segment(object_modelling::Segment::Request&, object_modelling::Segment::Response& response)
{
  return ros_bridge::answer(response,
                            [&]
                            {
                              look();
                              const int selected = selectedInView();
                              response.hypotheses =
                                  toMessage(view_->segmentation, selected, view_->frame.frame, view_->frame.header);
                              publisher_.publish(view_->frame, view_->segmentation, selected);
                              throwUnlessOk(view_->segmentation.status);
                            });
}

bool Segmenter::select(object_modelling::SelectHypothesis::Request& request,
                       object_modelling::SelectHypothesis::Response& response)
{
  return ros_bridge::answer(response,
                            [&]
                            {
                              const int chosen = pick(request);
                              choose(chosen);
                              response.header = view_->frame.header;
                              response.hypothesis =
                                  toMessage(view_->segmentation, chosen, view_->frame.frame, view_->frame.header)
                                      .hypotheses[static_cast<std::size_t>(chosen)];
                            });
}

bool Segmenter::setRoi(object_modelling::SetRoi::Request& request, object_modelling::SetRoi::Response& response)
{
  return ros_bridge::answer(response,
                            [&]
                            {
                              std::optional<geometry::OrientedBox> box_camera;
                              std::optional<Eigen::Isometry3d> T_session_camera;
                              if (request.enabled)
                              {
                                const Eigen::Vector3d size_m(request.size_m.x, request.size_m.y, request.size_m.z);
                                if (!(size_m.minCoeff() > 0) || !(size_m.maxCoeff() <= MAX_ROI_SIZE_M))
                                  throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                                                    "size_m must be within (0, 10] along each axis, is " +
                                                        std::to_string(size_m.x()) + " " + std::to_string(size_m.y()) +
                                                        " " + std::to_string(size_m.z()));
                                const base::Result<StampedFrame> newest = newest_.get();
                                throwUnlessOk(newest.status);
                                box_camera = { session_.inCamera(request.box, newest.value.header), size_m };
                                T_session_camera = session_.T_session_camera(newest.value.header);
                              }
                              const std::lock_guard<std::mutex> lock(mutex_);
                              selection_.setRoi(box_camera, session_.recorded(), T_session_camera);
                              masks_.restart();
                            });
}

bool Segmenter::clear(object_modelling::ClearSelection::Request&, object_modelling::ClearSelection::Response& response)
{
  return ros_bridge::answer(response,
                            [&]
                            {
                              const std::lock_guard<std::mutex> lock(mutex_);
                              selection_.clear();
                              masks_.restart();
                            });
}

object_modelling::SegmentSessionResult Segmenter::segmentSession(const object_modelling::SegmentSessionGoal& goal,
                                                                 base::JobControl& control)
{
  std::optional<Eigen::Vector3d> seed;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    seed = selection_.seed(goal.session_id);
    final_session_id_ = goal.session_id;
  }
  if (goal.has_seed_point)
    seed = Eigen::Vector3d(goal.seed_point.x, goal.seed_point.y, goal.seed_point.z);
  const pipeline::SegmentReport report =
      pipeline::segmentStoredSession(store_, goal.session_id, seed, options_.propagator, control);
  object_modelling::SegmentSessionResult result;
  result.status = ros_bridge::toMessage(report.status);
  result.keyframe_count = report.keyframe_count;
  result.masked_count = report.masked_count;
  result.has_support_plane = report.support_plane_found;
  return result;
}

void Segmenter::onKeyframe(const object_modelling::KeyframeConstPtr& message)
{
  if (message->object_mask.width > 0)
    return;  // tracked by its mask: that is a measurement
  const base::Status status = ros_bridge::guarded(
      [&]
      {
        const rgbd::Keyframe keyframe = ros_bridge::fromMessage(*message);
        const std::lock_guard<std::mutex> lock(mutex_);
        // Keyframes that still wait after the recording may not replace the final masks.
        if (message->session_id == final_session_id_ && message->session_id != session_.recorded())
          return;
        const base::Result<cv::Mat> mask = masks_.add(keyframe, message->session_id, &selection_);
        throwUnlessOk(mask.status);
        mask_publisher_.publish(
            ros_bridge::toMessage(keyframes::MaskUpdate{ keyframe.id, mask.value }, message->session_id));
      });
  if (!status.ok())
    ROS_WARN_THROTTLE(WARN_INTERVAL_S, "no mask in keyframe %d of '%s': %s", message->keyframe_id,
                      message->session_id.c_str(), status.message.c_str());
}

void Segmenter::onClickedPoint(const geometry_msgs::PointStampedConstPtr& point)
{
  object_modelling::SelectHypothesis::Request request;
  request.method = object_modelling::SelectHypothesis::Request::BY_POINT;
  request.point = *point;
  const base::Status status = ros_bridge::guarded([&] { choose(pick(request)); });
  if (!status.ok())
    ROS_WARN("clicked point: %s", status.message.c_str());
}

void Segmenter::onPreviewTimer()
{
  if (!publisher_.wanted() || newest_.stamp().isZero() || (view_ && view_->frame.header.stamp == newest_.stamp()))
    return;
  const base::Status status = ros_bridge::guarded(
      [&]
      {
        look();
        publisher_.publish(view_->frame, view_->segmentation, selectedInView());
      });
  if (!status.ok())
    ROS_WARN_THROTTLE(WARN_INTERVAL_S, "%s", status.message.c_str());
}

}  // namespace object_modelling::nodes
