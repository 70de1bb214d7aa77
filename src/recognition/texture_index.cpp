#include "texture_index.h"

#include <algorithm>
#include <map>

#include <opencv2/flann.hpp>

#include "object_modelling/base/ransac.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::recognition
{
namespace
{
constexpr int NEIGHBORS = 5;            // per feature of the scene
constexpr int CHECKS = 48;              // leaves of the trees
constexpr float MAX_RATIO = 0.86F;      // to the nearest feature that is of something else
constexpr float SAME_PLACE_M = 0.012F;  // features this near on one object are one
constexpr double MODEL_GATE_M = 0.004;  // error of a stored feature
constexpr double MATCH_SIGMAS = 3;
constexpr std::size_t MIN_MATCHES = 5;
constexpr int MAX_INSTANCES = 6;

struct Match
{
  Eigen::Vector3d p_camera, p_model;
  double gate_m = 0;
};

std::optional<Eigen::Isometry3d> poseOf(const std::vector<Match>& matches, const std::array<int, 3>& sample)
{
  Eigen::Matrix3Xd camera(3, 3), model(3, 3);
  for (int i = 0; i < 3; ++i)
  {
    camera.col(i) = matches[sample[i]].p_camera;
    model.col(i) = matches[sample[i]].p_model;
  }
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3;
    const double off = (camera.col(i) - camera.col(j)).norm() - (model.col(i) - model.col(j)).norm();
    if (std::abs(off) > matches[sample[i]].gate_m + matches[sample[j]].gate_m)
      return std::nullopt;
  }
  Eigen::Isometry3d T;
  if (!geometry::rigidTransformFromPoints(camera, model, &T))
    return std::nullopt;
  return T;
}

std::vector<int> inliersOf(const std::vector<Match>& matches, const Eigen::Isometry3d& T)
{
  std::vector<int> inliers;
  for (std::size_t i = 0; i < matches.size(); ++i)
    if ((T * matches[i].p_model - matches[i].p_camera).norm() < matches[i].gate_m)
      inliers.push_back(static_cast<int>(i));
  return inliers;
}

Eigen::Isometry3d refitted(const std::vector<Match>& matches, Eigen::Isometry3d T)
{
  for (int round = 0; round < 3; ++round)
  {
    const std::vector<int> inliers = inliersOf(matches, T);
    if (inliers.size() < 3)
      break;
    Eigen::Matrix3Xd camera(3, inliers.size()), model(3, inliers.size());
    for (std::size_t i = 0; i < inliers.size(); ++i)
    {
      camera.col(static_cast<int>(i)) = matches[inliers[i]].p_camera;
      model.col(static_cast<int>(i)) = matches[inliers[i]].p_model;
    }
    Eigen::Isometry3d better;
    if (!geometry::rigidTransformFromPoints(camera, model, &better))
      break;
    T = better;
  }
  return T;
}
}  // namespace

struct TextureIndex::Data
{
  cv::Mat descriptors;
  std::vector<int> object;               // per row
  std::vector<Eigen::Vector3f> p_model;  // per row
  std::unique_ptr<cv::flann::Index> index;

  std::map<int, std::vector<Match>> match(const Scene& scene, const features::KeyframeFeatures& found) const;
};

TextureIndex::TextureIndex(const std::vector<std::shared_ptr<const ObjectKnowledge>>& objects)
    : data_(std::make_unique<Data>())
{
  for (std::size_t i = 0; i < objects.size(); ++i)
  {
    if (objects[i]->descriptors.empty())
      continue;
    cv::Mat rows;
    objects[i]->descriptors.convertTo(rows, CV_32F);
    data_->descriptors.push_back(rows);
    data_->object.insert(data_->object.end(), static_cast<std::size_t>(rows.rows), static_cast<int>(i));
    data_->p_model.insert(data_->p_model.end(), objects[i]->feature_points.begin(), objects[i]->feature_points.end());
  }
  if (data_->descriptors.rows > NEIGHBORS)
  {
    cvflann::seed_random(1);  // the same trees every time
    data_->index = std::make_unique<cv::flann::Index>(data_->descriptors, cv::flann::KDTreeIndexParams(4));
  }
}

TextureIndex::~TextureIndex() = default;
TextureIndex::TextureIndex(TextureIndex&&) noexcept = default;
TextureIndex& TextureIndex::operator=(TextureIndex&&) noexcept = default;

std::map<int, std::vector<Match>> TextureIndex::Data::match(const Scene& scene,
                                                            const features::KeyframeFeatures& found) const
{
  std::map<int, std::vector<Match>> matches;
  if (!index || found.descriptors.empty())
    return matches;
  cv::Mat query, indices, distances;
  found.descriptors.convertTo(query, CV_32F);
  index->knnSearch(query, indices, distances, NEIGHBORS, cv::flann::SearchParams(CHECKS));
  for (int i = 0; i < query.rows; ++i)
  {
    const features::Feature& feature = found.features[static_cast<std::size_t>(i)];
    if (!(feature.depth_m > 0))
      continue;
    const int first = indices.at<int>(i, 0);
    float other = -1;
    for (int k = 1; k < NEIGHBORS && other < 0; ++k)
    {
      const int next = indices.at<int>(i, k);
      if (object[next] != object[first] || (p_model[next] - p_model[first]).norm() > SAME_PLACE_M)
        other = distances.at<float>(i, k);
    }
    if (other >= 0 && distances.at<float>(i, 0) > MAX_RATIO * MAX_RATIO * other)
      continue;
    const double gate_m = MODEL_GATE_M + MATCH_SIGMAS * sigmaAt(scene, feature.depth_m);
    matches[object[first]].push_back({ feature.p_camera, p_model[first].cast<double>(), gate_m });
  }
  return matches;
}

std::vector<PoseHypothesis> TextureIndex::poses(const Scene& scene, const features::KeyframeFeatures& found,
                                                std::uint64_t seed) const
{
  std::vector<PoseHypothesis> result;
  for (auto& [object, left] : data_->match(scene, found))
  {
    std::vector<Match> matches = left;
    for (int instance = 0; instance < MAX_INSTANCES && matches.size() >= MIN_MATCHES; ++instance)
    {
      base::RansacOptions options;
      options.max_samples = 3000;
      options.confidence_ratio = 0.999;
      options.samples_factor = 3;
      options.seed = seed;
      const auto best = base::ransac<3, Eigen::Isometry3d>(
          matches.size(), options, [&](const std::array<int, 3>& sample) { return poseOf(matches, sample); },
          [&](const Eigen::Isometry3d& T)
          { return static_cast<double>(inliersOf(matches, T).size()) / static_cast<double>(matches.size()); });
      if (!best)
        break;
      const Eigen::Isometry3d T = refitted(matches, best->model);
      const std::vector<int> inliers = inliersOf(matches, T);
      if (inliers.size() < MIN_MATCHES)
        break;
      PoseHypothesis hypothesis;
      hypothesis.object = object;
      hypothesis.T_camera_model = T;
      hypothesis.matched_features = static_cast<int>(inliers.size());
      result.push_back(hypothesis);
      for (auto i = inliers.rbegin(); i != inliers.rend(); ++i)
        matches.erase(matches.begin() + *i);
    }
  }
  return result;
}

}  // namespace object_modelling::recognition
