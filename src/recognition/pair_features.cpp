#include "object_modelling/recognition/pair_features.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace object_modelling::recognition
{
namespace
{
constexpr float SPLIT_COSINE = 0.866F;  // 30 deg
constexpr float PEAK_RATIO = 0.9F;
constexpr int MAX_PEAKS = 3;
constexpr float SPREAD_MARGIN = 0.3F;    // of a bin: nearer to its rim than this, the neighbour is looked up too
constexpr std::size_t MOST_PAIRS = 300;  // of a reference point: more change its peaks little
constexpr float PARALLEL_COSINE = 0.985F, COPLANAR_WEIGHT = 1.2F;
constexpr std::size_t COPLANAR_STEP = 4;

struct Feature
{
  float distance_m = 0, a_rad = 0, b_rad = 0, c_rad = 0;
};

float angle(float cosine)
{
  return std::acos(std::clamp(cosine, -1.F, 1.F));
}

Feature featureOf(const Eigen::Vector3f& p, const Eigen::Vector3f& n, const Eigen::Vector3f& q,
                  const Eigen::Vector3f& m)
{
  const Eigen::Vector3f d = q - p;
  const float length = d.norm();
  const Eigen::Vector3f direction = d / std::max(length, 1e-9F);
  return { length, angle(n.dot(direction)), angle(m.dot(direction)), angle(n.dot(m)) };
}

/// Puts a point at the origin and its normal along x.
Eigen::Isometry3f toReference(const Eigen::Vector3f& p, const Eigen::Vector3f& n)
{
  Eigen::Vector3f y = n.cross(std::abs(n.x()) < 0.9F ? Eigen::Vector3f::UnitX() : Eigen::Vector3f::UnitY());
  y.normalize();
  Eigen::Matrix3f R;
  R.row(0) = n.transpose();
  R.row(1) = y.transpose();
  R.row(2) = n.cross(y).transpose();
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
  T.linear() = R;
  T.translation() = -R * p;
  return T;
}

float turnOf(const Eigen::Isometry3f& T_reference, const Eigen::Vector3f& q)
{
  const Eigen::Vector3f p = T_reference * q;
  return std::atan2(p.z(), p.y());
}

/// Indices of the other points that are nearer than `radius_m`.
std::vector<std::uint32_t> pointsNear(const OrientedPoints& scene, std::size_t reference, float radius_m)
{
  std::vector<std::uint32_t> near;
  for (std::size_t j = 0; j < scene.size(); ++j)
    if (j != reference && (scene.points[j] - scene.points[reference]).squaredNorm() < radius_m * radius_m)
      near.push_back(static_cast<std::uint32_t>(j));
  return near;
}

/// The bin of a value in units of bins, and the nearer neighbour where it is close to the rim; -1: none.
struct Bins
{
  int here = 0, beside = -1;

  Bins(float value, int count)
  {
    here = std::clamp(static_cast<int>(value), 0, count - 1);
    const float within = value - static_cast<float>(here);
    if (within < SPREAD_MARGIN && here > 0)
      beside = here - 1;
    else if (within > 1 - SPREAD_MARGIN && here + 1 < count)
      beside = here + 1;
  }
};
}  // namespace

OrientedPoints thinned(const OrientedPoints& surface, double spacing_m)
{
  struct Cell
  {
    Eigen::Vector3f point, normal, first;
    int count;
  };
  std::map<std::tuple<int, int, int>, std::vector<Cell>> cells;
  for (std::size_t i = 0; i < surface.size(); ++i)
  {
    const Eigen::Vector3f at = (surface.points[i] / static_cast<float>(spacing_m)).array().floor();
    std::vector<Cell>& here = cells[{ static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z()) }];
    auto cell = std::find_if(here.begin(), here.end(),
                             [&](const Cell& c) { return c.first.dot(surface.normals[i]) > SPLIT_COSINE; });
    if (cell == here.end())
      here.push_back({ surface.points[i], surface.normals[i], surface.normals[i], 1 });
    else
    {
      cell->point += surface.points[i];
      cell->normal += surface.normals[i];
      ++cell->count;
    }
  }
  OrientedPoints result;
  for (const auto& [at, here] : cells)
    for (const Cell& cell : here)
    {
      result.points.push_back(cell.point / static_cast<float>(cell.count));
      result.normals.push_back(cell.normal.normalized());
    }
  return result;
}

PairTable::PairTable(const OrientedPoints& surface, double diameter_m, const PairFeatureOptions& options)
    : spacing_m_(std::min(options.spacing_ratio * diameter_m, options.max_spacing_m)),
      diameter_m_(diameter_m),
      angle_bins_(options.angle_bins),
      turn_bins_(options.turn_bins)
{
  points_ = thinned(surface, spacing_m_);
  while (points_.size() > options.max_points)
  {
    spacing_m_ *= 1.1;
    points_ = thinned(surface, spacing_m_);
  }
  distance_bins_ = static_cast<int>(diameter_m_ / spacing_m_) + 1;
  const auto bin = [&](float value_rad)
  { return std::clamp(static_cast<int>(value_rad / static_cast<float>(M_PI) * angle_bins_), 0, angle_bins_ - 1); };
  for (std::size_t i = 0; i < points_.size(); ++i)
    T_reference_model_.push_back(toReference(points_.points[i], points_.normals[i]));
  std::vector<std::pair<std::uint32_t, Entry>> all;
  for (std::size_t i = 0; i < points_.size(); ++i)
    for (std::size_t j = 0; j < points_.size(); ++j)
    {
      if (i == j)
        continue;
      const Feature f = featureOf(points_.points[i], points_.normals[i], points_.points[j], points_.normals[j]);
      const int distance =
          std::min(static_cast<int>(f.distance_m / static_cast<float>(spacing_m_)), distance_bins_ - 1);
      all.push_back({ static_cast<std::uint32_t>(keyOf(distance, bin(f.a_rad), bin(f.b_rad), bin(f.c_rad))),
                      { static_cast<std::uint32_t>(i), turnOf(T_reference_model_[i], points_.points[j]) } });
    }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  starts_.assign(keyOf(distance_bins_, 0, 0, 0) + 1, 0);
  for (const auto& [key, entry] : all)
    ++starts_[key + 1];
  for (std::size_t k = 1; k < starts_.size(); ++k)
    starts_[k] += starts_[k - 1];
  for (const auto& [key, entry] : all)
    entries_.push_back(entry);
}

std::size_t PairTable::keyOf(int distance, int a, int b, int c) const
{
  return static_cast<std::size_t>(((distance * angle_bins_ + a) * angle_bins_ + b) * angle_bins_ + c);
}

void PairTable::vote(const OrientedPoints& scene, std::size_t reference, std::vector<float>* accumulator,
                     std::vector<VotedPose>* poses) const
{
  accumulator->assign(points_.size() * static_cast<std::size_t>(turn_bins_), 0);
  const Eigen::Vector3f& p = scene.points[reference];
  const Eigen::Vector3f& n = scene.normals[reference];
  const Eigen::Isometry3f T_reference_scene = toReference(p, n);
  const auto per_turn = static_cast<float>(turn_bins_ / (2 * M_PI));
  const auto angles = static_cast<float>(angle_bins_ / M_PI);
  const std::vector<std::uint32_t> near = pointsNear(scene, reference, static_cast<float>(diameter_m_));
  const std::size_t step = near.size() / MOST_PAIRS + 1;
  for (std::size_t i = 0; i < near.size(); i += step)
  {
    const std::size_t j = near[i];
    const Feature f = featureOf(p, n, scene.points[j], scene.normals[j]);
    const bool coplanar =
        n.dot(scene.normals[j]) > PARALLEL_COSINE && std::abs(f.a_rad - static_cast<float>(M_PI_2)) < 0.15F;
    // Pairs within a plane are many, and each is as any other: a few stand for all.
    if (coplanar && (i / step) % COPLANAR_STEP != 0)
      continue;
    const float weight = coplanar ? COPLANAR_WEIGHT : 1;
    const float turn_scene = turnOf(T_reference_scene, scene.points[j]);
    const Bins bins[] = { Bins(f.distance_m / static_cast<float>(spacing_m_), distance_bins_),
                          Bins(f.a_rad * angles, angle_bins_), Bins(f.b_rad * angles, angle_bins_),
                          Bins(f.c_rad * angles, angle_bins_) };
    for (int mask = 0; mask < 16; ++mask)
    {
      int at[4];
      bool exists = true;
      for (int k = 0; k < 4; ++k)
      {
        at[k] = (mask >> k & 1) != 0 ? bins[k].beside : bins[k].here;
        exists &= at[k] >= 0;
      }
      if (!exists)
        continue;
      const std::size_t key = keyOf(at[0], at[1], at[2], at[3]);
      for (std::uint32_t e = starts_[key]; e < starts_[key + 1]; ++e)
      {
        float turn = (turn_scene - entries_[e].turn_rad) * per_turn;
        if (turn < 0)
          turn += static_cast<float>(turn_bins_);
        int bin = static_cast<int>(turn + 0.5F);
        if (bin >= turn_bins_)
          bin -= turn_bins_;
        (*accumulator)[entries_[e].reference * static_cast<std::size_t>(turn_bins_) + static_cast<std::size_t>(bin)] +=
            weight;
      }
    }
  }
  peaks(T_reference_scene.inverse(), accumulator, poses);
}

void PairTable::peaks(const Eigen::Isometry3f& T_scene_reference, std::vector<float>* accumulator,
                      std::vector<VotedPose>* poses) const
{
  const auto per_turn = static_cast<float>(turn_bins_ / (2 * M_PI));
  for (int peak = 0; peak < MAX_PEAKS; ++peak)
  {
    const auto best = std::max_element(accumulator->begin(), accumulator->end());
    const float votes = *best;
    if (!(votes > 0) ||
        (peak > 0 && votes < PEAK_RATIO * poses->at(poses->size() - static_cast<std::size_t>(peak)).votes))
      return;
    const auto index = static_cast<std::size_t>(best - accumulator->begin());
    const std::size_t model = index / static_cast<std::size_t>(turn_bins_);
    const auto bin = static_cast<float>(index % static_cast<std::size_t>(turn_bins_));
    VotedPose pose;
    pose.votes = votes;
    pose.T_scene_model = T_scene_reference *
                         Eigen::Isometry3f(Eigen::AngleAxisf(bin / per_turn, Eigen::Vector3f::UnitX())) *
                         T_reference_model_[model];
    poses->push_back(pose);
    // The same model point's neighbouring turns would be the next peaks.
    for (int around = -1; around <= 1; ++around)
      (*accumulator)[model * static_cast<std::size_t>(turn_bins_) +
                     static_cast<std::size_t>((static_cast<int>(bin) + around + turn_bins_) % turn_bins_)] = 0;
  }
}

std::vector<VotedPose> clustered(std::vector<VotedPose> poses, const Eigen::Vector3f& center_model, float distance_m,
                                 float angle_rad)
{
  std::stable_sort(poses.begin(), poses.end(),
                   [](const VotedPose& a, const VotedPose& b) { return a.votes > b.votes; });
  const float min_trace = 1 + 2 * std::cos(angle_rad);
  std::vector<VotedPose> seeds;
  std::vector<Eigen::Vector3f> centers;
  for (const VotedPose& pose : poses)
  {
    const Eigen::Vector3f center = pose.T_scene_model * center_model;
    std::size_t s = 0;
    for (; s < seeds.size(); ++s)
      if ((center - centers[s]).squaredNorm() < distance_m * distance_m &&
          (seeds[s].T_scene_model.linear().transpose() * pose.T_scene_model.linear()).trace() > min_trace)
        break;
    if (s < seeds.size())
      seeds[s].votes += pose.votes;
    else
    {
      seeds.push_back(pose);
      centers.push_back(center);
    }
  }
  std::stable_sort(seeds.begin(), seeds.end(),
                   [](const VotedPose& a, const VotedPose& b) { return a.votes > b.votes; });
  return seeds;
}

}  // namespace object_modelling::recognition
