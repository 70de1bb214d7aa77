#include "object_modelling/alignment/session_alignment.h"

#include <gtest/gtest.h>

namespace object_modelling::alignment
{
namespace
{
keyframes::Session session(const std::string& id)
{
  keyframes::Session result;
  result.id = id;
  return result;
}

TEST(SessionAlignment, PlacesOneSessionAtIdentity)
{
  base::JobControl control;
  const AlignmentResult result = alignSessions({ session("mug_1") }, control);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  ASSERT_EQ(result.placements.size(), 1u);
  EXPECT_EQ(result.placements[0].session_id, "mug_1");
  EXPECT_TRUE(result.placements[0].T_reference_session.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(result.edges.empty());
}

TEST(SessionAlignment, RefusesSeveralSessionsAndNamesThem)
{
  base::JobControl control;
  const AlignmentResult result = alignSessions({ session("mug_1"), session("mug_2") }, control);
  EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(result.status.message.find("'mug_1', 'mug_2'"), std::string::npos) << result.status.message;
  EXPECT_TRUE(result.placements.empty()) << "unaligned sessions must not be placed";
}

TEST(SessionAlignment, RefusesNoSession)
{
  base::JobControl control;
  EXPECT_EQ(alignSessions({}, control).status.code, base::StatusCode::INVALID_ARGUMENT);
}

TEST(SessionAlignment, StopsWhenCancelled)
{
  base::JobControl control;
  control.cancel();
  EXPECT_THROW(alignSessions({ session("mug_1") }, control), base::Cancelled);
}

}  // namespace
}  // namespace object_modelling::alignment
