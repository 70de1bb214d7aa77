#include "tracking_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/SVD>

namespace object_modelling::benchmark_tracking
{
namespace
{
constexpr double DEG_PER_RAD = 57.29577951308232;
constexpr double MM_PER_M = 1000;

bool isWithin(const std::vector<Event>& events, double stamp_s)
{
  return std::any_of(events.begin(), events.end(),
                     [stamp_s](const Event& event) { return stamp_s >= event.start_s && stamp_s <= event.end_s; });
}

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix)
{
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

Eigen::Matrix3Xd positions(const std::vector<Eigen::Isometry3d>& poses)
{
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i)
    points.col(static_cast<Eigen::Index>(i)) = poses[i].translation();
  return points;
}

/// Nearest stamp of `poses`; the earlier of two equally near.
std::size_t nearest(const std::vector<source::StampedPose>& poses, double stamp_s)
{
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), stamp_s,
                       [](const source::StampedPose& pose, double stamp) { return pose.stamp_s < stamp; });
  if (after == poses.begin())
    return 0;
  const auto before = after - 1;
  const bool earlier = after == poses.end() || stamp_s - before->stamp_s <= after->stamp_s - stamp_s;
  return static_cast<std::size_t>((earlier ? before : after) - poses.begin());
}

void scoreRelativeMotion(const std::vector<source::StampedPose>& estimate,
                         const std::vector<std::pair<std::size_t, std::size_t>>& matches,
                         const std::vector<bool>& counted, const ScoreOptions& options, TrajectoryScore* score)
{
  std::vector<double> position_mm, rotation_deg;
  std::size_t j = 0;
  for (std::size_t i = 0; i < matches.size(); ++i)
  {
    const TrajectoryScore::Pair& first = score->pairs[i];
    while (j < matches.size() && score->pairs[j].stamp_s < first.stamp_s + options.rpe_delta_s - options.tolerance_s)
      ++j;
    if (j == matches.size())
      break;
    const TrajectoryScore::Pair& later = score->pairs[j];
    if (std::abs(later.stamp_s - first.stamp_s - options.rpe_delta_s) > options.tolerance_s || !counted[i] ||
        !counted[j])
      continue;
    const Eigen::Isometry3d true_motion = first.truth.inverse() * later.truth;
    const Eigen::Isometry3d motion =
        estimate[matches[i].first].T_map_camera.inverse() * estimate[matches[j].first].T_map_camera;
    const Eigen::Isometry3d error = true_motion.inverse() * motion;
    position_mm.push_back(MM_PER_M * error.translation().norm());
    rotation_deg.push_back(DEG_PER_RAD * geometry::rotationAngle_rad(error));
  }
  if (position_mm.empty())
    return;
  score->rpe_mm = statisticsOf(position_mm);
  score->rpe_deg = statisticsOf(rotation_deg);
}

template <typename Pairs, typename Accept>
std::optional<int> framesUntil(const Pairs& pairs, const std::vector<double>& frame_stamps_s, double from_s,
                               double to_s, const Accept& accept)
{
  const auto first = std::find_if(pairs.begin(), pairs.end(),
                                  [&](const TrajectoryScore::Pair& pair)
                                  { return pair.stamp_s > from_s && pair.stamp_s < to_s && accept(pair); });
  if (first == pairs.end())
    return std::nullopt;
  return static_cast<int>(std::count_if(frame_stamps_s.begin(), frame_stamps_s.end(),
                                        [&](double stamp_s)
                                        { return stamp_s > from_s && stamp_s <= first->stamp_s + 1e-6; }));
}
}  // namespace

Statistics statisticsOf(std::vector<double> values)
{
  Statistics result;
  if (values.empty())
    return result;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  result.median = values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  result.max = values.back();
  for (const double value : values)
  {
    result.mean += value / static_cast<double>(values.size());
    result.rmse += value * value / static_cast<double>(values.size());
  }
  result.rmse = std::sqrt(result.rmse);
  return result;
}

std::vector<std::pair<std::size_t, std::size_t>> associate(const std::vector<source::StampedPose>& a,
                                                           const std::vector<source::StampedPose>& b,
                                                           double tolerance_s)
{
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < a.size() && !b.empty(); ++i)
  {
    const std::size_t j = nearest(b, a[i].stamp_s);
    if (std::abs(b[j].stamp_s - a[i].stamp_s) <= tolerance_s && nearest(a, b[j].stamp_s) == i)
      pairs.emplace_back(i, j);
  }
  return pairs;
}

Eigen::Isometry3d alignTrajectories(const std::vector<Eigen::Isometry3d>& T_a_camera,
                                    const std::vector<Eigen::Isometry3d>& T_b_camera)
{
  const Eigen::Matrix3Xd p_a = positions(T_a_camera), p_b = positions(T_b_camera);
  const Eigen::Vector3d mean_a = p_a.rowwise().mean();
  const Eigen::Vector3d spread = (p_a.colwise() - mean_a).jacobiSvd().singularValues();
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  if (spread[1] > 1e-3 * std::max(spread[0], 1e-9) && spread[1] > 1e-4 &&
      geometry::rigidTransformFromPoints(p_a, p_b, &T_a_b))
    return T_a_b;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < T_a_camera.size(); ++i)
    sum += T_a_camera[i].linear() * T_b_camera[i].linear().transpose();
  T_a_b.linear() = nearestRotation(sum);
  T_a_b.translation() = mean_a - T_a_b.linear() * p_b.rowwise().mean();
  return T_a_b;
}

std::optional<TrajectoryScore> scoreTrajectory(const std::vector<source::StampedPose>& estimate,
                                               const std::vector<source::StampedPose>& truth,
                                               const std::vector<Event>& events,
                                               const std::vector<double>& frame_stamps_s, const ScoreOptions& options)
{
  const auto matches = associate(estimate, truth, options.tolerance_s);
  if (matches.size() < 3)
    return std::nullopt;
  double first_event_s = std::numeric_limits<double>::infinity();
  for (const Event& event : events)
    first_event_s = std::min(first_event_s, event.start_s);
  std::vector<bool> counted, reference;
  for (const auto& [i, j] : matches)
  {
    counted.push_back(!isWithin(events, truth[j].stamp_s));
    reference.push_back(counted.back() && truth[j].stamp_s < first_event_s);
  }
  if (std::count(reference.begin(), reference.end(), true) < 3)
    reference = counted;

  std::vector<Eigen::Isometry3d> T_world_camera, T_map_camera;
  for (std::size_t k = 0; k < matches.size(); ++k)
    if (reference[k])
    {
      T_world_camera.push_back(truth[matches[k].second].T_map_camera);
      T_map_camera.push_back(estimate[matches[k].first].T_map_camera);
    }
  const Eigen::Isometry3d T_world_map = alignTrajectories(T_world_camera, T_map_camera);
  Eigen::Matrix3d rotation_sum = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < T_map_camera.size(); ++k)
    rotation_sum += T_world_camera[k].linear().transpose() * T_world_map.linear() * T_map_camera[k].linear();
  const Eigen::Matrix3d offset = nearestRotation(rotation_sum);

  TrajectoryScore score;
  std::vector<double> position_mm, rotation_deg;
  std::map<int, std::vector<double>> position_by_minute_mm;
  for (std::size_t k = 0; k < matches.size(); ++k)
  {
    const source::StampedPose& true_pose = truth[matches[k].second];
    TrajectoryScore::Pair pair;
    pair.stamp_s = true_pose.stamp_s;
    pair.T_world_camera = T_world_map * estimate[matches[k].first].T_map_camera;
    pair.truth = true_pose.T_map_camera;
    pair.position_mm = MM_PER_M * (pair.T_world_camera.translation() - pair.truth.translation()).norm();
    Eigen::Isometry3d rotation = Eigen::Isometry3d::Identity();
    rotation.linear() = offset.transpose() * pair.truth.linear().transpose() * pair.T_world_camera.linear();
    pair.rotation_deg = DEG_PER_RAD * geometry::rotationAngle_rad(rotation);
    score.pairs.push_back(pair);
    if (!counted[k])
      continue;
    ++score.matched;
    score.wrong += pair.position_mm > options.right_mm || pair.rotation_deg > options.right_deg;
    position_mm.push_back(pair.position_mm);
    const int minute = static_cast<int>((pair.stamp_s - truth[matches.front().second].stamp_s) / 60);
    position_by_minute_mm[minute].push_back(pair.position_mm);
    rotation_deg.push_back(pair.rotation_deg);
  }
  score.ate_mm = statisticsOf(position_mm);
  for (const auto& [minute, errors_mm] : position_by_minute_mm)
    score.ate_by_minute_mm.push_back(statisticsOf(errors_mm).rmse);
  score.rotation_deg = statisticsOf(rotation_deg);
  scoreRelativeMotion(estimate, matches, counted, options, &score);

  for (std::size_t k = 0; k < events.size(); ++k)
  {
    const double from_s = events[k].end_s;
    const double to_s = k + 1 < events.size() ? events[k + 1].start_s : std::numeric_limits<double>::infinity();
    const auto any = [](const TrajectoryScore::Pair&) { return true; };
    const auto right = [&options](const TrajectoryScore::Pair& pair)
    { return pair.position_mm <= options.right_mm && pair.rotation_deg <= options.right_deg; };
    score.relocalisations.push_back({ events[k], framesUntil(score.pairs, frame_stamps_s, from_s, to_s, any),
                                      framesUntil(score.pairs, frame_stamps_s, from_s, to_s, right) });
  }
  return score;
}

}  // namespace object_modelling::benchmark_tracking
