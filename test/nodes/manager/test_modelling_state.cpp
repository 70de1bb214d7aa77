// Every order of calls and tracker reports that a user can produce, without ROS.
#include "nodes/manager/modelling_state.h"

#include <functional>

#include <gtest/gtest.h>

namespace object_modelling::nodes
{
namespace
{
void expectRefused(const std::string& part, const std::function<void()>& call)
{
  try
  {
    call();
    FAIL() << "not refused: " << part;
  }
  catch (const base::Error& error)
  {
    EXPECT_EQ(error.code(), base::StatusCode::FAILED_PRECONDITION);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

void expectNoChange(const ModellingState::Change& change)
{
  EXPECT_FALSE(change.changed);
  EXPECT_TRUE(change.status.ok()) << change.status.message;
}
}  // namespace

TEST(ModellingState, StopBeforeStart)
{
  const ModellingState state;
  expectRefused("none has been recorded yet", [&] { state.checkCanStop(); });
}

TEST(ModellingState, StopTwiceNamesTheLastSession)
{
  ModellingState state;
  state.started("s1");
  state.checkCanStop();
  state.stopped(7);
  EXPECT_EQ(state.keyframeCount(), 7);
  expectRefused("'s1'", [&] { state.checkCanStop(); });
}

TEST(ModellingState, StartTwice)
{
  ModellingState state;
  state.checkCanStart();
  state.started("s1");
  expectRefused("session 's1' is being recorded", [&] { state.checkCanStart(); });
}

TEST(ModellingState, BuildWhileRecording)
{
  ModellingState state;
  state.started("s1");
  expectRefused("stop_session before building 'mug'", [&] { state.beginBuild("mug"); });
}

TEST(ModellingState, EverythingButCancelIsRefusedWhileBuilding)
{
  ModellingState state;
  state.beginBuild("mug");
  EXPECT_EQ(state.phase(), ManagerPhase::BUILDING);
  expectRefused("while object 'mug' is being built (stage 'beginning')", [&] { state.checkCanStart(); });
  EXPECT_TRUE(state.enterStage("refine"));
  EXPECT_FALSE(state.enterStage("refine"));
  expectRefused("while object 'mug' is being built (stage 'refine')", [&] { state.beginBuild("cup"); });
  expectRefused("while object 'mug' is being built", [&] { state.sessionToDiscard("s1"); });
  expectRefused("no session is being recorded", [&] { state.checkCanStop(); });
  EXPECT_NO_THROW(state.checkCanCancel());
  EXPECT_EQ(state.objectId(), "mug");
  state.endBuild();
  EXPECT_EQ(state.phase(), ManagerPhase::IDLE);
  EXPECT_EQ(state.stage(), "");
}

TEST(ModellingState, CancelWithoutBuild)
{
  ModellingState state;
  expectRefused("nothing to cancel", [&] { state.checkCanCancel(); });
  state.started("s1");
  expectRefused("discard_session", [&] { state.checkCanCancel(); });
}

TEST(ModellingState, Discard)
{
  ModellingState state;
  expectRefused("name the session", [&] { state.sessionToDiscard(""); });
  state.started("s1");
  EXPECT_EQ(state.sessionToDiscard(""), "s1");
  EXPECT_TRUE(state.isRecording("s1"));
  state.discarded("s1");
  EXPECT_EQ(state.phase(), ManagerPhase::IDLE);
  expectRefused("name the session", [&] { state.sessionToDiscard(""); });
}

TEST(ModellingState, DiscardingAnotherSessionLeavesTheRecordingAlone)
{
  ModellingState state;
  state.started("s2");
  state.discarded("s1");
  EXPECT_TRUE(state.isRecording("s2"));
}

TEST(TrackerReport, OldOneAfterStartIsIgnored)
{
  ModellingState state;
  state.started("s1");
  expectNoChange(state.trackerReported(false, "", 0));
  EXPECT_TRUE(state.isRecording("s1"));
}

TEST(TrackerReport, BeforeTheAnswerToStart)
{
  ModellingState state;
  state.trackerReported(true, "s1", 1);
  state.started("s1");
  EXPECT_EQ(state.keyframeCount(), 1);
  EXPECT_TRUE(state.trackerReported(false, "", 0).changed);
}

TEST(TrackerReport, OldOneAfterStopIsIgnored)
{
  ModellingState state;
  state.started("s1");
  state.trackerReported(true, "s1", 3);
  state.stopped(4);
  state.trackerReported(true, "s1", 4);
  EXPECT_EQ(state.phase(), ManagerPhase::IDLE);
  expectNoChange(state.trackerReported(false, "s1", 4));
  state.trackerReported(true, "s1", 5);  // somebody resumed it without the manager
  EXPECT_EQ(state.phase(), ManagerPhase::RECORDING);
}

TEST(TrackerReport, TheEndThatWasAskedForIsNoSurprise)
{
  ModellingState state;
  state.started("s1");
  state.trackerReported(true, "s1", 3);
  state.ending();
  expectNoChange(state.trackerReported(false, "s1", 3));
  state.stopped(3);
  EXPECT_EQ(state.phase(), ManagerPhase::IDLE);
  state.started("s2");
  state.trackerReported(true, "s2", 1);
  EXPECT_FALSE(state.trackerReported(false, "s2", 1).status.ok());
}

TEST(TrackerReport, KeyframesAreCounted)
{
  ModellingState state;
  state.started("s1");
  const ModellingState::Change counted = state.trackerReported(true, "s1", 2);
  EXPECT_TRUE(counted.changed);
  EXPECT_TRUE(counted.status.ok());
  expectNoChange(state.trackerReported(true, "s1", 2));
  EXPECT_EQ(state.keyframeCount(), 2);
}

TEST(TrackerReport, RecordingStartedAtTheTrackerCanBeStoppedHere)
{
  ModellingState state;
  state.trackerReported(true, "other", 1);
  EXPECT_NO_THROW(state.checkCanStop());
}

TEST(TrackerReport, TrackerRestartedWhileRecording)
{
  ModellingState state;
  state.started("s1");
  state.trackerReported(true, "s1", 3);
  const ModellingState::Change lost = state.trackerReported(false, "", 0);
  EXPECT_TRUE(lost.changed);
  EXPECT_EQ(lost.status.code, base::StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(lost.status.message.find("'s1'"), std::string::npos);
  EXPECT_NO_THROW(state.checkCanStart());
  EXPECT_NO_THROW(state.beginBuild("mug"));
}

TEST(TrackerReport, TrackerGoneAndBack)
{
  ModellingState state;
  state.started("s1");
  state.trackerReported(true, "s1", 3);
  state.trackerLost();
  EXPECT_EQ(state.phase(), ManagerPhase::IDLE);
  state.trackerReported(true, "s1", 4);
  EXPECT_TRUE(state.isRecording("s1"));
}

TEST(TrackerReport, RecordingDoesNotEndABuild)
{
  ModellingState state;
  state.beginBuild("mug");
  state.trackerReported(true, "s9", 1);
  EXPECT_EQ(state.phase(), ManagerPhase::BUILDING);
}

}  // namespace object_modelling::nodes
