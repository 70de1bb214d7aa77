// What a person sees and decides of the session_aligner's pairs.
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <object_modelling/AcceptAlignment.h>
#include <object_modelling/AlignByPoints.h>
#include <object_modelling/ForgetAlignment.h>
#include <object_modelling/RefuseAlignment.h>
#include <object_modelling/ShowAlignment.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include "job_fixture.h"

namespace object_modelling::nodes
{
namespace
{
/// The point of a cloud next to a place: rviz picks what is drawn.
Eigen::Vector3f nearestPoint(const sensor_msgs::PointCloud2& cloud, const Eigen::Vector3f& place)
{
  Eigen::Vector3f nearest = Eigen::Vector3f::Constant(1e3F);
  for (sensor_msgs::PointCloud2ConstIterator<float> p(cloud, "x"); p != p.end(); ++p)
    if ((Eigen::Vector3f(p[0], p[1], p[2]) - place).norm() < (nearest - place).norm())
      nearest = Eigen::Vector3f(p[0], p[1], p[2]);
  return nearest;
}

/// Clicks, as rviz does, on three upper corners of each of two boxes that stand side by side along x about 0; returns
/// how far these are apart.
double clickThree(ros::Publisher& clicks, const sensor_msgs::PointCloud2& cloud)
{
  Eigen::AlignedBox3f left, right;
  for (sensor_msgs::PointCloud2ConstIterator<float> p(cloud, "x"); p != p.end(); ++p)
    (p[0] < 0 ? left : right).extend(Eigen::Vector3f(p[0], p[1], p[2]));
  while (clicks.getNumSubscribers() < 2)  // the segmenter's, which is for the camera's views, too
    ros::WallDuration(0.01).sleep();
  for (const Eigen::AlignedBox3f& box : { left, right })
    for (const auto corner :
         { Eigen::AlignedBox3f::TopLeftCeil, Eigen::AlignedBox3f::TopRightCeil, Eigen::AlignedBox3f::BottomRightCeil })
    {
      geometry_msgs::PointStamped click;
      click.header = cloud.header;
      const Eigen::Vector3f p = nearestPoint(cloud, box.corner(corner));
      click.point.x = p.x();
      click.point.y = p.y();
      click.point.z = p.z();
      clicks.publish(click);
    }
  return (right.center() - left.center()).norm();
}

}  // namespace

TEST_F(JobsTest, APersonDecidesOnAPair)
{
  record(store_, "left", 12);
  record(store_, "right", 10);
  ASSERT_EQ(segment("left").status.code, Status::OK);
  ASSERT_EQ(segment("right").status.code, Status::OK);
  object_modelling::AcceptAlignment accept;
  accept.request.session_a = "left";
  accept.request.session_b = "right";
  EXPECT_STATUS(Status::FAILED_PRECONDITION, "align them first", called("accept", accept));
  ASSERT_EQ(align({ "left", "right" }).status.code, Status::OK);

  object_modelling::RefuseAlignment refuse;
  refuse.request.session_a = "right";
  refuse.request.session_b = "left";
  ASSERT_EQ(called("refuse", refuse).status.code, Status::OK);
  EXPECT_EQ(refuse.response.edge.decision, object_modelling::AlignmentEdge::REFUSED);
  EXPECT_STATUS(Status::NO_RESULT, "refused by a person", align({ "left", "right" }));

  ASSERT_EQ(called("accept", accept).status.code, Status::OK);
  EXPECT_EQ(accept.response.edge.decision, object_modelling::AlignmentEdge::ACCEPTED);
  EXPECT_EQ(align({ "left", "right" }).edges.at(0).decision, object_modelling::AlignmentEdge::ACCEPTED);
  accept.request.candidate = 200;
  EXPECT_STATUS(Status::INVALID_ARGUMENT, "number 200", called("accept", accept));

  object_modelling::ForgetAlignment forget;
  forget.request.session_a = "left";
  forget.request.session_b = "right";
  ASSERT_EQ(called("forget", forget).status.code, Status::OK);
  EXPECT_EQ(align({ "left", "right" }).edges.at(0).decision, object_modelling::AlignmentEdge::AUTOMATIC);
}

TEST_F(JobsTest, APersonAlignsByPointsAndByClicks)
{
  record(store_, "seen", 12);
  record(store_, "again", 10);
  ASSERT_EQ(segment("seen").status.code, Status::OK);
  ASSERT_EQ(segment("again").status.code, Status::OK);
  object_modelling::AlignByPoints by_points;
  by_points.request.session_a = "seen";
  by_points.request.session_b = "again";
  EXPECT_STATUS(Status::INVALID_ARGUMENT, "three are needed", called("align_by_points", by_points));
  // The first cameras of both stood at the same place, so the session frames are one.
  for (const Eigen::Vector3d& corner :
       { Eigen::Vector3d(0.04, 0.06, 0.2), Eigen::Vector3d(-0.04, 0.06, 0.2), Eigen::Vector3d(0.04, -0.06, 0.02) })
  {
    geometry_msgs::Point point;
    point.x = corner.x();
    point.y = corner.y();
    point.z = corner.z();
    by_points.request.points_a.push_back(point);
    by_points.request.points_b.push_back(point);
  }
  ASSERT_EQ(called("align_by_points", by_points).status.code, Status::OK) << by_points.response.status.message;
  const object_modelling::AlignmentEdge edge = by_points.response.edge;
  EXPECT_EQ(edge.decision, object_modelling::AlignmentEdge::ACCEPTED);
  ASSERT_GE(edge.candidates.size(), 1U);
  EXPECT_EQ(edge.candidates[0].kind, "by_hand");
  EXPECT_NEAR(edge.candidates[0].a_from_b.position.x, 0, 0.002);
  EXPECT_NEAR(edge.candidates[0].a_from_b.orientation.w, 1, 1e-4);

  object_modelling::ForgetAlignment forget;
  forget.request.session_a = "seen";
  forget.request.session_b = "again";
  ASSERT_EQ(called("forget", forget).status.code, Status::OK);
  object_modelling::ShowAlignment show;
  show.request.session_a = "seen";
  show.request.session_b = "again";
  ASSERT_EQ(called("show", show).status.code, Status::OK);
  EXPECT_TRUE(show.response.edge.candidates.empty());
  const sensor_msgs::PointCloud2ConstPtr parts =
      ros::topic::waitForMessage<sensor_msgs::PointCloud2>("session_aligner/parts", node_, ros::Duration(PATIENCE_S));
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->header.frame_id, "alignment");
  EXPECT_GT(parts->width, 2000U);

  // Clicks on three spots of one, then the same of the other: what stands alone is side by side along x.
  ros::Publisher clicks = node_.advertise<geometry_msgs::PointStamped>("/clicked_point", 10);
  EXPECT_GT(clickThree(clicks, *parts), 0.2);
  const auto known = [this]
  {
    for (const keyframes::AlignmentRecord& record : store_.alignments())
      if (record.session_a == "seen")
        return record.findings;
    return std::string();
  };
  for (int i = 0; i < 100 && known().empty(); ++i)
    ros::WallDuration(0.1).sleep();
  ASSERT_EQ(called("show", show).status.code, Status::OK);
  ASSERT_EQ(show.response.edge.candidates.size(), 1U);
  EXPECT_EQ(show.response.edge.candidates[0].kind, "by_hand");
  EXPECT_EQ(show.response.edge.decision, object_modelling::AlignmentEdge::ACCEPTED);
  EXPECT_NEAR(show.response.edge.candidates[0].a_from_b.orientation.w, 1, 1e-3);
}

}  // namespace object_modelling::nodes
