// Sessions that do not fit each other, through the manager and the nodes that it calls.
#include <gtest/gtest.h>
#include <object_modelling/AcceptAlignment.h>
#include <object_modelling/BuildObject.h>

#include "job_fixture.h"

namespace object_modelling::nodes
{
namespace
{
constexpr char OBJECT[] = "odd_pair";

test_support::SyntheticScene flatBoxOnTable()
{
  test_support::SyntheticScene scene = test_support::boxOnTable();
  scene.objects = { test_support::standingBox({ 0.16, 0.05, 0.05 }, 0, 0, 0, 9) };
  return scene;
}

object_modelling::BuildObject::Response buildObject(bool require_all)
{
  object_modelling::BuildObject service;
  service.request.object_id = OBJECT;
  service.request.wait = true;
  service.request.require_all = require_all;
  EXPECT_TRUE(ros::service::waitForService("modelling_manager/build_object", ros::Duration(PATIENCE_S)));
  EXPECT_TRUE(callService("modelling_manager/build_object", service));
  return service.response;
}
}  // namespace

TEST_F(JobsTest, ARefusedPairGivesAPartialObjectAndAWholeOneOnceAccepted)
{
  record(store_, "tall", 14, test_support::boxOnTable(), OBJECT);
  record(store_, "flat", 14, flatBoxOnTable(), OBJECT);
  const object_modelling::BuildObject::Response refused = buildObject(true);
  EXPECT_STATUS(Status::NO_RESULT, "align: ", refused);
  for (const object_modelling::ObjectSummary& object : list().objects)
    EXPECT_NE(object.object_id, OBJECT);

  const object_modelling::BuildObject::Response partial = buildObject(false);
  EXPECT_STATUS(Status::OK, "PARTIAL: object 'odd_pair' is built from 1 of its 2 sessions, without 'flat'", partial);
  EXPECT_NE(partial.status.message.find("/session_aligner/accept"), std::string::npos) << partial.status.message;
  EXPECT_NE(partial.status.message.find("alignment_review.launch"), std::string::npos) << partial.status.message;
  EXPECT_TRUE(partial.built.partial);
  ASSERT_EQ(partial.built.left_out.size(), 1u);
  EXPECT_EQ(partial.built.left_out[0].session_id, "flat");
  EXPECT_NE(partial.built.left_out[0].reason.find("with 'tall': "), std::string::npos);
  for (const object_modelling::ObjectSummary& object : list().objects)
    if (object.object_id == OBJECT)
    {
      EXPECT_TRUE(object.partial);
      ASSERT_EQ(object.left_out.size(), 1u);
      EXPECT_EQ(object.left_out[0].session_id, "flat");
    }

  object_modelling::AcceptAlignment accept;
  accept.request.session_a = "tall";
  accept.request.session_b = "flat";
  ASSERT_EQ(called("accept", accept).status.code, Status::OK) << accept.response.status.message;
  const object_modelling::BuildObject::Response whole = buildObject(true);
  ASSERT_EQ(whole.status.code, Status::OK) << whole.status.message;
  EXPECT_FALSE(whole.built.partial);
  EXPECT_TRUE(whole.built.left_out.empty());
  for (const object_modelling::ObjectSummary& object : list().objects)
    if (object.object_id == OBJECT)
    {
      EXPECT_FALSE(object.partial);
      EXPECT_EQ(object.session_ids.size(), 2u);
    }
}

TEST_F(JobsTest, AlignTellsWhatIsRequired)
{
  object_modelling::AlignGoal goal;
  goal.session_ids = { "any" };
  goal.required = 9;
  EXPECT_STATUS(Status::INVALID_ARGUMENT, "required 9",
                Job<object_modelling::AlignAction>("session_aligner/align").run(goal));
}

}  // namespace object_modelling::nodes
