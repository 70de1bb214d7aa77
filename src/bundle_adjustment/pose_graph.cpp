#include "pose_graph.h"

#include <cmath>

#include <ceres/ceres.h>
#include <ceres/rotation.h>

namespace object_modelling::bundle_adjustment
{
namespace
{
using Vector6d = geometry::Vector6d;

/// Blocks: motions (t, r) on the left of T_camera_session of a and b, as in LinearisedCamera.
class EdgeCost
{
public:
  EdgeCost(const PoseEdge& edge, const Eigen::Isometry3d& T_a_session, const Eigen::Isometry3d& T_session_b)
      : edge_(edge), T_a_b_start_(T_a_session * T_session_b)
  {
  }

  template <typename T>
  bool operator()(const T* motion_a, const T* motion_b, T* residuals) const
  {
    const T inverse_rotation_b[3] = { -motion_b[3], -motion_b[4], -motion_b[5] };
    for (int i = 0; i < 4; ++i)
    {
      const Eigen::Vector3d& p = edge_.points_b[i];
      const T unmoved[3] = { p.x() - motion_b[0], p.y() - motion_b[1], p.z() - motion_b[2] };
      T in_b[3], in_a[3];
      ceres::AngleAxisRotatePoint(inverse_rotation_b, unmoved, in_b);
      const Eigen::Matrix<T, 3, 1> start =
          T_a_b_start_.linear().cast<T>() * Eigen::Map<const Eigen::Matrix<T, 3, 1>>(in_b) +
          T_a_b_start_.translation().cast<T>();
      ceres::AngleAxisRotatePoint(motion_a + 3, start.data(), in_a);
      const Eigen::Vector3d measured = edge_.T_a_b * p;
      for (int axis = 0; axis < 3; ++axis)
        residuals[3 * i + axis] = (in_a[axis] + motion_a[axis] - measured[axis]) / edge_.sigma_m;
    }
    return true;
  }

private:
  const PoseEdge& edge_;
  Eigen::Isometry3d T_a_b_start_;
};

}  // namespace

std::array<Eigen::Vector3d, 4> patchCorners(const Eigen::Vector3d& center, double radius_m)
{
  const double s = radius_m / std::sqrt(3.0);
  return { center + Eigen::Vector3d(s, s, s), center + Eigen::Vector3d(s, -s, -s), center + Eigen::Vector3d(-s, s, -s),
           center + Eigen::Vector3d(-s, -s, s) };
}

double edgeError_m(const PoseEdge& edge, const std::vector<Eigen::Isometry3d>& T_session_camera)
{
  const Eigen::Isometry3d T_a_b = T_session_camera[edge.a].inverse() * T_session_camera[edge.b];
  double sum = 0;
  for (const Eigen::Vector3d& p : edge.points_b)
    sum += (T_a_b * p - edge.T_a_b * p).squaredNorm();
  return std::sqrt(sum / 4);
}

void relaxPoseGraph(const std::vector<PoseEdge>& edges, int fixed, std::vector<Eigen::Isometry3d>* T_session_camera)
{
  std::vector<Vector6d> motions(T_session_camera->size(), Vector6d::Zero());
  ceres::Problem problem;
  for (const PoseEdge& edge : edges)
  {
    auto* cost = new ceres::AutoDiffCostFunction<EdgeCost, 12, 6, 6>(
        new EdgeCost(edge, (*T_session_camera)[edge.a].inverse(), (*T_session_camera)[edge.b]));
    problem.AddResidualBlock(cost, nullptr, motions[edge.a].data(), motions[edge.b].data());
  }
  if (edges.empty() || !problem.HasParameterBlock(motions[fixed].data()))
    return;
  problem.SetParameterBlockConstant(motions[fixed].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 50;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable())
    return;
  for (std::size_t k = 0; k < motions.size(); ++k)
  {
    if (!motions[k].isZero())
    {
      const Eigen::Isometry3d T_camera_session =
          geometry::isometryFromVector(motions[k]) * (*T_session_camera)[k].inverse();
      (*T_session_camera)[k] = geometry::normalized(T_camera_session.inverse());
    }
  }
}

}  // namespace object_modelling::bundle_adjustment
