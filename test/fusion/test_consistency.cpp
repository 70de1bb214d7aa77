#include "../../src/fusion/consistency.h"

#include <limits>

#include <gtest/gtest.h>

#include "support/synthetic_scene.h"

namespace object_modelling::fusion
{
namespace
{
/// A view along z from the origin that sees a wall at 1 m, the left half of it masked.
class Wall : public testing::Test
{
protected:
  Wall()
  {
    rgbd::View view;
    view.frame.camera = test_support::vgaCamera();
    view.frame.depth_m = cv::Mat(480, 640, CV_32FC1, cv::Scalar(1));
    view.frame.object_mask = cv::Mat::zeros(480, 640, CV_8UC1);
    view.frame.object_mask.colRange(0, 320).setTo(255);
    views_.push_back(view);
  }
  Votes vote(const Eigen::Vector3f& point, const Eigen::Vector3f& normal = { 0, 0, -1 }) const
  {
    return castVotes(prepareViews(views_), { point, normal, point, 0.001f }, 3.0);
  }

  std::vector<rgbd::View> views_;
};

TEST_F(Wall, UpholdsWhatLiesOnIt)
{
  const Votes on_object = vote({ -0.1f, 0, 1.002f }), on_background = vote({ 0.1f, 0, 0.998f });
  EXPECT_EQ(on_object.same, 1);
  EXPECT_EQ(on_object.object, 1);
  EXPECT_EQ(on_object.background, 0);
  EXPECT_EQ(on_background.same, 1);
  EXPECT_EQ(on_background.background, 1);
}

TEST_F(Wall, SeesThroughWhatFloatsBeforeIt)
{
  const Votes votes = vote({ 0, 0, 0.95f });
  EXPECT_EQ(votes.seen_through, 1);
  EXPECT_EQ(votes.same, 0);
  EXPECT_TRUE(votes.outvoted());
  EXPECT_EQ(vote({ 0, 0, 0.95f }, { 0, 0, 1 }).seen_through, 1) << "whichever way it faces";
}

TEST_F(Wall, KnowsNothingOfWhatItHides)
{
  const Votes votes = vote({ 0, 0, 1.05f });
  EXPECT_EQ(votes.seen_through + votes.same, 0);
}

TEST_F(Wall, DoesNotUpholdASurfaceThatFacesAway)
{
  EXPECT_EQ(vote({ 0, 0, 1 }, { 0, 0, 1 }).same, 0);
}

TEST_F(Wall, KnowsNothingBeyondItsImageAndBehindTheCamera)
{
  for (const Eigen::Vector3f& point : { Eigen::Vector3f(2, 0, 1), Eigen::Vector3f(0, 0, -1), Eigen::Vector3f(0, 0, 0) })
    EXPECT_EQ(vote(point).seen_through + vote(point).same, 0) << point.transpose();
}

TEST_F(Wall, ANeighboringSurfaceIsNotSeenThrough)
{
  // A thin rod at 0.9 m that the lateral noise has moved by one pixel.
  views_[0].frame.depth_m.col(321).setTo(0.9f);
  const auto camera = test_support::vgaCamera();
  EXPECT_EQ(vote(camera.unproject(320, 240, 0.9).cast<float>()).seen_through, 0);
  EXPECT_EQ(vote(camera.unproject(318, 240, 0.9).cast<float>()).seen_through, 1);
}

TEST_F(Wall, NoiseThatReachesTheSurfaceIsNotSeenThrough)
{
  // A post at 0.9 m; a point 5 px beside it that may as well lie on it.
  views_[0].frame.depth_m.colRange(310, 321).setTo(0.9f);
  const auto camera = test_support::vgaCamera();
  const Eigen::Vector3f beside = camera.unproject(325, 240, 0.9).cast<float>();
  const Eigen::Vector3f on_post = camera.unproject(318, 240, 0.9).cast<float>();
  const std::vector<PreparedView> views = prepareViews(views_);
  EXPECT_EQ(castVotes(views, { beside, { 1, 0, 0 }, beside, 0.001f }, 3.0).seen_through, 1);
  EXPECT_EQ(castVotes(views, { beside, { 1, 0, 0 }, on_post, 0.001f }, 3.0).seen_through, 0);
}

TEST_F(Wall, MissingDepthHasNoVote)
{
  views_[0].frame.depth_m.setTo(std::numeric_limits<float>::quiet_NaN());
  const Votes votes = vote({ 0, 0, 0.95f });
  EXPECT_EQ(votes.seen_through + votes.same, 0);
}

TEST_F(Wall, OfManyViewsSomeHaveAVoteEvenly)
{
  views_.resize(200, views_.front());
  EXPECT_EQ(vote({ 0, 0, 1 }).same, 64);
  for (std::size_t k = 100; k < views_.size(); ++k)
    views_[k].frame.depth_m = cv::Mat(480, 640, CV_32FC1, cv::Scalar(2));
  const Votes votes = vote({ 0, 0, 1 });
  EXPECT_EQ(votes.same, 32);
  EXPECT_EQ(votes.seen_through, 32);
}

TEST(Votes, OneWrongViewDoesNotOutvoteTwo)
{
  Votes votes;
  votes.seen_through = 1;
  EXPECT_TRUE(votes.outvoted());
  votes.same = 2;
  EXPECT_FALSE(votes.outvoted());
  votes.seen_through = 2;
  EXPECT_TRUE(votes.outvoted());
}

}  // namespace
}  // namespace object_modelling::fusion
