#include "nodes/segmenter/selection.h"

#include <gtest/gtest.h>

namespace object_modelling::nodes
{
namespace
{
segmentation::SceneSegmentation hypothesesAt(const std::vector<Eigen::Vector3d>& centroids)
{
  segmentation::SceneSegmentation segmentation;
  for (const Eigen::Vector3d& centroid : centroids)
  {
    segmentation::Hypothesis hypothesis;
    hypothesis.id = static_cast<int>(segmentation.hypotheses.size());
    hypothesis.centroid_camera = centroid;
    hypothesis.box_camera.T_frame_box.translation() = centroid;
    hypothesis.box_camera.size_m = Eigen::Vector3d::Constant(0.1);
    segmentation.hypotheses.push_back(hypothesis);
  }
  return segmentation;
}

geometry::OrientedBox boxAt(const Eigen::Vector3d& center)
{
  geometry::OrientedBox box;
  box.T_frame_box.translation() = center;
  box.size_m = Eigen::Vector3d::Constant(0.2);
  return box;
}

Eigen::Isometry3d shifted(double x_m)
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation().x() = x_m;
  return T;
}

const Eigen::Vector3d LEFT(-0.3, 0, 1), RIGHT(0.3, 0, 1);
}  // namespace

TEST(Selection, NothingChosen)
{
  const Selection selection(0.05);
  EXPECT_EQ(selection.find(hypothesesAt({ LEFT }), "", {}).status.code, base::StatusCode::FAILED_PRECONDITION);
  EXPECT_FALSE(selection.seed("s"));
}

TEST(Selection, FollowsTheObjectThroughASession)
{
  Selection selection(0.05);
  selection.choose(RIGHT, "s", shifted(0));
  EXPECT_TRUE(selection.seed("s")->isApprox(RIGHT));
  // The camera has moved 0.6 m to the right: what was right of it is left of it now.
  const base::Result<int> found = selection.find(hypothesesAt({ RIGHT, LEFT }), "s", shifted(0.6));
  ASSERT_TRUE(found.ok()) << found.status.message;
  EXPECT_EQ(found.value, 1);
  EXPECT_FALSE(selection.find(hypothesesAt({ LEFT }), "s", shifted(0)).ok());
}

TEST(Selection, ChoiceBeforeTheSessionIsTakenOver)
{
  Selection selection(0.05);
  selection.choose(LEFT, "", {});
  EXPECT_EQ(selection.find(hypothesesAt({ RIGHT, LEFT }), "", {}).value, 1);
  selection.beginSession("s", shifted(2));
  EXPECT_TRUE(selection.seed("s")->isApprox(LEFT + Eigen::Vector3d(2, 0, 0)));
  selection.beginSession("t", shifted(0));
  EXPECT_FALSE(selection.seed("t")) << "a choice belongs to one session";
  EXPECT_TRUE(selection.seed("s"));
}

TEST(Selection, Clear)
{
  Selection selection(0.05);
  selection.choose(LEFT, "s", shifted(0));
  selection.clear();
  EXPECT_FALSE(selection.seed("s"));
}

TEST(Selection, RoiKeepsWhatLiesInIt)
{
  Selection selection(0.05);
  selection.setRoi(boxAt(RIGHT), "", {});
  segmentation::SceneSegmentation segmentation = hypothesesAt({ LEFT, RIGHT });
  selection.applyRoi({}, &segmentation);
  ASSERT_EQ(segmentation.hypotheses.size(), 1u);
  EXPECT_EQ(segmentation.hypotheses[0].id, 0) << "ids count the hypotheses that are left";
  EXPECT_TRUE(segmentation.hypotheses[0].centroid_camera.isApprox(RIGHT));
  EXPECT_TRUE(segmentation.status.ok());
}

TEST(Selection, RoiThatHoldsNothingSaysSo)
{
  Selection selection(0.05);
  selection.setRoi(boxAt({ 0, 0, 3 }), "", {});
  segmentation::SceneSegmentation segmentation = hypothesesAt({ LEFT, RIGHT });
  selection.applyRoi({}, &segmentation);
  EXPECT_EQ(segmentation.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(segmentation.status.message.find("region of interest"), std::string::npos);
}

TEST(Selection, RoiStaysInTheSessionFrame)
{
  Selection selection(0.05);
  selection.setRoi(boxAt(RIGHT), "", {});
  selection.beginSession("s", shifted(1));
  segmentation::SceneSegmentation seen_from_elsewhere = hypothesesAt({ LEFT, RIGHT });
  selection.applyRoi(shifted(1.6), &seen_from_elsewhere);
  ASSERT_EQ(seen_from_elsewhere.hypotheses.size(), 1u);
  EXPECT_TRUE(seen_from_elsewhere.hypotheses[0].centroid_camera.isApprox(LEFT));
  selection.beginSession("t", shifted(0));
  EXPECT_FALSE(selection.roiSet()) << "its frame is gone";
}

TEST(Selection, RoiCanBeSwitchedOff)
{
  Selection selection(0.05);
  selection.setRoi(boxAt(RIGHT), "s", shifted(0));
  selection.setRoi({}, "", {});
  segmentation::SceneSegmentation segmentation = hypothesesAt({ LEFT, RIGHT });
  selection.applyRoi(shifted(0), &segmentation);
  EXPECT_EQ(segmentation.hypotheses.size(), 2u);
}

}  // namespace object_modelling::nodes
