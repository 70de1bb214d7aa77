#include "modelling_manager.h"

namespace object_modelling::nodes
{
namespace
{
/// Calls that wait at the same time: one for a build, one that starts or ends something, and some queries or calls
/// out of order. More have to wait for their turn.
constexpr unsigned SLOW_THREADS = 8;

ros::NodeHandle withQueue(ros::NodeHandle node, ros::CallbackQueue* queue)
{
  node.setCallbackQueue(queue);
  return node;
}

ros_bridge::RemoteSessionStoreOptions storeOptions(const ManagerOptions& options)
{
  ros_bridge::RemoteSessionStoreOptions store;
  store.connect_timeout_s = options.service_wait_s;
  store.call_timeout_s = options.call_timeout_s;
  return store;
}
}  // namespace

ModellingManager::ModellingManager(ros::NodeHandle& node, ros::NodeHandle& private_node, const ManagerOptions& options)
    : slow_node_(withQueue(private_node, &slow_queue_)),
      board_(private_node),
      store_(node, storeOptions(options)),
      recording_(node, slow_node_, options, store_, board_),
      building_(node, private_node, slow_node_, options, store_, board_),
      slow_spinner_(SLOW_THREADS, &slow_queue_)
{
  slow_spinner_.start();
}

ModellingManager::~ModellingManager()
{
  building_.close();
  slow_spinner_.stop();  // waits for callbacks, which end with the build
}

}  // namespace object_modelling::nodes
