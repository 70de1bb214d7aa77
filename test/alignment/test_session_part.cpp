#include "object_modelling/alignment/session_part.h"

#include <gtest/gtest.h>

#include "object_modelling/alignment/pair_alignment.h"
#include "object_modelling/base/status.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::alignment
{
namespace
{
class SessionPart : public testing::Test
{
protected:
  registration::PartialModel part() const
  {
    base::JobControl control;
    return makePartialModel(session_, keyframes_, {}, control);
  }
  /// Moves a keyframe to where it was not; `known`: without saying so.
  void mislead(std::size_t index, bool known)
  {
    rgbd::Keyframe& keyframe = keyframes_[index];
    keyframe.T_session_camera = Eigen::Translation3d(0.03, 0, 0.02) * keyframe.T_session_camera;
    keyframe.covariance = (known ? 1e-6 : 1e-2) * geometry::Matrix6d::Identity();
  }

  keyframes::Session session_ = []
  {
    keyframes::Session session;
    session.id = "mug_1";
    session.support_plane_session = geometry::Plane{ Eigen::Vector3d::UnitZ(), 0 };
    return session;
  }();
  std::vector<rgbd::Keyframe> keyframes_ = test_support::renderKeyframes(
      test_support::boxOnTable(), test_support::smallCamera(), test_support::orbitPoses(8, { 0, 0, 0.1 }, 0.6));
};
}  // namespace

TEST_F(SessionPart, NamesTheSessionWithoutAnObject)
{
  for (rgbd::Keyframe& keyframe : keyframes_)
    keyframe.frame.object_mask.release();
  try
  {
    part();
    FAIL() << "no mask, and no error";
  }
  catch (const base::Error& error)
  {
    EXPECT_EQ(error.code(), base::StatusCode::FAILED_PRECONDITION);
    EXPECT_NE(std::string(error.what()).find("'mug_1' has no object mask"), std::string::npos) << error.what();
  }
}

TEST_F(SessionPart, KeyframesWhosePosesAreNotKnownHaveNoPartInIt)
{
  std::vector<rgbd::Keyframe> all = keyframes_;
  keyframes_.erase(keyframes_.begin() + 3);
  const registration::PartialModel without = part();
  keyframes_ = all;
  mislead(3, false);
  const registration::PartialModel found = part();
  EXPECT_EQ(found.points, without.points);
  EXPECT_TRUE(found.doubt.empty()) << found.doubt;
  // One that seems to be known shows what it sees.
  keyframes_ = all;
  mislead(3, true);
  EXPECT_NE(part().points, without.points);
}

TEST_F(SessionPart, MostlyUnknownOneJoinsNoOtherByItself)
{
  const registration::PartialModel sure = part();
  for (std::size_t i = 1; i < 7; ++i)
    keyframes_[i].covariance = 1e-2 * geometry::Matrix6d::Identity();
  const registration::PartialModel doubtful = part();
  EXPECT_EQ(doubtful.points, sure.points);
  EXPECT_NE(doubtful.doubt.find("'mug_1'"), std::string::npos) << doubtful.doubt;
  PairAlignmentOptions options;
  options.same_pose_probability = 0.5;
  base::JobControl control;
  EXPECT_TRUE(alignPair(sure, sure, options, control).accepted);
  for (const PairAlignment& pair :
       { alignPair(sure, doubtful, options, control), alignPair(doubtful, sure, options, control) })
  {
    EXPECT_FALSE(pair.accepted);
    EXPECT_EQ(pair.reason, doubtful.doubt);
    EXPECT_FALSE(pair.candidates.empty()) << "a person may accept it";
  }
}
}  // namespace object_modelling::alignment
