#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "object_modelling/rgbd/pose_certainty.h"

namespace object_modelling::rgbd
{
namespace
{
constexpr float DEPTH_M = 0.5F;

/// A view from afar in the world that is unsure by the sigmas given, each along one axis of its own camera.
View view(double translation_m, double rotation_rad)
{
  View view;
  view.frame.depth_m = cv::Mat(32, 32, CV_32FC1, cv::Scalar(DEPTH_M));
  geometry::Vector6d x;
  x << 3, -2, 1, 0.7, -0.3, 2;
  view.T_world_camera = geometry::isometryFromVector(x);
  geometry::Matrix6d camera = geometry::Matrix6d::Zero();
  camera(1, 1) = translation_m * translation_m;
  camera(5, 5) = rotation_rad * rotation_rad;
  const geometry::Matrix6d adjoint = geometry::adjoint(view.T_world_camera);
  view.covariance = adjoint * camera * adjoint.transpose();
  return view;
}
}  // namespace

TEST(PoseCertainty, SigmasAreThoseInTheCameraFrame)
{
  const View at = view(0.004, 0.015);
  const PoseSigma sigma = poseSigma(inCameraFrame(at.covariance, at.T_world_camera));
  EXPECT_NEAR(sigma.translation_m, 0.004, 1e-9);
  EXPECT_NEAR(sigma.rotation_rad, 0.015, 1e-9);
  EXPECT_EQ(sigma.text(), "4 mm, 15 mrad");
}

TEST(PoseCertainty, BoundsGoWithTheDepth)
{
  EXPECT_TRUE((PoseSigma{ 0.0099, 0.0199 }.isKnown(0.5)));
  EXPECT_FALSE((PoseSigma{ 0.0101, 0 }.isKnown(0.5)));
  EXPECT_TRUE((PoseSigma{ 0.0101, 0 }.isKnown(1.0)));
  EXPECT_FALSE((PoseSigma{ 0, 0.0201 }.isKnown(10)));
  EXPECT_FALSE((PoseSigma{ std::nan(""), 0 }.isKnown(1)));
}

TEST(PoseCertainty, FewUnknownOnesAreLeftOutAndNamed)
{
  const std::vector<View> views{ view(0.001, 0.001), view(0.015, 0.001), view(0.001, 0.04), view(0.002, 0.003),
                                 view(0.001, 0.002) };
  const PathCertainty path = pathCertainty(views);
  EXPECT_EQ(path.unknown, (std::vector<std::size_t>{ 1, 2 }));
  EXPECT_FALSE(path.doubtful);
  EXPECT_EQ(knownViews(path, views.size()), (std::vector<std::size_t>{ 0, 3, 4 }));
  const std::string text = describe(path, { 4, 7, 9, 12, 13 }, "box_1");
  EXPECT_EQ(text,
            "session 'box_1': where the camera was is not known for 2 of 5 keyframes (7, 9; unsure by up to 15 mm, 40 "
            "mrad), which are left out: record again with something textured under or beside the object");
}

TEST(PoseCertainty, OfMostlyUnknownOnesNoneIsBetterThanOthers)
{
  const std::vector<View> views{ view(0.001, 0.001), view(0.015, 0.001), view(0.001, 0.04) };
  const PathCertainty path = pathCertainty(views);
  EXPECT_TRUE(path.doubtful);
  EXPECT_EQ(knownViews(path, views.size()).size(), 3u);
  const std::string text = describe(path, { 0, 1, 2 }, "box_1");
  EXPECT_EQ(text.find("left out"), std::string::npos) << text;
  EXPECT_NE(text.find("record again"), std::string::npos) << text;
}

TEST(PoseCertainty, FewerThanTwoAreNotASession)
{
  const PathCertainty path = pathCertainty({ view(0.001, 0.001), view(0.015, 0.001) });
  EXPECT_TRUE(path.doubtful);
  EXPECT_EQ(knownViews(path, 2).size(), 2u);
  EXPECT_FALSE(pathCertainty({ view(0.001, 0.001) }).doubtful);
}

TEST(PoseCertainty, WhatIsNotToldIsBelievedAndNonsenseIsNot)
{
  std::vector<View> views(3, view(0, 0));
  EXPECT_TRUE(pathCertainty(views).allKnown()) << "first keyframes, and old stores, have no covariance";
  EXPECT_TRUE(describe(pathCertainty(views), { 0, 1, 2 }, "s").empty());
  EXPECT_TRUE(pathCertainty({}).allKnown());
  views[1].covariance.setConstant(std::nan(""));
  EXPECT_EQ(pathCertainty(views).unknown, (std::vector<std::size_t>{ 1 }));
  views[1] = view(1e8, 0);
  EXPECT_EQ(pathCertainty(views).worst.text(), "1000000 mm, 0 mrad");
  views[1].covariance = -1e-6 * geometry::Matrix6d::Identity();
  EXPECT_EQ(pathCertainty(views).unknown, (std::vector<std::size_t>{ 1 })) << "no covariance at all";
}

TEST(PoseCertainty, DepthIsThatOfTheObject)
{
  // 8 mm at 0.5 m are known; at 0.3 m, where the object is, they are not.
  View at = view(0.008, 0);
  const std::vector<View> others(2, view(0.001, 0));
  EXPECT_TRUE(pathCertainty({ others[0], others[1], at }).allKnown());
  at.frame.depth_m(cv::Rect(8, 8, 16, 16)) = 0.3F;
  at.frame.object_mask = cv::Mat::zeros(32, 32, CV_8UC1);
  at.frame.object_mask(cv::Rect(8, 8, 16, 16)) = 255;
  EXPECT_EQ(pathCertainty({ others[0], others[1], at }).unknown, (std::vector<std::size_t>{ 2 }));
}
}  // namespace object_modelling::rgbd
