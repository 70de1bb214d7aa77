#pragma once

#include <vector>

#include <object_modelling/AddKeyframe.h>
#include <object_modelling/ChangeSession.h>
#include <object_modelling/CreateSession.h>
#include <object_modelling/DeleteSession.h>
#include <object_modelling/ExportSession.h>
#include <object_modelling/GetAlignments.h>
#include <object_modelling/GetEncodedKeyframe.h>
#include <object_modelling/GetKeyframe.h>
#include <object_modelling/GetSession.h>
#include <object_modelling/ImportSession.h>
#include <object_modelling/ListSessions.h>
#include <object_modelling/SetSessionPose.h>
#include <object_modelling/UpdateAlignments.h>
#include <object_modelling/UpdateMasks.h>
#include <object_modelling/UpdatePoses.h>
#include <object_modelling/UpdateSession.h>
#include <ros/node_handle.h>

#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::nodes
{
/// A session store as services; whatever the store throws becomes the response's status.
class StoreServices
{
public:
  /// `store` must outlive this.
  StoreServices(ros::NodeHandle& private_node, keyframes::SessionStore& store);
  StoreServices(const StoreServices&) = delete;
  StoreServices& operator=(const StoreServices&) = delete;

private:
  template <typename Service>
  void serve(ros::NodeHandle& node, const char* name,
             void (StoreServices::*handler)(const typename Service::Request&, typename Service::Response&));

  void createSession(const CreateSession::Request& request, CreateSession::Response& response);
  void listSessions(const ListSessions::Request& request, ListSessions::Response& response);
  void getSession(const GetSession::Request& request, GetSession::Response& response);
  void updateSession(const UpdateSession::Request& request, UpdateSession::Response& response);
  void changeSession(const ChangeSession::Request& request, ChangeSession::Response& response);
  void setSessionPose(const SetSessionPose::Request& request, SetSessionPose::Response& response);
  void deleteSession(const DeleteSession::Request& request, DeleteSession::Response& response);
  void addKeyframe(const AddKeyframe::Request& request, AddKeyframe::Response& response);
  void getKeyframe(const GetKeyframe::Request& request, GetKeyframe::Response& response);
  void getEncodedKeyframe(const GetEncodedKeyframe::Request& request, GetEncodedKeyframe::Response& response);
  void updatePoses(const UpdatePoses::Request& request, UpdatePoses::Response& response);
  void updateMasks(const UpdateMasks::Request& request, UpdateMasks::Response& response);
  void getAlignments(const GetAlignments::Request& request, GetAlignments::Response& response);
  void updateAlignments(const UpdateAlignments::Request& request, UpdateAlignments::Response& response);
  void exportSession(const ExportSession::Request& request, ExportSession::Response& response);
  void importSession(const ImportSession::Request& request, ImportSession::Response& response);

  keyframes::SessionStore& store_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace object_modelling::nodes
