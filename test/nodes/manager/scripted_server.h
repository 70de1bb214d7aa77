#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <actionlib_msgs/GoalID.h>
#include <actionlib_msgs/GoalStatusArray.h>
#include <object_modelling/RefineAction.h>
#include <ros/ros.h>

namespace object_modelling::nodes
{
/// The topics of an action server, without the server: what it does with a goal is up to the test.
class ScriptedServer
{
public:
  using GoalStatus = actionlib_msgs::GoalStatus;
  using OnGoal = std::function<void(ScriptedServer&, const std::string& goal_id)>;

  ScriptedServer(ros::NodeHandle node, const std::string& name, OnGoal on_goal)
      : on_goal_(std::move(on_goal)),
        status_(node.advertise<actionlib_msgs::GoalStatusArray>(name + "/status", 50)),
        feedback_(node.advertise<object_modelling::RefineActionFeedback>(name + "/feedback", 50)),
        result_(node.advertise<object_modelling::RefineActionResult>(name + "/result", 50)),
        goal_subscriber_(node.subscribe<object_modelling::RefineActionGoal>(
            name + "/goal", 50,
            [this](const object_modelling::RefineActionGoalConstPtr& goal) { on_goal_(*this, goal->goal_id.id); })),
        cancel_subscriber_(node.subscribe<actionlib_msgs::GoalID>(name + "/cancel", 50,
                                                                  [this](const actionlib_msgs::GoalIDConstPtr& goal)
                                                                  {
                                                                    if (on_cancel)
                                                                      on_cancel(*this, goal->id);
                                                                  })),
        timer_(node.createWallTimer(ros::WallDuration(0.05), [this](const ros::WallTimerEvent&) { publishStatus(); }))
  {
  }

  /// What is said of the goal from now on.
  void tell(const std::string& goal_id, std::uint8_t status)
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      told_ = { statusOf(goal_id, status) };
    }
    publishStatus();
  }
  /// As a server that was restarted: it knows of no goal.
  void forget()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    told_.clear();
  }
  void silence() { timer_.stop(); }
  void feedBack(const std::string& goal_id, const std::string& stage)
  {
    object_modelling::RefineActionFeedback message;
    message.status = statusOf(goal_id, GoalStatus::ACTIVE);
    message.feedback.stage = stage;
    message.feedback.done = 1;
    message.feedback.total = 2;
    feedback_.publish(message);
  }
  void end(const std::string& goal_id, std::uint8_t status, std::uint8_t code, const std::string& text = "")
  {
    object_modelling::RefineActionResult message;
    message.status = statusOf(goal_id, status);
    message.result.status.code = code;
    message.result.status.message = text;
    result_.publish(message);
    tell(goal_id, status);
  }

  OnGoal on_cancel;

private:
  static GoalStatus statusOf(const std::string& goal_id, std::uint8_t status)
  {
    GoalStatus message;
    message.goal_id.id = goal_id;
    message.status = status;
    return message;
  }
  void publishStatus()
  {
    actionlib_msgs::GoalStatusArray message;
    message.header.stamp = ros::Time::now();
    const std::lock_guard<std::mutex> lock(mutex_);
    message.status_list = told_;
    status_.publish(message);
  }

  OnGoal on_goal_;
  std::mutex mutex_;
  std::vector<GoalStatus> told_;
  ros::Publisher status_, feedback_, result_;
  ros::Subscriber goal_subscriber_, cancel_subscriber_;
  ros::WallTimer timer_;
};

}  // namespace object_modelling::nodes
