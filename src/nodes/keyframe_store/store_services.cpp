#include "store_services.h"

#include "object_modelling/ros_bridge/keyframe_conversion.h"
#include "object_modelling/ros_bridge/names.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "object_modelling/ros_bridge/session_conversion.h"
#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace names = ros_bridge::names;

template <typename Service>
void StoreServices::serve(ros::NodeHandle& node, const char* name,
                          void (StoreServices::*handler)(const typename Service::Request&, typename Service::Response&))
{
  using Callback = boost::function<bool(typename Service::Request&, typename Service::Response&)>;
  servers_.push_back(node.advertiseService(
      name, Callback([this, handler](typename Service::Request& request, typename Service::Response& response)
                     { return ros_bridge::answer(response, [&] { (this->*handler)(request, response); }); })));
}

StoreServices::StoreServices(ros::NodeHandle& private_node, keyframes::SessionStore& store) : store_(store)
{
  serve<CreateSession>(private_node, names::CREATE_SESSION, &StoreServices::createSession);
  serve<ListSessions>(private_node, names::LIST_SESSIONS, &StoreServices::listSessions);
  serve<GetSession>(private_node, names::GET_SESSION, &StoreServices::getSession);
  serve<UpdateSession>(private_node, names::UPDATE_SESSION, &StoreServices::updateSession);
  serve<ChangeSession>(private_node, names::CHANGE_SESSION, &StoreServices::changeSession);
  serve<SetSessionPose>(private_node, names::SET_SESSION_POSE, &StoreServices::setSessionPose);
  serve<DeleteSession>(private_node, names::DELETE_SESSION, &StoreServices::deleteSession);
  serve<AddKeyframe>(private_node, names::ADD_KEYFRAME, &StoreServices::addKeyframe);
  serve<GetKeyframe>(private_node, names::GET_KEYFRAME, &StoreServices::getKeyframe);
  serve<GetEncodedKeyframe>(private_node, names::GET_ENCODED_KEYFRAME, &StoreServices::getEncodedKeyframe);
  serve<UpdatePoses>(private_node, names::UPDATE_POSES, &StoreServices::updatePoses);
  serve<UpdateMasks>(private_node, names::UPDATE_MASKS, &StoreServices::updateMasks);
  serve<GetAlignments>(private_node, names::GET_ALIGNMENTS, &StoreServices::getAlignments);
  serve<UpdateAlignments>(private_node, names::UPDATE_ALIGNMENTS, &StoreServices::updateAlignments);
  serve<ExportSession>(private_node, names::EXPORT_SESSION, &StoreServices::exportSession);
  serve<ImportSession>(private_node, names::IMPORT_SESSION, &StoreServices::importSession);
}

void StoreServices::createSession(const CreateSession::Request& request, CreateSession::Response&)
{
  store_.createSession(ros_bridge::fromMessage(request.session));
}

void StoreServices::listSessions(const ListSessions::Request&, ListSessions::Response& response)
{
  for (const keyframes::Session& session : store_.listSessions())
    response.sessions.push_back(ros_bridge::toMessage(session));
}

void StoreServices::getSession(const GetSession::Request& request, GetSession::Response& response)
{
  response.session = ros_bridge::toMessage(store_.session(request.session_id));
  const std::vector<int> ids = store_.keyframeIds(request.session_id);
  response.keyframe_ids.assign(ids.begin(), ids.end());
}

void StoreServices::updateSession(const UpdateSession::Request& request, UpdateSession::Response&)
{
  const keyframes::Session session = ros_bridge::fromMessage(request.session);
  store_.update(session.id, keyframes::SessionChange::toAllOf(session));
}

void StoreServices::changeSession(const ChangeSession::Request& request, ChangeSession::Response&)
{
  store_.update(request.session_id, ros_bridge::fromMessage(request.change));
}

void StoreServices::setSessionPose(const SetSessionPose::Request& request, SetSessionPose::Response&)
{
  std::optional<Eigen::Isometry3d> T_model_session;
  if (request.has_model_from_session)
    T_model_session = ros_bridge::fromMessage(request.model_from_session);
  keyframes::SessionChange change;
  change.T_model_session = T_model_session;
  store_.update(request.session_id, change);
}

void StoreServices::deleteSession(const DeleteSession::Request& request, DeleteSession::Response&)
{
  store_.deleteSession(request.session_id);
}

void StoreServices::addKeyframe(const AddKeyframe::Request& request, AddKeyframe::Response&)
{
  store_.addKeyframe(request.keyframe.session_id, ros_bridge::fromMessage(request.keyframe));
}

void StoreServices::getKeyframe(const GetKeyframe::Request& request, GetKeyframe::Response& response)
{
  const keyframes::Session session = store_.session(request.session_id);
  response.keyframe = ros_bridge::toMessage(store_.keyframe(request.session_id, request.keyframe_id),
                                            request.session_id, session.camera_frame_id);
}

void StoreServices::getEncodedKeyframe(const GetEncodedKeyframe::Request& request,
                                       GetEncodedKeyframe::Response& response)
{
  response.keyframe = ros_bridge::toMessage(store_.encodedKeyframe(request.session_id, request.keyframe_id));
}

void StoreServices::updatePoses(const UpdatePoses::Request& request, UpdatePoses::Response&)
{
  std::vector<keyframes::PoseUpdate> updates;
  for (const PoseUpdate& update : request.updates)
    updates.push_back(ros_bridge::fromMessage(update));
  store_.update(request.session_id, keyframes::SessionChange::ofPoses(std::move(updates)));
}

void StoreServices::updateMasks(const UpdateMasks::Request& request, UpdateMasks::Response&)
{
  std::vector<keyframes::MaskUpdate> updates;
  for (const ObjectMask& update : request.updates)
    updates.push_back(ros_bridge::fromMessage(update));
  store_.update(request.session_id, keyframes::SessionChange::ofMasks(std::move(updates)));
}

void StoreServices::getAlignments(const GetAlignments::Request&, GetAlignments::Response& response)
{
  for (const keyframes::AlignmentRecord& record : store_.alignments())
    response.alignments.push_back(ros_bridge::toMessage(record));
}

void StoreServices::updateAlignments(const UpdateAlignments::Request& request, UpdateAlignments::Response&)
{
  std::vector<keyframes::AlignmentRecord> records;
  for (const AlignmentRecord& record : request.alignments)
    records.push_back(ros_bridge::fromMessage(record));
  store_.updateAlignments(records);
}

void StoreServices::exportSession(const ExportSession::Request& request, ExportSession::Response&)
{
  store_.exportSession(request.session_id, request.path);
}

void StoreServices::importSession(const ImportSession::Request& request, ImportSession::Response& response)
{
  response.session_id = store_.importSession(request.path);
}

}  // namespace object_modelling::nodes
