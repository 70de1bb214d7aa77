// What a server may do to a goal that the manager sends: every case must end, and say why.
#include "nodes/manager/action_caller.h"

#include <gtest/gtest.h>

#include "scripted_server.h"

namespace object_modelling::nodes
{
namespace
{
using object_modelling::Status;
using GoalStatus = actionlib_msgs::GoalStatus;
using Refine = object_modelling::RefineAction;

constexpr double SILENCE_S = 1;

class ActionCallerTest : public ::testing::Test
{
protected:
  ActionCallerTest() : name_(::testing::UnitTest::GetInstance()->current_test_info()->name()) {}

  object_modelling::RefineResult run(base::JobControl& control, const std::string& prefix = "")
  {
    ActionCaller<Refine> caller(node_, name_, { 5, SILENCE_S });
    caller.connect();
    return caller.run({}, control, prefix);
  }
  object_modelling::RefineResult run()
  {
    base::JobControl control;
    return run(control);
  }
  void expectGone(const std::string& part)
  {
    try
    {
      run();
      FAIL() << "ended, expected: " << part;
    }
    catch (const base::Error& error)
    {
      EXPECT_EQ(error.code(), base::StatusCode::TIMEOUT);
      EXPECT_NE(std::string(error.what()).find("action '/" + name_ + "' does not answer"), std::string::npos)
          << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }

  ros::NodeHandle node_;
  std::string name_;
};
}  // namespace

TEST_F(ActionCallerTest, GoalsThatEndAtOnce)
{
  ScriptedServer server(node_, name_,
                        [](ScriptedServer& self, const std::string& goal)
                        { self.end(goal, GoalStatus::SUCCEEDED, Status::OK, "made"); });
  ActionCaller<Refine> caller(node_, name_, { 5, SILENCE_S });
  caller.connect();
  base::JobControl control;
  for (int i = 0; i < 200; ++i)
    ASSERT_EQ(caller.run({}, control).status.message, "made") << "goal " << i;
}

TEST_F(ActionCallerTest, FeedbackIsReportedWithItsPrefix)
{
  base::JobControl control;
  std::vector<std::string> stages;
  base::JobControl reported(
      [&](const base::Progress& progress)
      {
        if (stages.empty() || stages.back() != progress.stage)
          stages.push_back(progress.stage);
        if (progress.total == 2)
          control.cancel();
      });
  ScriptedServer server(node_, name_,
                        [&](ScriptedServer& self, const std::string& goal)
                        {
                          self.tell(goal, GoalStatus::ACTIVE);
                          ros::WallDuration(0.2).sleep();
                          self.feedBack(goal, "step");
                          while (!control.cancelled())
                            ros::WallDuration(0.01).sleep();
                          self.end(goal, GoalStatus::SUCCEEDED, Status::OK);
                        });
  EXPECT_EQ(run(reported, "1 of 2").status.code, Status::OK);
  EXPECT_EQ(stages, (std::vector<std::string>{ "1 of 2", "1 of 2, step" }));
}

TEST_F(ActionCallerTest, GoalThatIsRejected)
{
  ScriptedServer server(node_, name_,
                        [](ScriptedServer& self, const std::string& goal)
                        { self.end(goal, GoalStatus::REJECTED, Status::FAILED_PRECONDITION, "busy"); });
  EXPECT_EQ(run().status.message, "busy");
}

TEST_F(ActionCallerTest, ServerThatIsNotThere)
{
  ActionCaller<Refine> caller(node_, name_, { 0.3, SILENCE_S });
  caller.connect();
  base::JobControl control;
  EXPECT_THROW(caller.run({}, control), base::Error);
}

TEST_F(ActionCallerTest, GoalThatNeverArrives)
{
  ScriptedServer server(node_, name_, [](ScriptedServer&, const std::string&) {});
  expectGone("did not take the goal within 1 s");
}

TEST_F(ActionCallerTest, ServerThatFallsSilent)
{
  ScriptedServer server(node_, name_,
                        [](ScriptedServer& self, const std::string& goal)
                        {
                          self.tell(goal, GoalStatus::ACTIVE);
                          self.silence();
                        });
  expectGone("silent for 1 s while it worked");
}

TEST_F(ActionCallerTest, ServerThatIsRestarted)
{
  ScriptedServer server(node_, name_,
                        [](ScriptedServer& self, const std::string& goal)
                        {
                          self.tell(goal, GoalStatus::ACTIVE);
                          self.forget();
                        });
  expectGone("its node was restarted while it worked");
}

TEST_F(ActionCallerTest, ResultThatIsLost)
{
  ScriptedServer server(node_, name_,
                        [](ScriptedServer& self, const std::string& goal) { self.tell(goal, GoalStatus::SUCCEEDED); });
  expectGone("did not tell the result within 1 s");
}

TEST_F(ActionCallerTest, CancelReachesTheServer)
{
  base::JobControl control;
  ScriptedServer server(node_, name_,
                        [&](ScriptedServer& self, const std::string& goal)
                        {
                          self.tell(goal, GoalStatus::ACTIVE);
                          control.cancel();
                        });
  std::atomic<bool> cancelled{ false };
  server.on_cancel = [&](ScriptedServer& self, const std::string& goal)
  {
    cancelled = true;
    self.end(goal, GoalStatus::PREEMPTED, Status::CANCELLED);
  };
  EXPECT_THROW(run(control), base::Cancelled);
  EXPECT_TRUE(cancelled);
}

TEST_F(ActionCallerTest, WhatHadEndedBeforeTheCancelCounts)
{
  base::JobControl control;
  ScriptedServer server(node_, name_,
                        [&](ScriptedServer& self, const std::string& goal)
                        {
                          self.tell(goal, GoalStatus::ACTIVE);
                          control.cancel();
                        });
  server.on_cancel = [](ScriptedServer& self, const std::string& goal)
  { self.end(goal, GoalStatus::SUCCEEDED, Status::OK, "made"); };
  EXPECT_EQ(run(control).status.message, "made");
}

TEST_F(ActionCallerTest, CancelThatNobodyHears)
{
  base::JobControl control;
  ScriptedServer server(node_, name_,
                        [&](ScriptedServer& self, const std::string& goal)
                        {
                          self.tell(goal, GoalStatus::ACTIVE);
                          control.cancel();
                        });
  const ros::WallTime start = ros::WallTime::now();
  EXPECT_THROW(run(control), base::Cancelled);
  EXPECT_LT((ros::WallTime::now() - start).toSec(), SILENCE_S + 5);
}

}  // namespace object_modelling::nodes

int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_action_caller");
  ros::NodeHandle node;
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}
