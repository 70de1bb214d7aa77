#pragma once

#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <object_modelling/BuildObject.h>
#include <object_modelling/Cancel.h>
#include <object_modelling/ListObjects.h>

#include "job_clients.h"
#include "manager_board.h"
#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::nodes
{
/// ~build_object, ~cancel and ~list_objects. A build runs on a thread of its own.
class BuildServices
{
public:
  /// ~build_object and ~list_objects block, and belong to the queue of `slow_node`; ~cancel is answered at once.
  /// `board` and `store` must outlive this.
  BuildServices(ros::NodeHandle& node, ros::NodeHandle& private_node, ros::NodeHandle& slow_node,
                const ManagerOptions& options, keyframes::SessionStore& store, ManagerBoard& board);
  ~BuildServices();

  /// Ends the build that runs here and refuses new ones; who waits for one is answered soon. The job of the other node
  /// runs on where ROS is shut down already.
  void close();

private:
  using Build = object_modelling::BuildObject;

  struct Outcome
  {
    base::Status status;  ///< OK: with what could not be done
    object_modelling::BuiltObject built;
  };

  void build(const Build::Request& request, Build::Response& response);
  void cancel(const object_modelling::Cancel::Request& request, object_modelling::Cancel::Response& response);
  void listObjects(const object_modelling::ListObjects::Request& request,
                   object_modelling::ListObjects::Response& response);

  /// Takes the state to BUILDING, or throws why not. Returns the last recorded session.
  std::string begin(const std::string& object_id);
  /// On the build's thread, while the state is BUILDING.
  Outcome run(const Build::Request& request, const std::vector<std::string>& session_ids);
  Outcome runStages(const Build::Request& request, const std::vector<std::string>& session_ids);
  void enterStage(const std::string& object_id, const std::string& stage);
  void onProgress(const base::Progress& progress);
  /// Takes the state to IDLE; a build that was refused before its first stage is not reported.
  void end(const std::string& object_id, const Outcome* outcome);

  ros::NodeHandle node_;
  ManagerOptions options_;
  keyframes::SessionStore& store_;
  ManagerBoard& board_;
  JobClients jobs_;
  std::unique_ptr<base::JobControl> control_;  ///< while the state is BUILDING; guarded by the board's mutex
  bool closed_ = false;                        ///< guarded by the board's mutex
  std::thread thread_;                         ///< belongs to whoever took the state to BUILDING
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace object_modelling::nodes
