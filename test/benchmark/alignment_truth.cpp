#include "alignment_truth.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <yaml-cpp/yaml.h>

#include "object_modelling/geometry/point_index.h"
#include "object_modelling/source/trajectory_file.h"

namespace object_modelling::benchmark_alignment
{
namespace
{
constexpr double RIGHT_DEG = 1.5, RIGHT_MM = 1.5;
constexpr double OVERLAP_SPACINGS = 1.7;
const double OVERLAP_COSINE = std::cos(M_PI / 4);
/// Stamps are those of the frames themselves; between frames the camera moves by millimetres.
constexpr double SAME_STAMP_S = 1e-3;
/// Points on the optical axes hold the rotation where the cameras hardly moved.
constexpr double AXIS_POINT_M = 0.3;
constexpr std::size_t MIN_KEYFRAMES = 3;

[[noreturn]] void refuse(const std::string& path, const std::string& reason)
{
  throw base::Error(base::StatusCode::BAD_INPUT, path + ": " + reason);
}

YAML::Node objectOf(const YAML::Node& objects, const std::string& object_folder)
{
  if (objects.size() == 1)
    return objects[0];
  for (const YAML::Node& object : objects)
    if (object["name"].as<std::string>() == object_folder)
      return object;
  throw YAML::Exception(YAML::Mark::null_mark(), "has several objects and none named '" + object_folder + "'");
}

/// Object, mesh and T_world_object.
SessionTruth readObject(const std::string& folder, const std::string& object_folder, Eigen::Isometry3d* T_world_object)
{
  const std::string path = folder + "/objects.yaml";
  SessionTruth truth;
  try
  {
    const YAML::Node object = objectOf(YAML::LoadFile(path)["objects"], object_folder);
    truth.object = object["name"].as<std::string>();
    truth.mesh = (std::filesystem::path(folder) / object["mesh"].as<std::string>()).string();
    const YAML::Node rows = object["T_world_object"];
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column)
        (*T_world_object)(row, column) = rows[row][column].as<double>();
  }
  catch (const YAML::Exception& error)
  {
    refuse(path, error.what());
  }
  return truth;
}

const source::StampedPose* poseAt(const std::vector<source::StampedPose>& trajectory, double stamp_s)
{
  for (const source::StampedPose& pose : trajectory)
    if (std::abs(pose.stamp_s - stamp_s) < SAME_STAMP_S)
      return &pose;
  return nullptr;
}

/// T_world_session, and the distances that remain.
Eigen::Isometry3d placeInWorld(const std::string& path, const std::vector<rgbd::Keyframe>& keyframes,
                               double* camera_rmse_mm)
{
  const std::vector<source::StampedPose> trajectory = source::readTrajectory(path);
  Eigen::Matrix3Xd points_world(3, 2 * keyframes.size()), points_session(3, 2 * keyframes.size());
  Eigen::Index count = 0;
  for (const rgbd::Keyframe& keyframe : keyframes)
    if (const source::StampedPose* pose = poseAt(trajectory, keyframe.frame.stamp_s))
      for (const double z_m : { 0.0, AXIS_POINT_M })
      {
        points_world.col(count) = pose->T_map_camera * Eigen::Vector3d(0, 0, z_m);
        points_session.col(count++) = keyframe.T_session_camera * Eigen::Vector3d(0, 0, z_m);
      }
  if (count < static_cast<Eigen::Index>(2 * MIN_KEYFRAMES))
    refuse(path, "has the stamps of fewer than " + std::to_string(MIN_KEYFRAMES) + " keyframes");
  points_world.conservativeResize(3, count);
  points_session.conservativeResize(3, count);
  Eigen::Isometry3d T_world_session;
  if (!geometry::rigidTransformFromPoints(points_world, points_session, &T_world_session))
    refuse(path, "does not hold the session's frame: all its cameras are on one line");
  double sum_m2 = 0;
  for (Eigen::Index i = 0; i < count; i += 2)
    sum_m2 += (points_world.col(i) - T_world_session * points_session.col(i)).squaredNorm();
  *camera_rmse_mm = 1e3 * std::sqrt(sum_m2 / static_cast<double>(count / 2));
  return T_world_session;
}
}  // namespace

SessionTruth sessionTruth(const std::string& folder, const std::string& object_folder,
                          const std::vector<rgbd::Keyframe>& keyframes)
{
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  SessionTruth truth = readObject(folder, object_folder, &T_world_object);
  const Eigen::Isometry3d T_world_session = placeInWorld(folder + "/groundtruth.txt", keyframes, &truth.camera_rmse_mm);
  truth.T_session_object = T_world_session.inverse() * T_world_object;
  return truth;
}

double trueOverlap(const registration::PartialModel& a, const registration::PartialModel& b,
                   const Eigen::Isometry3d& T_a_b)
{
  const bool a_is_smaller = a.points.size() < b.points.size();
  const registration::PartialModel &smaller = a_is_smaller ? a : b, &larger = a_is_smaller ? b : a;
  const Eigen::Isometry3f T_larger_smaller = (a_is_smaller ? T_a_b.inverse() : T_a_b).cast<float>();
  const double radius_m = OVERLAP_SPACINGS * std::max(a.spacing_m, b.spacing_m);
  const geometry::PointIndex index(larger.points);
  std::size_t shared = 0;
  for (std::size_t i = 0; i < smaller.points.size(); ++i)
  {
    const Eigen::Vector3f n = T_larger_smaller.linear() * smaller.normals[i];
    const std::vector<std::uint32_t> near = index.within(T_larger_smaller * smaller.points[i], radius_m);
    shared +=
        std::any_of(near.begin(), near.end(),
                    [&](std::uint32_t k) { return larger.normals[k].dot(n) >= static_cast<float>(OVERLAP_COSINE); });
  }
  return smaller.points.empty() ? 0 : static_cast<double>(shared) / static_cast<double>(smaller.points.size());
}

double trueTurn_rad(const registration::PartialModel& a, const registration::PartialModel& b,
                    const Eigen::Isometry3d& T_a_b)
{
  if (!a.support_plane || !b.support_plane)
    return -1;
  return std::acos(std::clamp(a.support_plane->normal.dot(T_a_b.linear() * b.support_plane->normal), -1.0, 1.0));
}

double meshDistance_mm(const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_object_session,
                       const mesh::ReferenceSurface& surface)
{
  double sum_m = 0;
  for (const Eigen::Vector3f& p : points)
    sum_m += surface.distance_m(T_object_session * p.cast<double>());
  return points.empty() ? 0 : 1e3 * sum_m / static_cast<double>(points.size());
}

CandidateErrors errorsOf(const Eigen::Isometry3d& T_a_b, const registration::PartialModel& b,
                         const SessionTruth& truth_a, const SessionTruth& truth_b,
                         const mesh::ReferenceSurface& surface)
{
  const Eigen::Isometry3d T_a_b_true = truth_a.T_session_object * truth_b.T_session_object.inverse();
  const Eigen::Vector3d center = b.center().cast<double>();
  CandidateErrors errors;
  errors.rotation_deg = 180 / M_PI * geometry::rotationAngle_rad(T_a_b_true.inverse() * T_a_b);
  errors.translation_mm = 1e3 * (T_a_b * center - T_a_b_true * center).norm();
  errors.mesh_distance_mm = meshDistance_mm(b.points, truth_a.T_session_object.inverse() * T_a_b, surface);
  return errors;
}

bool isRight(const CandidateErrors& errors, bool surface_suffices)
{
  return (errors.rotation_deg <= RIGHT_DEG && errors.translation_mm <= RIGHT_MM) ||
         (surface_suffices && errors.mesh_distance_mm <= RIGHT_MM);
}

}  // namespace object_modelling::benchmark_alignment
