#include "recogniser_node.h"

#include <algorithm>

#include "object_model_message.h"
#include "object_modelling/ros_bridge/frame_conversion.h"
#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace
{
constexpr double WARN_INTERVAL_S = 5;
constexpr int DATABASE_THREADS = 2;  // ~get_object_model does not wait for ~reload

std::string idsOf(const KnownObjects& known)
{
  std::string ids;
  for (const auto& [id, object] : known.objects)
    ids += (ids.empty() ? "" : ", ") + id;
  return ids;
}

bool isIn(const sensor_msgs::RegionOfInterest& roi, const Eigen::Vector2d& pixel)
{
  return pixel.x() >= roi.x_offset && pixel.x() < static_cast<double>(roi.x_offset) + roi.width &&
         pixel.y() >= roi.y_offset && pixel.y() < static_cast<double>(roi.y_offset) + roi.height;
}

/// Leaves out what was not asked for. The search is for all objects: what looks like another one is decided among them.
void keepWanted(const object_modelling::Recognise::Request& request, const geometry::PinholeCamera& camera,
                FoundObjects* found)
{
  const auto unwanted = [&](const recognition::Detection& detection)
  {
    const auto& ids = request.object_ids;
    if (!ids.empty() && std::find(ids.begin(), ids.end(), detection.object_id) == ids.end())
      return true;
    if (request.roi.width == 0 && request.roi.height == 0)
      return false;
    const recognition::ObjectKnowledge& object = *found->known->objects.at(detection.object_id);
    return !isIn(request.roi, camera.project(detection.T_camera_model * object.center_model.cast<double>()));
  };
  auto& detections = found->detections;
  detections.erase(std::remove_if(detections.begin(), detections.end(), unwanted), detections.end());
}

FoundObjects search(const StampedFrame& frame, std::shared_ptr<const KnownObjects> known)
{
  FoundObjects found;
  found.header = frame.header;
  const ros::WallTime start = ros::WallTime::now();
  found.detections = known->recogniser->recognise(frame.frame);
  found.duration_s = (ros::WallTime::now() - start).toSec();
  found.known = std::move(known);
  return found;
}

void checkRequest(const object_modelling::Recognise::Request& request)
{
  if (request.wait < ros::Duration(0))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "wait is negative: give 0 for the newest frame");
  if ((request.roi.width == 0) != (request.roi.height == 0))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "roi has width or height 0: give both, or neither for the whole image");
  const int given = (request.color.data.empty() ? 0 : 1) + (request.depth.data.empty() ? 0 : 1) +
                    (request.camera_info.K[0] == 0 && request.camera_info.P[0] == 0 ? 0 : 1);
  if (given != 0 && given != 3)
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "of color, depth and camera_info only some are given: give all three, or none for the camera's "
                      "newest frame");
  if (given != 0 && request.wait > ros::Duration(0))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "wait is for the camera's frames: leave it 0 with own images");
}

base::Result<StampedFrame> checked(base::Result<StampedFrame> frame)
{
  if (!frame.ok())
    throw base::Error(frame.status.code, frame.status.message);
  return frame;
}
}  // namespace

RecogniserNode::RecogniserNode(ros::NodeHandle& node, ros::NodeHandle& private_node,
                               const RecogniserNodeOptions& options)
    : options_(options),
      database_path_(dataPath(options.database_path, "objects")),
      input_(node, options.frame),
      given_frames_(options.frame),
      publisher_(private_node),
      watch_(database_path_, options.poll_period_s, options.recogniser,
             [this](const KnownObjects& known) { publisher_.publishKnown(known); }),
      recognise_service_(private_node.advertiseService("recognise", &RecogniserNode::recognise, this)),
      database_spinner_(DATABASE_THREADS, &database_queue_)
{
  ros::NodeHandle database_node(private_node);
  database_node.setCallbackQueue(&database_queue_);
  reload_service_ = database_node.advertiseService("reload", &RecogniserNode::reload, this);
  model_service_ = database_node.advertiseService("get_object_model", &RecogniserNode::getObjectModel, this);
  database_spinner_.start();
  if (options.rate_hz > 0)
    timer_ =
        node.createWallTimer(ros::WallDuration(1 / options.rate_hz), [this](const ros::WallTimerEvent&) { onTimer(); });
}

std::shared_ptr<const KnownObjects> RecogniserNode::objectsFor(const std::vector<std::string>& object_ids) const
{
  std::shared_ptr<const KnownObjects> known = watch_.known();
  if (!known->recogniser && known->learning)
    throw base::Error(base::StatusCode::FAILED_PRECONDITION,
                      "the objects of " + database_path_ + " are still being learnt: try again in some seconds");
  if (!known->recogniser)
    throw base::Error(
        base::StatusCode::FAILED_PRECONDITION,
        known->status.ok() ? "the database " + database_path_ + " has no objects yet" : known->status.message);
  for (const std::string& id : object_ids)
    if (known->objects.count(id) == 0)
      throw base::Error(base::StatusCode::NOT_FOUND, "object '" + id + "' is not known: known are " + idsOf(*known) +
                                                         (known->status.ok() ? "" : "; " + known->status.message));
  return known;
}

StampedFrame RecogniserNode::frameFor(const object_modelling::Recognise::Request& request)
{
  const double wait_s = request.wait.toSec();
  if (request.color.data.empty())
    return checked(wait_s > 0 ? input_.getNext(wait_s) : input_.get(options_.input_timeout_s)).value;
  const base::Status registered = ros_bridge::checkRegistered(request.color.header, request.depth.header);
  if (!registered.ok())
    throw base::Error(registered.code, registered.message);
  base::Result<rgbd::Frame> frame = given_frames_.build(ros_bridge::rawFrameFromMessages(
      request.color, request.depth, request.camera_info, ros_bridge::ImageKind::RECTIFIED));
  if (!frame.ok())
    throw base::Error(frame.status.code, frame.status.message);
  return { request.color.header, std::move(frame.value) };
}

bool RecogniserNode::recognise(object_modelling::Recognise::Request& request,
                               object_modelling::Recognise::Response& response)
{
  return ros_bridge::answer(response,
                            [&]
                            {
                              checkRequest(request);
                              objectsFor(request.object_ids);
                              const StampedFrame frame = frameFor(request);
                              FoundObjects found = search(frame, objectsFor(request.object_ids));
                              keepWanted(request, frame.frame.camera, &found);
                              response.detections = detectionsMessage(found);
                              publisher_.publish(found, response.detections);
                            });
}

bool RecogniserNode::reload(object_modelling::ReloadDatabase::Request&,
                            object_modelling::ReloadDatabase::Response& response)
{
  const base::Status status = ros_bridge::guarded([&] { response.known = knownMessage(*watch_.reload()); });
  response.status = status.ok() ? response.known.status : ros_bridge::toMessage(status);
  return true;
}

bool RecogniserNode::getObjectModel(object_modelling::GetObjectModel::Request& request,
                                    object_modelling::GetObjectModel::Response& response)
{
  return ros_bridge::answer(response, [&] { response.object = objectModelMessage(database_path_, request.object_id); });
}

void RecogniserNode::onTimer()
{
  const ros::Time stamp = input_.stamp();
  const std::shared_ptr<const KnownObjects> known = watch_.known();
  if (stamp.isZero() || stamp == last_stamp_ || !known->recogniser)
    return;
  const base::Status status = ros_bridge::guarded(
      [&]
      {
        last_stamp_ = stamp;
        const FoundObjects found = search(checked(input_.get(0)).value, known);
        publisher_.publish(found, detectionsMessage(found));
      });
  if (!status.ok())
    ROS_WARN_THROTTLE(WARN_INTERVAL_S, "%s", status.message.c_str());
}

}  // namespace object_modelling::nodes
