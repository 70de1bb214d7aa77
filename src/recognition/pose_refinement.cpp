#include "pose_refinement.h"

#include <cmath>

#include "object_modelling/geometry/linear_systems.h"
#include "object_modelling/geometry/normal_equations.h"
#include "object_modelling/geometry/projection.h"
#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::recognition
{
namespace
{
constexpr float FACING_COSINE = 0.2F;
constexpr float PAIR_COSINE = 0.6F;
constexpr double LEAST_GATE_M = 0.006;
constexpr float SEEN_AT_M = 0.008F, QUICK_COSINE = 0.7F;
constexpr int MIN_PAIRS = 12;
constexpr double CONVERGED_M = 1e-4;

/// A point of the object's surface with what the scene has there.
struct SurfacePair
{
  Eigen::Vector3f p, q, m;  ///< point; the scene's point and normal at its pixel
  int column, row;
  std::size_t index;  ///< of the surface's point
};

std::vector<SurfacePair> pairsOf(const Scene& scene, const OrientedPoints& surface,
                                 const Eigen::Isometry3d& T_camera_model, double gate_m, std::size_t step = 1)
{
  const Eigen::Isometry3f T = T_camera_model.cast<float>();
  std::vector<SurfacePair> pairs;
  for (std::size_t i = 0; i < surface.size(); i += step)
  {
    const Eigen::Vector3f p = T * surface.points[i], n = T.linear() * surface.normals[i];
    if (!(-n.dot(p.normalized()) > FACING_COSINE))
      continue;
    const auto at = geometry::projectionOf(scene.frame.camera, p);
    if (!at.inside)
      continue;
    const Eigen::Vector3f q = scene.frame.point(at.column, at.row), m = scene.normal(at.column, at.row);
    if (q.allFinite() && m.allFinite() && n.dot(m) > PAIR_COSINE && (q - p).squaredNorm() < gate_m * gate_m)
      pairs.push_back({ p, q, m, at.column, at.row, i });
  }
  return pairs;
}

geometry::NormalEquations surfaceEquations(const Scene& scene, const std::vector<SurfacePair>& pairs,
                                           const Eigen::Vector3d& center, RefinedPose* result)
{
  geometry::NormalEquations equations;
  double squares = 0;
  for (const SurfacePair& pair : pairs)
  {
    const double residual = pair.m.dot(pair.p - pair.q);
    const double sigma_m = 0.001 + sigmaAt(scene, pair.q.z());
    Eigen::Matrix<double, 1, 6> J;
    const Eigen::Vector3d m = pair.m.cast<double>(), arm = pair.p.cast<double>() - center;
    J << m.transpose(), arm.cross(m).transpose();
    equations.add(J, residual, geometry::huberWeight(residual / sigma_m) / (sigma_m * sigma_m));
    squares += residual * residual;
  }
  result->pairs = static_cast<int>(pairs.size());
  result->rms_m = pairs.empty() ? 0 : std::sqrt(squares / static_cast<double>(pairs.size()));
  return equations;
}

/// Gain and offset of light: seen = gain * drawn + offset.
std::pair<double, double> lightOf(const std::vector<SurfacePair>& pairs, const Scene& scene,
                                  const ObjectKnowledge& object)
{
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const SurfacePair& pair : pairs)
  {
    const double drawn = object.surface.lab[pair.index].x(), seen = scene.lightness.at<float>(pair.row, pair.column);
    n += 1;
    x += drawn;
    y += seen;
    xx += drawn * drawn;
    xy += drawn * seen;
  }
  const double variance = xx / n - x * x / (n * n);
  const double gain = std::clamp(variance > 1 ? (xy / n - x * y / (n * n)) / variance : 1.0, 0.5, 1.6);
  return { gain, (y - gain * x) / n };
}

geometry::NormalEquations textureEquations(const Scene& scene, const ObjectKnowledge& object,
                                           const std::vector<SurfacePair>& pairs, const Eigen::Vector3d& center)
{
  constexpr double SIGMA = 6, CORRELATED = 3;
  geometry::NormalEquations equations;
  const auto [gain, offset] = lightOf(pairs, scene, object);
  for (const SurfacePair& pair : pairs)
  {
    const double residual =
        scene.lightness.at<float>(pair.row, pair.column) - (gain * object.surface.lab[pair.index].x() + offset);
    const double gx = scene.gradient_x.at<float>(pair.row, pair.column) * scene.frame.camera.fx;
    const double gy = scene.gradient_y.at<float>(pair.row, pair.column) * scene.frame.camera.fy;
    const Eigen::Vector3d p = pair.p.cast<double>();
    const Eigen::Vector3d change(gx / p.z(), gy / p.z(), -(gx * p.x() + gy * p.y()) / (p.z() * p.z()));
    Eigen::Matrix<double, 1, 6> J;
    J << change.transpose(), (p - center).cross(change).transpose();
    equations.add(J, residual, geometry::huberWeight(residual / SIGMA) / (CORRELATED * SIGMA * SIGMA));
  }
  return equations;
}

/// Inverse of the information, in the camera frame's origin. Neighboring pixels share errors: every CORRELATED-th
/// counts.
geometry::Matrix6d covarianceOf(const geometry::NormalEquations& equations, const ObjectKnowledge& object,
                                const Eigen::Vector3d& center)
{
  constexpr double CORRELATED = 10;
  geometry::Matrix6d information = equations.A / CORRELATED;
  information.diagonal().head<3>().array() += 1 / (object.diameter_m * object.diameter_m);
  information.diagonal().tail<3>().array() += 1;
  const geometry::Matrix6d to_camera = geometry::adjoint(Eigen::Isometry3d(Eigen::Translation3d(center)));
  return to_camera * geometry::inverseOf(information) * to_camera.transpose();
}

/// Takes a step; what nothing holds stays. Returns its length at the object's rim (m); negative if there is none.
double step(const geometry::NormalEquations& equations, const ObjectKnowledge& object, const Eigen::Vector3d& center,
            double damping_ratio, Eigen::Isometry3d* T_camera_model)
{
  const double size_m = object.diameter_m / 3;
  geometry::Matrix6d damped = equations.A;
  const double held = damping_ratio * equations.A.topLeftCorner<3, 3>().trace() / 3;
  damped.diagonal().head<3>().array() += held;
  damped.diagonal().tail<3>().array() += held * size_m * size_m;
  const geometry::Vector6d motion = geometry::solveSymmetric(damped, equations.b);
  if (!motion.allFinite())
    return -1;
  const Eigen::Isometry3d about_center =
      Eigen::Translation3d(center) * geometry::isometryFromVector(motion) * Eigen::Translation3d(-center);
  *T_camera_model = geometry::normalized(about_center * *T_camera_model);
  return motion.head<3>().norm() + size_m * motion.tail<3>().norm();
}
}  // namespace

RefinedPose refine(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3d& T_camera_model_start,
                   double start_gate_m, int iterations, std::size_t step_points)
{
  RefinedPose result;
  result.T_camera_model = T_camera_model_start;
  double gate_m = start_gate_m;
  for (int iteration = 0; iteration < iterations; ++iteration)
  {
    const Eigen::Vector3d center = result.T_camera_model * object.center_model.cast<double>();
    const std::vector<SurfacePair> pairs =
        pairsOf(scene, object.surface.oriented, result.T_camera_model, gate_m, step_points);
    const geometry::NormalEquations equations = surfaceEquations(scene, pairs, center, &result);
    if (result.pairs < MIN_PAIRS)
      break;
    const double moved_m = step(equations, object, center, 1e-3, &result.T_camera_model);
    gate_m = std::max(LEAST_GATE_M, 0.75 * gate_m);
    if (moved_m < CONVERGED_M)
      break;
  }
  return result;
}

RefinedPose refineWithTexture(const Scene& scene, const ObjectKnowledge& object,
                              const Eigen::Isometry3d& T_camera_model_start, int iterations)
{
  RefinedPose result;
  result.T_camera_model = T_camera_model_start;
  for (int iteration = 0; iteration < iterations; ++iteration)
  {
    const Eigen::Vector3d center = result.T_camera_model * object.center_model.cast<double>();
    const std::vector<SurfacePair> pairs =
        pairsOf(scene, object.surface.oriented, result.T_camera_model, 1.5 * LEAST_GATE_M);
    geometry::NormalEquations equations = surfaceEquations(scene, pairs, center, &result);
    if (result.pairs < MIN_PAIRS)
      break;
    equations += textureEquations(scene, object, pairs, center);
    result.covariance = covarianceOf(equations, object, center);
    if (step(equations, object, center, 1e-4, &result.T_camera_model) < CONVERGED_M)
      break;
  }
  return result;
}

float colorCorrelation(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3f& T_camera_model)
{
  const std::vector<SurfacePair> pairs =
      pairsOf(scene, object.surface.oriented, T_camera_model.cast<double>(), 1.5 * LEAST_GATE_M);
  if (pairs.size() < 2 * MIN_PAIRS)
    return 0;
  Eigen::Vector3d drawn = Eigen::Vector3d::Zero(), seen = drawn;
  const auto colors = [&](const SurfacePair& pair)
  {
    const cv::Vec3f& lab = scene.lab.at<cv::Vec3f>(pair.row, pair.column);
    return std::pair<Eigen::Vector3d, Eigen::Vector3d>{ object.surface.lab[pair.index].cast<double>(),
                                                        Eigen::Vector3d(lab[0], lab[1], lab[2]) };
  };
  for (const SurfacePair& pair : pairs)
  {
    drawn += colors(pair).first;
    seen += colors(pair).second;
  }
  drawn /= static_cast<double>(pairs.size());
  seen /= static_cast<double>(pairs.size());
  double product = 0, square_drawn = 0, square_seen = 0;
  for (const SurfacePair& pair : pairs)
  {
    const auto [a, b] = colors(pair);
    product += (a - drawn).dot(b - seen);
    square_drawn += (a - drawn).squaredNorm();
    square_seen += (b - seen).squaredNorm();
  }
  const double floor = 16.0 * static_cast<double>(pairs.size());
  return static_cast<float>(product / std::sqrt(std::max(square_drawn, floor) * std::max(square_seen, floor)));
}

float quickScore(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3f& T_camera_model, int step)
{
  const OrientedPoints& surface = object.surface.oriented;
  int facing = 0, seen = 0, through = 0;
  for (std::size_t i = 0; i < surface.size(); i += static_cast<std::size_t>(step))
  {
    const Eigen::Vector3f p = T_camera_model * surface.points[i], n = T_camera_model.linear() * surface.normals[i];
    if (!(-n.dot(p.normalized()) > FACING_COSINE))
      continue;
    ++facing;
    const auto at = geometry::projectionOf(scene.frame.camera, p);
    if (!at.inside)
      continue;
    const float measured_m = scene.frame.depthAt_m(at.column, at.row);
    const auto visibility = rgbd::visibilityOf<float>(at.z_m, measured_m, SEEN_AT_M);
    if (visibility == rgbd::Visibility::IN_FRONT)
      ++through;
    else if (visibility == rgbd::Visibility::ON)
    {
      const Eigen::Vector3f m = scene.normal(at.column, at.row);
      if (m.allFinite() && n.dot(m) > QUICK_COSINE)
        ++seen;
    }
  }
  return facing > 0 ? static_cast<float>(seen - through) / static_cast<float>(facing) : -1;
}

}  // namespace object_modelling::recognition
