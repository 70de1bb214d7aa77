#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include <actionlib/client/action_client.h>

#include "object_modelling/base/job_control.h"
#include "object_modelling/ros_bridge/timed_call.h"

namespace object_modelling::nodes
{
struct ActionLimits
{
  double wait_s = 5;      ///< for the action to be offered
  double silence_s = 10;  ///< of its node, until that counts as gone
};

/// One action of another node; run() blocks until it has ended, was cancelled, or its node has gone. Not
/// SimpleActionClient: that one drops messages that arrive before sendGoal() has returned, and then waits for ever for
/// a goal that ended at once; nor does it notice a server that died. One goal at a time; the server's messages are
/// handled by the thread that spins the global queue, which must not be the one that runs.
template <typename Action>
class ActionCaller
{
public:
  ACTION_DEFINITION(Action)

  ActionCaller(const ros::NodeHandle& node, const std::string& name, const ActionLimits& limits)
      : node_(node), name_(name), resolved_name_(node_.resolveName(name)), limits_(limits)
  {
  }

  /// Once, before anything is run. Returns only when there is a time: with use_sim_time, after the first /clock.
  void connect()
  {
    // An action server publishes its status all the time: silence means that it is gone.
    status_ = node_.subscribe<actionlib_msgs::GoalStatusArray>(name_ + "/status", 1,
                                                               [this](const actionlib_msgs::GoalStatusArrayConstPtr&)
                                                               { last_sign_s_ = ros::Time::now().toSec(); });
    auto client = std::make_shared<Client>(node_, name_);
    const std::lock_guard<std::mutex> lock(mutex_);
    client_ = std::move(client);
  }

  /// Result of the goal. `control` is reported to often, with `prefix` before the stage; a cancel there cancels the
  /// goal, and is thrown once the server has let go. TIMEOUT: the node is down, silent, or was restarted.
  Result run(const Goal& goal, base::JobControl& control, const std::string& prefix = "")
  {
    const std::shared_ptr<Client> client = waitForServer();
    // Outlives this call: feedback may come late.
    const auto latest = std::make_shared<LatestFeedback>();
    last_sign_s_ = ros::Time::now().toSec();
    GoalHandle handle = client->sendGoal(
        goal, {}, [latest](const GoalHandle&, const FeedbackConstPtr& feedback) { latest->set(feedback); });
    try
    {
      follow(handle, *latest, prefix, control);
    }
    catch (const base::Error&)
    {
      handle.cancel();
      waitForEnd(handle, limits_.silence_s);
      const ResultConstPtr result = handle.getResult();
      if (!result || result->status.code != object_modelling::Status::OK)
        throw;
      return *result;  // it had ended before the cancel reached it
    }
    const ResultConstPtr result = handle.getResult();
    if (!result)
      throw gone("its node was restarted while it worked");
    return *result;
  }

private:
  using Client = actionlib::ActionClient<Action>;
  using GoalHandle = typename Client::GoalHandle;

  class LatestFeedback
  {
  public:
    void set(const FeedbackConstPtr& feedback)
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      feedback_ = feedback;
    }
    FeedbackConstPtr get()
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      return feedback_;
    }

  private:
    std::mutex mutex_;
    FeedbackConstPtr feedback_;
  };

  static constexpr double POLL_S = 0.05;

  base::Error gone(const std::string& detail) const
  {
    return ros_bridge::notAnswering("action '" + resolved_name_ + "'", detail);
  }

  std::shared_ptr<Client> waitForServer()
  {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(limits_.wait_s);
    while (true)
    {
      ros_bridge::throwIfShuttingDown();
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (client_ && client_->isServerConnected())
          return client_;
      }
      if (ros::WallTime::now() > end)
        throw gone("not offered within " + ros_bridge::secondsText(limits_.wait_s));
      ros::WallDuration(0.01).sleep();
    }
  }

  /// False after `timeout_s`, and when this node is shut down.
  bool waitForEnd(const GoalHandle& handle, double timeout_s)
  {
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(timeout_s);
    // The result counts, whatever the goal's state: the two come on topics of their own.
    while (!(handle.getCommState() == actionlib::CommState::DONE) && !handle.getResult())
    {
      if (ros::isShuttingDown() || ros::WallTime::now() > end)
        return false;
      ros::WallDuration(0.005).sleep();
    }
    return true;
  }

  void follow(const GoalHandle& handle, LatestFeedback& latest, const std::string& prefix, base::JobControl& control)
  {
    using actionlib::CommState;
    // Not the wall's time: a server publishes its status by ROS time, and so is silent while a simulated clock stands
    // still.
    double last_progress_s = ros::Time::now().toSec();
    while (!waitForEnd(handle, POLL_S))
    {
      ros_bridge::throwIfShuttingDown();
      report(latest.get(), prefix, control);
      const double now_s = ros::Time::now().toSec();
      if (now_s - last_sign_s_ > limits_.silence_s)
        throw gone("silent for " + ros_bridge::secondsText(limits_.silence_s) + " while it worked");
      const CommState state = handle.getCommState();
      const bool taken = !(state == CommState::WAITING_FOR_GOAL_ACK);
      if (taken && !(state == CommState::WAITING_FOR_RESULT))
        last_progress_s = now_s;
      if (now_s - last_progress_s > limits_.silence_s)
        throw gone(std::string(taken ? "did not tell the result" : "did not take the goal") + " within " +
                   ros_bridge::secondsText(limits_.silence_s));
    }
  }

  static void report(const FeedbackConstPtr& feedback, const std::string& prefix, base::JobControl& control)
  {
    if (!feedback)
      return control.report(prefix, 0, 0);
    const std::string separator = prefix.empty() || feedback->stage.empty() ? "" : ", ";
    control.report(prefix + separator + feedback->stage, feedback->done, feedback->total);
  }

  ros::NodeHandle node_;
  std::string name_, resolved_name_;
  ActionLimits limits_;
  std::atomic<double> last_sign_s_{ 0 };  ///< ROS time
  std::mutex mutex_;                      ///< guards client_
  std::shared_ptr<Client> client_;
  ros::Subscriber status_;
};

}  // namespace object_modelling::nodes
