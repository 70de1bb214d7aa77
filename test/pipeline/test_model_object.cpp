#include "object_modelling/pipeline/model_object.h"

#include <gtest/gtest.h>

#include <map>

namespace object_modelling::pipeline
{
namespace
{
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
  void refine(const std::string& session_id, base::JobControl&) override { note("refine " + session_id); }
  void segment(const std::string& session_id, base::JobControl&) override { note("segment " + session_id); }
  alignment::AlignmentResult align(const std::vector<std::string>& session_ids, base::JobControl&) override
  {
    note("align " + std::to_string(session_ids.size()));
    alignment::AlignmentResult aligned;
    aligned.status = align_status;
    return aligned;
  }
  BuildReport build(const alignment::AlignmentResult&, base::JobControl&) override
  {
    note("build");
    BuildReport report;
    report.status.message = "built";
    return report;
  }

  std::vector<std::string> notes;
  std::string fails_at;
  base::Status align_status;

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
}  // namespace

TEST(ModelObject, TakesWhatIsNewThroughAllStagesInOrder)
{
  NotedStages stages({ sessionOf("a", "", ""), sessionOf("b", "", "") });
  base::JobControl control;
  const ModelOutcome outcome = modelObject(stages, { "a", "b" }, false, control);
  EXPECT_EQ(stages.notes, (Notes{ "refine a", "refine b", "segment a", "segment b", "align 2", "build" }));
  EXPECT_TRUE(outcome.built);
  EXPECT_EQ(outcome.status.message, "built");
  EXPECT_TRUE(outcome.unchanged.empty());
}

TEST(ModelObject, LeavesWhatIsDoneUnlessAgain)
{
  NotedStages stages(
      { sessionOf("a", "multi_view_icp", "by_hand"), sessionOf("b", "unknown", ""), sessionOf("c", "", "automatic") });
  base::JobControl control;
  EXPECT_EQ(modelObject(stages, { "a", "b", "c" }, false, control).unchanged, Notes{ "a" });
  EXPECT_EQ(stages.notes, (Notes{ "refine c", "segment b", "align 3", "build" }));
  stages.notes.clear();
  EXPECT_TRUE(modelObject(stages, { "a", "b" }, true, control).unchanged.empty());
  EXPECT_EQ(stages.notes, (Notes{ "refine a", "refine b", "segment a", "segment b", "align 2", "build" }));
}

TEST(ModelObject, StopsAtTheFirstFailure)
{
  NotedStages stages({ sessionOf("a", "", ""), sessionOf("b", "", "") });
  stages.fails_at = "segment a";
  base::JobControl control;
  EXPECT_THROW(modelObject(stages, { "a", "b" }, false, control), base::Error);
  EXPECT_EQ(stages.notes.back(), "segment a");
}

TEST(ModelObject, BuildsNothingOfWhatDoesNotFit)
{
  NotedStages stages({ sessionOf("a", "both", "automatic"), sessionOf("b", "both", "automatic") });
  stages.align_status = { base::StatusCode::NO_RESULT, "do not fit" };
  base::JobControl control;
  const ModelOutcome outcome = modelObject(stages, { "a", "b" }, false, control);
  EXPECT_EQ(stages.notes, Notes{ "align 2" });
  EXPECT_FALSE(outcome.built);
  EXPECT_EQ(outcome.status.code, base::StatusCode::NO_RESULT);
  EXPECT_EQ(outcome.status.message, "do not fit");
}

}  // namespace object_modelling::pipeline
