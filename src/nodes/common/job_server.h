#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <actionlib/server/action_server.h>

#include "object_modelling/base/job_control.h"
#include "object_modelling/ros_bridge/status_conversion.h"
#include "progress_publisher.h"

namespace object_modelling::nodes
{
/// A long job as an action: one at a time, on a thread of its own; a second goal is rejected with the reason instead of
/// pushing the first one aside. Its result begins with `status`; what the work throws becomes that status. Progress
/// goes out as feedback and on the latched ~progress. The destructor cancels the job and waits for it.
template <typename Action>
class JobServer
{
public:
  ACTION_DEFINITION(Action)
  /// Called on the job's thread. `describe` names a goal for people ("refine session_1").
  using Work = std::function<Result(const Goal&, base::JobControl&)>;
  using Describe = std::function<std::string(const Goal&)>;
  using Server = actionlib::ActionServer<Action>;
  using GoalHandle = typename Server::GoalHandle;

  JobServer(ros::NodeHandle& private_node, const std::string& name, Describe describe, Work work)
      : describe_(std::move(describe)),
        work_(std::move(work)),
        progress_(private_node),
        server_(
            private_node, name, [this](GoalHandle goal) { accept(goal); }, [this](GoalHandle goal) { cancel(goal); },
            false)
  {
    server_.start();
  }
  ~JobServer()
  {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      closing_ = true;
      if (control_)
        control_->cancel();
    }
    if (thread_.joinable())
      thread_.join();
  }

private:
  void accept(GoalHandle goal)
  {
    std::lock_guard<std::mutex> lock(mutex_);
    if (control_ || closing_)
    {
      const base::Status busy(base::StatusCode::FAILED_PRECONDITION,
                              "busy with '" + job_ + "': wait until ~progress says that it has ended, or cancel it");
      Result result;
      result.status = ros_bridge::toMessage(busy);
      goal.setRejected(result, busy.message);
      return;
    }
    if (thread_.joinable())
      thread_.join();  // has ended, or it would still hold control_
    job_ = describe_(*goal.getGoal());
    goal_ = goal;
    goal_.setAccepted();
    progress_.begin(job_);
    control_ = std::make_unique<base::JobControl>([this](const base::Progress& progress) { report(progress); });
    thread_ = std::thread([this] { run(); });
  }

  void cancel(GoalHandle goal)
  {
    std::lock_guard<std::mutex> lock(mutex_);
    if (control_ && goal == goal_)
      control_->cancel();
  }

  void report(const base::Progress& progress)
  {
    if (!progress_.report(progress))
      return;
    Feedback feedback;
    feedback.stage = progress.stage;
    feedback.done = static_cast<std::uint32_t>(progress.done);
    feedback.total = static_cast<std::uint32_t>(progress.total);
    goal_.publishFeedback(feedback);
  }

  void run()
  {
    Result result;
    const base::Status thrown = ros_bridge::guarded([&] { result = work_(*goal_.getGoal(), *control_); });
    if (!thrown.ok())
      result.status = ros_bridge::toMessage(thrown);
    const base::Status status = ros_bridge::fromMessage(result.status);
    GoalHandle goal;
    {
      std::lock_guard<std::mutex> lock(mutex_);
      goal = goal_;
      progress_.end(status);
      control_.reset();
    }
    // Last: whoever sees the result may send the next goal.
    if (status.ok())
      goal.setSucceeded(result);
    else if (status.code == base::StatusCode::CANCELLED)
      goal.setCanceled(result, status.message);
    else
      goal.setAborted(result, status.message);
  }

  Describe describe_;
  Work work_;
  ProgressPublisher progress_;
  std::mutex mutex_;  ///< guards control_, goal_, job_, closing_; the job's thread reads goal_ while control_ is set
  std::unique_ptr<base::JobControl> control_;  ///< set while a job runs
  bool closing_ = false;
  std::string job_;
  GoalHandle goal_;
  std::thread thread_;
  Server server_;
};

}  // namespace object_modelling::nodes
