#include "icp_problem.h"

#include <algorithm>
#include <atomic>
#include <optional>

#include <opencv2/core/utility.hpp>

namespace object_modelling::multi_view_icp
{
namespace
{
constexpr int BATCH = 16;

/// Calls body(i) for i in [0, count) on so many threads; who is done takes the next.
template <typename Body>
void inParallel(int count, int threads, Body body)
{
  std::atomic<int> next{ 0 };
  cv::parallel_for_(
      cv::Range(0, threads),
      [&](const cv::Range&)
      {
        for (int i = next++; i < count; i = next++)
          body(i);
      },
      threads);
}
}  // namespace

IcpProblem::IcpProblem(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options,
                       std::vector<IcpEdge> edges, base::JobControl* control)
    : options_(options), edges_(std::move(edges))
{
  const int count = static_cast<int>(views.size());
  std::vector<std::optional<IcpView>> prepared(views.size());
  std::vector<std::optional<NearestPoints>> nearest(views.size());
  for (int begin = 0; begin < count; begin += BATCH)
  {
    control->report("surfaces", static_cast<std::size_t>(begin), views.size());
    inParallel(std::min(BATCH, count - begin), options.threads,
               [&](int i)
               {
                 prepared[begin + i].emplace(views[begin + i], options);
                 if (options.association == IcpAssociation::NEAREST)
                   nearest[begin + i].emplace(*prepared[begin + i]);
               });
  }
  for (int k = 0; k < count; ++k)
  {
    views_.push_back(std::move(*prepared[k]));
    if (nearest[k])
      nearest_.push_back(std::move(*nearest[k]));
  }
  loss_.width_sigmas = options.loss_width_sigmas;
  loss_.color_weight = options.color_weight;
}

template <typename Visit>
void IcpProblem::forDirectedPairs(Visit visit) const
{
  inParallel(static_cast<int>(2 * edges_.size()), options_.threads,
             [&](int i)
             {
               const IcpEdge& edge = edges_[i / 2];
               if (i % 2 == 0)
                 visit(i, edge.a, edge.b);
               else
                 visit(i, edge.b, edge.a);
             });
}

void IcpProblem::add(const std::vector<IcpEdge>& edges)
{
  edges_.insert(edges_.end(), edges.begin(), edges.end());
  matches_.clear();
}

void IcpProblem::leaveOut(int view)
{
  edges_.erase(std::remove_if(edges_.begin(), edges_.end(),
                              [&](const IcpEdge& edge) { return edge.a == view || edge.b == view; }),
               edges_.end());
  matches_.clear();
}

void IcpProblem::match(const std::vector<Eigen::Isometry3d>& T_world_camera, const IcpStage& stage)
{
  matches_.assign(2 * edges_.size(), {});
  loss_.color_level = stage.color_level;
  forDirectedPairs(
      [&](int i, int a, int b)
      {
        matches_[i] = matchViews(views_[a], views_[b], T_world_camera[a].inverse() * T_world_camera[b], stage,
                                 nearest_.empty() ? nullptr : &nearest_[a]);
      });
}

double IcpProblem::cost(const std::vector<Eigen::Isometry3d>& T_world_camera) const
{
  std::vector<double> costs(matches_.size(), 0);
  forDirectedPairs(
      [&](int i, int a, int b)
      { costs[i] = icpCost(views_[a], matches_[i], T_world_camera[a].inverse() * T_world_camera[b], loss_); });
  double sum = 0;
  for (const double cost : costs)
    sum += cost;
  return sum;
}

std::vector<PairEquations> IcpProblem::equations(const std::vector<Eigen::Isometry3d>& T_world_camera) const
{
  std::vector<IcpEquations> directed(matches_.size());
  forDirectedPairs(
      [&](int i, int a, int b)
      {
        directed[i] = icpEquations(views_[a], matches_[i], T_world_camera[a].inverse() * T_world_camera[b], loss_);
        // A motion of b in the world moves b's points in a's camera by the same, seen from there.
        const geometry::Matrix6d to_camera = geometry::adjoint(T_world_camera[a].inverse());
        directed[i].A = to_camera.transpose() * directed[i].A * to_camera;
        directed[i].g = to_camera.transpose() * directed[i].g;
      });
  std::vector<PairEquations> pairs(edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e)
  {
    const IcpEquations& b_in_a = directed[2 * e];
    const IcpEquations& a_in_b = directed[2 * e + 1];
    pairs[e] = { edges_[e].a, edges_[e].b, b_in_a.cost + a_in_b.cost, b_in_a.A + a_in_b.A, a_in_b.g - b_in_a.g };
  }
  return pairs;
}

std::vector<geometry::Matrix6d> IcpProblem::noise(const std::vector<Eigen::Isometry3d>& T_world_camera) const
{
  std::vector<geometry::Matrix6d> directed(matches_.size());
  forDirectedPairs(
      [&](int i, int a, int b)
      {
        const geometry::Matrix6d to_camera = geometry::adjoint(T_world_camera[a].inverse());
        directed[i] = to_camera.transpose() *
                      icpNoise(views_[a], matches_[i], T_world_camera[a].inverse() * T_world_camera[b], loss_) *
                      to_camera;
      });
  std::vector<geometry::Matrix6d> pairs(edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e)
    pairs[e] = directed[2 * e] + directed[2 * e + 1];
  return pairs;
}

std::vector<IcpError> IcpProblem::errors(const std::vector<Eigen::Isometry3d>& T_world_camera,
                                         const std::vector<Eigen::Isometry3d>& T_world_camera_weights) const
{
  std::vector<IcpError> directed(matches_.size());
  forDirectedPairs(
      [&](int i, int a, int b)
      {
        directed[i] = icpError(matches_[i], T_world_camera[a].inverse() * T_world_camera[b],
                               T_world_camera_weights[a].inverse() * T_world_camera_weights[b], loss_);
      });
  std::vector<IcpError> pairs(edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e)
  {
    pairs[e] = directed[2 * e];
    pairs[e].add(directed[2 * e + 1]);
  }
  return pairs;
}

std::vector<double> IcpProblem::fittingRatios() const
{
  std::vector<double> fitting(views_.size(), 0), in_view(views_.size(), 0);
  for (std::size_t i = 0; i < matches_.size(); ++i)
  {
    for (const int k : { edges_[i / 2].a, edges_[i / 2].b })
    {
      fitting[k] += matches_[i].fitting;
      in_view[k] += matches_[i].in_view;
    }
  }
  for (std::size_t k = 0; k < views_.size(); ++k)
    fitting[k] = in_view[k] > 0 ? fitting[k] / in_view[k] : 0;
  return fitting;
}

}  // namespace object_modelling::multi_view_icp
