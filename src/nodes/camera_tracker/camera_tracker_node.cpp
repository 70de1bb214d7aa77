#include "camera_tracker_node.h"

#include <sstream>

#include "object_modelling/ros_bridge/names.h"
#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace
{
namespace names = ros_bridge::names;

/// A second of images: what overflows here is lost without being counted, and pairing takes no time.
constexpr int INPUT_QUEUE_SIZE = 30;
constexpr double WATCH_PERIOD_S = 0.5;
constexpr double WARNING_PERIOD_S = 5;
}  // namespace

CameraTrackerNode::CameraTrackerNode(ros::NodeHandle& node, ros::NodeHandle& private_node,
                                     const CameraTrackerNodeOptions& options)
    : options_(options),
      store_(node, options.store),
      publisher_(private_node, options),
      record_([this](const rgbd::Keyframe& keyframe, const std::string& session_id, const std::string& camera_frame_id)
              { publisher_.publishKeyframe(keyframe, session_id, camera_frame_id); },
              options.use_store ? &store_ : nullptr, options.stored_timeout_s),
      recording_(options, record_),
      robot_(options),
      pairer_(options.frame.max_stamp_difference_s, false),
      watch_(options.input_timeout_s, ros::WallTime::now())
{
  subscribers_ = { subscribe<sensor_msgs::Image>(node, names::COLOR, &FramePairer::addColor, true),
                   subscribe<sensor_msgs::Image>(node, names::DEPTH, &FramePairer::addDepth, true),
                   subscribe<sensor_msgs::CameraInfo>(node, names::CAMERA_INFO, &FramePairer::addInfo, true) };
  if (options.tracker.reference == tracking::Reference::OBJECT && options.mask_source != MaskSource::OWN)
    mask_subscriber_ = subscribe<sensor_msgs::Image>(node, names::OBJECT_MASK, &FramePairer::addMask,
                                                     options.mask_source == MaskSource::TOPIC);
  serve<StartTracking>(private_node, names::START, &CameraTrackerNode::start);
  serve<StopTracking>(private_node, names::STOP, &CameraTrackerNode::stop);
  serve<ResetTracking>(private_node, names::RESET, &CameraTrackerNode::reset);
  watch_timer_ =
      node.createWallTimer(ros::WallDuration(WATCH_PERIOD_S), [this](const ros::WallTimerEvent&) { watchInputs(); });
  worker_ = std::thread([this] { trackFrames(); });
}

CameraTrackerNode::~CameraTrackerNode()
{
  slot_.close();
  worker_.join();
}

template <typename Message>
ros::Subscriber CameraTrackerNode::subscribe(
    ros::NodeHandle& node, const char* topic,
    std::optional<FrameMessages> (FramePairer::*add)(const boost::shared_ptr<const Message>&), bool needed)
{
  const std::optional<std::size_t> watched =
      needed ? std::optional<std::size_t>(watch_.add(node.resolveName(topic))) : std::nullopt;
  const boost::function<void(const boost::shared_ptr<const Message>&)> take =
      [this, watched, add](const boost::shared_ptr<const Message>& message)
  {
    const ros::WallTime now = ros::WallTime::now();
    if (watched)
      watch_.heard(*watched, now);
    newest_stamp_ = message->header.stamp;
    pairer_.setWithMasks(waitsForMasks());
    std::optional<FrameMessages> frame = (pairer_.*add)(message);
    slot_.addDropped(pairer_.takeSkippedCount());
    if (!frame)
      return;
    watch_.gotFrame(now);
    slot_.put(std::move(*frame));
  };
  return node.subscribe<Message>(topic, INPUT_QUEUE_SIZE, take, ros::VoidConstPtr(),
                                 ros::TransportHints().tcpNoDelay());
}

bool CameraTrackerNode::waitsForMasks() const
{
  if (options_.tracker.reference != tracking::Reference::OBJECT)
    return false;
  return options_.mask_source == MaskSource::TOPIC ||
         (options_.mask_source == MaskSource::AUTO && mask_subscriber_.getNumPublishers() > 0);
}

template <typename Service>
void CameraTrackerNode::serve(ros::NodeHandle& node, const char* name,
                              void (CameraTrackerNode::*handler)(const typename Service::Request&,
                                                                 typename Service::Response&))
{
  using Callback = boost::function<bool(typename Service::Request&, typename Service::Response&)>;
  servers_.push_back(node.advertiseService(
      name, Callback([this, handler](typename Service::Request& request, typename Service::Response& response)
                     { return ros_bridge::answer(response, [&] { (this->*handler)(request, response); }); })));
}

void CameraTrackerNode::start(const StartTracking::Request& request, StartTracking::Response& response)
{
  if (options_.use_store && !publisher_.keyframesAreHeard())
    throw base::Error(base::StatusCode::FAILED_PRECONDITION,
                      "nobody listens to " + publisher_.keyframeTopic() +
                          ": start keyframe_store with its topic keyframe remapped to it, or set use_store to false");
  const ros::Time now = newest_stamp_.isZero() ? ros::Time::now() : newest_stamp_;
  response.session_id = recording_.start(request.session_id, request.object_id, request.resume, now);
  last_problem_.clear();
  publisher_.publishState(recording_.state(now));
}

void CameraTrackerNode::stop(const StopTracking::Request&, StopTracking::Response& response)
{
  base::Status stored;
  const TrackingState ended = recording_.stop(&stored);
  response.session_id = ended.session_id;
  response.keyframe_count = ended.keyframe_count;
  response.frame_count = ended.frame_count;
  response.tracked_count = ended.tracked_count;
  response.dropped_frames = ended.dropped_frames;
  publisher_.publishState(recording_.state(ros::Time::now()));
  if (!stored.ok())
    throw base::Error(stored.code, stored.message);
}

void CameraTrackerNode::reset(const ResetTracking::Request&, ResetTracking::Response& response)
{
  response.session_id = recording_.reset();
  publisher_.publishState(recording_.state(ros::Time::now()));
}

std::string CameraTrackerNode::inputProblem(const ros::WallTime& now) const
{
  if (watch_.framesCome(now))
    return {};
  std::string silent = watch_.silentTopics(now);
  if (!silent.empty())
    return silent;
  if (pairer_.waitingCount() > 0)
    return "object mode: no mask on " + mask_subscriber_.getTopic() + " has the stamp of a colour image";
  std::ostringstream text;
  text << "colour and depth are not synchronised: nearest stamps are " << pairer_.unpairedDifference_s()
       << " s apart, allowed are " << options_.frame.max_stamp_difference_s << " s (frame/max_stamp_difference_s)";
  return text.str();
}

void CameraTrackerNode::watchInputs()
{
  const std::string problem = inputProblem(ros::WallTime::now());
  if (!problem.empty() && problem != last_problem_)
  {
    ROS_WARN("%s", problem.c_str());
    publisher_.publishState(recording_.inputProblem(problem, ros::Time::now()));
  }
  last_problem_ = problem;
}

void CameraTrackerNode::trackFrames()
{
  std::size_t dropped_count = 0;
  while (const std::optional<FrameMessages> messages = slot_.take(&dropped_count))
  {
    const base::Status status = ros_bridge::guarded(
        [&]
        {
          const TrackedFrame tracked = recording_.process(*messages, dropped_count, robot_.at(messages->color->header));
          if (!tracked.state.reason.empty())
            ROS_WARN_THROTTLE(WARNING_PERIOD_S, "%s", tracked.state.reason.c_str());
          publisher_.publish(tracked);
        });
    if (!status.ok())
      ROS_ERROR_THROTTLE(WARNING_PERIOD_S, "%s", status.message.c_str());
    dropped_count = 0;
  }
}

}  // namespace object_modelling::nodes
