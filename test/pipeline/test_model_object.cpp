#include "object_modelling/pipeline/model_object.h"

#include <gtest/gtest.h>

#include <map>

namespace object_modelling::pipeline
{
namespace
{
std::string joined(const std::vector<std::string>& words)
{
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : " ") + word;
  return text;
}

/// Writes down what is asked of it.
class NotedStages : public ModelStages
{
public:
  explicit NotedStages(const std::vector<keyframes::Session>& sessions)
  {
    for (const keyframes::Session& session : sessions)
      sessions_[session.id] = session;
  }
  keyframes::Session session(const std::string& session_id) override { return sessions_.at(session_id); }
  void refine(const std::vector<std::string>& session_ids, base::JobControl&) override
  {
    note("refine " + joined(session_ids));
    if (!segmented_meanwhile.empty())
      sessions_[segmented_meanwhile].segmented.by = keyframes::stage_mark::BY_HAND;
  }
  void segment(const std::vector<std::string>& session_ids, base::JobControl&) override
  {
    note("segment " + joined(session_ids));
  }
  AlignedSessions align(const std::vector<std::string>& session_ids, base::JobControl&) override
  {
    note("align " + joined(session_ids));
    return aligned;
  }
  base::Status build(const AlignedSessions& from, base::JobControl&) override
  {
    built_from = from;
    note("build");
    return build_status;
  }
  void onStage(const std::string& stage) override
  {
    stages.push_back(stage);
    if (stage == cancels_before)
      control->cancel();
  }

  std::vector<std::string> notes, stages;
  std::string fails_at, segmented_meanwhile, cancels_before;
  base::JobControl* control = nullptr;
  AlignedSessions aligned, built_from;
  base::Status build_status;

private:
  void note(const std::string& what)
  {
    notes.push_back(what);
    if (what == fails_at)
      throw base::Error(base::StatusCode::NO_RESULT, what + " failed");
  }
  std::map<std::string, keyframes::Session> sessions_;
};

keyframes::Session sessionOf(const std::string& id, const std::string& refined_by, const std::string& segmented_by)
{
  keyframes::Session session;
  session.id = id;
  session.refined.by = refined_by;
  session.segmented.by = segmented_by;
  return session;
}

using Notes = std::vector<std::string>;

/// Two sessions that nothing was done to.
NotedStages newSessions()
{
  return NotedStages({ sessionOf("a", "", ""), sessionOf("b", "", "") });
}

/// 'b' does not fit 'a'.
void leaveOut(NotedStages* stages)
{
  stages->aligned.status.message = "left out: b";
  stages->aligned.placements = { { "a", Eigen::Isometry3d::Identity() } };
  stages->aligned.left_out = { { "b", "with 'a': too little" } };
}

ModelOutcome modelOf(NotedStages& stages, bool again = false)
{
  base::JobControl control;
  return modelObject(stages, { "a", "b" }, again, control);
}
}  // namespace

TEST(ModelObject, TakesWhatIsNewThroughAllStagesInOrder)
{
  NotedStages stages = newSessions();
  stages.build_status.message = "no report";
  const ModelOutcome outcome = modelOf(stages);
  EXPECT_EQ(stages.notes, (Notes{ "refine a b", "segment a b", "align a b", "build" }));
  EXPECT_EQ(stages.stages, (Notes{ "refine", "segment", "align", "build" }));
  Notes timed;
  for (const StageTime& time : outcome.stages)
    timed.push_back(time.stage);
  EXPECT_EQ(timed, stages.stages);
  EXPECT_TRUE(outcome.built);
  EXPECT_EQ(outcome.status.message, "no report");
  EXPECT_TRUE(outcome.unchanged.empty());
}

TEST(ModelObject, LeavesWhatIsDoneUnlessAgain)
{
  NotedStages stages(
      { sessionOf("a", "multi_view_icp", "by_hand"), sessionOf("b", "unknown", ""), sessionOf("c", "", "automatic") });
  Notes reports;
  base::JobControl control([&](const base::Progress& progress) { reports.push_back(progress.stage); });
  EXPECT_EQ(modelObject(stages, { "a", "b", "c" }, false, control).unchanged, Notes{ "a" });
  EXPECT_EQ(stages.notes, (Notes{ "refine c", "segment b", "align a b c", "build" }));
  EXPECT_EQ(reports, (Notes{ "as before: a, b", "as before: a, c" }));
  stages.notes.clear();
  EXPECT_TRUE(modelOf(stages, true).unchanged.empty());
  EXPECT_EQ(stages.notes, (Notes{ "refine a b", "segment a b", "align a b", "build" }));
}

TEST(ModelObject, TellsOfStagesWithNothingToDo)
{
  NotedStages stages({ sessionOf("a", "both", "automatic"), sessionOf("b", "both", "automatic") });
  EXPECT_EQ(modelOf(stages).stages.size(), 4u);
  EXPECT_EQ(stages.stages, (Notes{ "refine", "segment", "align", "build" }));
  EXPECT_EQ(stages.notes, (Notes{ "align a b", "build" }));
}

TEST(ModelObject, LeavesWhatAPersonSegmentedDuringRefinement)
{
  NotedStages stages = newSessions();
  stages.segmented_meanwhile = "b";
  EXPECT_TRUE(modelOf(stages).unchanged.empty());
  EXPECT_EQ(stages.notes, (Notes{ "refine a b", "segment a", "align a b", "build" }));
}

TEST(ModelObject, AFailedStageIsTheLast)
{
  for (const std::string stage : { "refine a b", "segment a b", "align a b", "build" })
  {
    NotedStages stages = newSessions();
    stages.fails_at = stage;
    EXPECT_THROW(modelOf(stages), base::Error);
    EXPECT_EQ(stages.notes.back(), stage);
  }
}

TEST(ModelObject, CancelEndsItBeforeTheNextStage)
{
  NotedStages stages = newSessions();
  base::JobControl control;
  stages.control = &control;
  stages.cancels_before = "align";
  EXPECT_THROW(modelObject(stages, { "a", "b" }, false, control), base::Cancelled);
  EXPECT_EQ(stages.stages.back(), "align");
  EXPECT_EQ(stages.notes, (Notes{ "refine a b", "segment a b" }));
}

TEST(ModelObject, BuildsNothingOfWhatDoesNotFit)
{
  NotedStages stages({ sessionOf("a", "both", "automatic"), sessionOf("b", "both", "automatic") });
  stages.aligned.status = { base::StatusCode::NO_RESULT, "do not fit" };
  const ModelOutcome outcome = modelOf(stages);
  EXPECT_EQ(stages.notes, Notes{ "align a b" });
  EXPECT_FALSE(outcome.built);
  EXPECT_EQ(outcome.status.code, base::StatusCode::NO_RESULT);
  EXPECT_EQ(outcome.status.message, "do not fit");
}

TEST(ModelObject, WhatIsLeftOutReachesTheBuilderAndTheStatus)
{
  NotedStages stages = newSessions();
  leaveOut(&stages);
  EXPECT_EQ(modelOf(stages).status.message, "left out: b");
  ASSERT_EQ(stages.built_from.left_out.size(), 1u);
  EXPECT_EQ(stages.built_from.left_out[0].id, "b");
  ASSERT_EQ(stages.built_from.placements.size(), 1u);
  EXPECT_EQ(stages.built_from.placements[0].session_id, "a");
  stages.build_status.message = "PARTIAL";
  const ModelOutcome outcome = modelOf(stages);
  EXPECT_TRUE(outcome.built);
  EXPECT_EQ(outcome.status.message, "PARTIAL; left out: b");
}

TEST(ModelObject, ABuildThatFailsTellsWhatWasLeftOut)
{
  NotedStages stages = newSessions();
  leaveOut(&stages);
  stages.build_status = { base::StatusCode::NO_RESULT, "too little seen" };
  const ModelOutcome outcome = modelOf(stages);
  EXPECT_FALSE(outcome.built);
  EXPECT_EQ(outcome.status.code, base::StatusCode::NO_RESULT);
  EXPECT_EQ(outcome.status.message, "too little seen; left out: b");
  stages.fails_at = "build";
  try
  {
    modelOf(stages);
    FAIL() << "built";
  }
  catch (const base::Error& error)
  {
    EXPECT_EQ(error.code(), base::StatusCode::NO_RESULT);
    EXPECT_STREQ(error.what(), "build failed; left out: b");
  }
  stages.fails_at.clear();
  stages.build_status = { base::StatusCode::CANCELLED, "cancelled" };
  EXPECT_EQ(modelOf(stages).status.message, "cancelled");
}

}  // namespace object_modelling::pipeline
