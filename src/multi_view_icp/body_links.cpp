#include "body_links.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <opencv2/core/utility.hpp>

#include "icp_matches.h"

namespace object_modelling::multi_view_icp
{
namespace
{
constexpr double MIN_COMMON_RATIO = 0.05;  // of a view's points: fewer may lie on another surface by chance
constexpr int POINT_STEP = 3;              // one of so many of a view's points is used
// Neighbouring points err alike, some 30 of them weigh as much as one (icp_report.cpp): ten times as much for each of
// the six unknowns of a body.
constexpr double MIN_COMMON_POINTS = 1800;

/// Number of b's points that lie, within noise, on the surface that a sees.
int commonPoints(const IcpView& a, const IcpView& b, const Eigen::Isometry3d& T_a_b, const IcpStage& stage)
{
  return POINT_STEP * matchSurface(a, b, T_a_b, stage, nullptr).fitting;
}

/// For (a, b) the number of b's points on a's surface; 0 where it is too few of them, and for views of one body.
Eigen::MatrixXi commonPoints(const std::vector<rgbd::View>& views, const std::vector<IcpView>& icp_views,
                             const MultiViewIcpOptions& options)
{
  IcpStage stage;
  stage.gate_m = options.start_error_m;
  stage.min_normal_cosine = std::cos(options.max_normal_angle_rad);
  stage.point_step = POINT_STEP;
  const int count = static_cast<int>(views.size());
  Eigen::MatrixXi common = Eigen::MatrixXi::Zero(count, count);
  const auto look = [&](int a, int b)
  {
    const Eigen::Isometry3d T_a_b = views[a].T_world_camera.inverse() * views[b].T_world_camera;
    const int points = commonPoints(icp_views[a], icp_views[b], T_a_b, stage);
    const auto all = static_cast<double>(icp_views[b].surfacePoints().size());
    common(a, b) = points > 0 && points >= MIN_COMMON_RATIO * all ? points : 0;
    return common(a, b) > 0;
  };
  cv::parallel_for_(
      cv::Range(0, count),
      [&](const cv::Range& range)
      {
        for (int a = range.start; a < range.end; ++a)
          for (int b = 0; b < a; ++b)
            if (views[a].session_index != views[b].session_index && look(a, b))
              look(b, a);
      },
      options.threads);
  return common;
}
}  // namespace

std::vector<IcpEdge> linksBetweenBodies(const std::vector<rgbd::View>& views, const std::vector<IcpView>& icp_views,
                                        const MultiViewIcpOptions& options)
{
  const Eigen::MatrixXi common = commonPoints(views, icp_views, options);
  Eigen::MatrixXd ratio = common.cast<double>();
  for (Eigen::Index b = 0; b < ratio.cols(); ++b)
    ratio.col(b) /= std::max<double>(1, static_cast<double>(icp_views[b].surfacePoints().size()));
  std::vector<IcpEdge> edges = edgesBetweenPartners(ratio, MIN_COMMON_RATIO, options.max_partners);
  const auto bodiesOf = [&](const IcpEdge& edge)
  { return std::minmax(views[edge.a].session_index, views[edge.b].session_index); };
  std::map<std::pair<int, int>, double> points;
  for (const IcpEdge& edge : edges)
    points[bodiesOf(edge)] += common(edge.a, edge.b) + common(edge.b, edge.a);
  edges.erase(std::remove_if(edges.begin(), edges.end(),
                             [&](const IcpEdge& edge) { return points[bodiesOf(edge)] < MIN_COMMON_POINTS; }),
              edges.end());
  return edges;
}

}  // namespace object_modelling::multi_view_icp
