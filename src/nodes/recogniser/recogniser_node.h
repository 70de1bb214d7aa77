#pragma once

#include <object_modelling/GetObjectModel.h>
#include <object_modelling/Recognise.h>
#include <object_modelling/ReloadDatabase.h>
#include <ros/spinner.h>

#include "detections_publisher.h"
#include "frame_input.h"
#include "recogniser_options.h"

namespace object_modelling::nodes
{
/// Node recogniser: docs/nodes/recogniser.md. ~recognise and the timer run on the spinning thread, so that one image at
/// a time is searched; the services of the database on threads of their own, since ~reload waits for objects to be
/// learnt.
class RecogniserNode
{
public:
  RecogniserNode(ros::NodeHandle& node, ros::NodeHandle& private_node, const RecogniserNodeOptions& options);

private:
  bool recognise(object_modelling::Recognise::Request& request, object_modelling::Recognise::Response& response);
  bool reload(object_modelling::ReloadDatabase::Request& request, object_modelling::ReloadDatabase::Response& response);
  bool getObjectModel(object_modelling::GetObjectModel::Request& request,
                      object_modelling::GetObjectModel::Response& response);
  void onTimer();
  /// The images of the call where it has any, else the camera's frame. Throws base::Error.
  StampedFrame frameFor(const object_modelling::Recognise::Request& request);
  /// Known objects, at least one. Throws base::Error: FAILED_PRECONDITION without any, NOT_FOUND for an unknown id.
  std::shared_ptr<const KnownObjects> objectsFor(const std::vector<std::string>& object_ids) const;

  RecogniserNodeOptions options_;
  std::string database_path_;
  FrameInput input_;
  rgbd::FrameBuilder given_frames_;  ///< of images that come with a call
  DetectionsPublisher publisher_;
  ros::Time last_stamp_;  ///< of the frame that the timer has searched
  DatabaseWatch watch_;
  ros::CallbackQueue database_queue_;
  ros::ServiceServer recognise_service_, reload_service_, model_service_;
  ros::WallTimer timer_;
  ros::AsyncSpinner database_spinner_;
};

}  // namespace object_modelling::nodes
