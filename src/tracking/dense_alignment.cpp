#include "dense_alignment.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::tracking
{
namespace
{
constexpr float MIN_DEPTH_M = 0.05F;
constexpr float MAX_DEPTH_STEP_RATIO = 0.05F;     // of depth: further off is another surface
constexpr float MIN_INTENSITY_SCALE = 3;          // grey levels: sensor noise and interpolation
constexpr float SYSTEMATIC_DEPTH_RATIO = 0.001F;  // of depth: calibration, which averaging does not remove
constexpr float AGREEMENT_SIGMAS = 3;
constexpr float AGREEMENT_RATIO = 0.005F;  // of depth, for what calibration and oblique surfaces add
constexpr double CONVERGED_STEP = 1e-4;    // m and rad; the least squares with features goes on from there
constexpr std::size_t MIN_POINTS = 60;
constexpr int SCALE_SAMPLES = 3;  // every so many residuals tell the robust scale well enough

/// A reference point as the frame sees it.
struct Seen
{
  Eigen::Vector3f q;         ///< in the camera frame
  Eigen::Vector3f normal;    ///< rotated; zero: no depth residual
  float depth_residual = 0;  ///< along the normal, m
  float depth_sigma = 0;     ///< of it
  float intensity_residual = 0;
  float reference_intensity = 0;
  float gradient_x = 0, gradient_y = 0;
  bool has_depth = false;
  bool textured = false;
};

/// Averaged sensor noise of both readings, along the optical axis.
float depthSigma_m(float z_m)
{
  const auto noise_m = static_cast<float>(rgbd::axialSigma_m(z_m, 0)) * 0.7F;
  const float systematic_m = SYSTEMATIC_DEPTH_RATIO * z_m;
  return std::sqrt(noise_m * noise_m + systematic_m * systematic_m);
}

/// Depth at a sub-pixel position where its neighbours are one surface; NaN elsewhere.
float interpolateDepth_m(const cv::Mat& depth_m, float u, float v)
{
  const int iu = static_cast<int>(u);
  const int iv = static_cast<int>(v);
  const float a = u - static_cast<float>(iu);
  const float b = v - static_cast<float>(iv);
  const float* upper = depth_m.ptr<float>(iv) + iu;
  const float* lower = depth_m.ptr<float>(iv + 1) + iu;
  const float low = std::min(std::min(upper[0], upper[1]), std::min(lower[0], lower[1]));
  const float high = std::max(std::max(upper[0], upper[1]), std::max(lower[0], lower[1]));
  const float z_m = (1 - b) * ((1 - a) * upper[0] + a * upper[1]) + b * ((1 - a) * lower[0] + a * lower[1]);
  return high - low <= MAX_DEPTH_STEP_RATIO * z_m ? z_m : std::nanf("");
}

void sampleIntensity(const cv::Mat& gray, float u, float v, float* value, float* gradient_x, float* gradient_y)
{
  const int iu = static_cast<int>(u);
  const int iv = static_cast<int>(v);
  const float a = u - static_cast<float>(iu);
  const float b = v - static_cast<float>(iv);
  const std::uint8_t* row0 = gray.ptr<std::uint8_t>(iv - 1) + iu;
  const std::uint8_t* row1 = gray.ptr<std::uint8_t>(iv) + iu;
  const std::uint8_t* row2 = gray.ptr<std::uint8_t>(iv + 1) + iu;
  const std::uint8_t* row3 = gray.ptr<std::uint8_t>(iv + 2) + iu;
  const auto across = [a](const std::uint8_t* row, int at)
  { return (1 - a) * static_cast<float>(row[at]) + a * static_cast<float>(row[at + 1]); };
  const float middle1 = across(row1, 0);
  const float middle2 = across(row2, 0);
  *value = (1 - b) * middle1 + b * middle2;
  *gradient_x = 0.5F * ((1 - b) * (across(row1, 1) - across(row1, -1)) + b * (across(row2, 1) - across(row2, -1)));
  *gradient_y = 0.5F * ((1 - b) * (middle2 - across(row0, 0)) + b * (across(row3, 0) - middle1));
}

/// Standard deviation from the median absolute value.
float robustScale(std::vector<float>* sizes)
{
  if (sizes->empty())
    return 0;
  const auto middle = sizes->begin() + static_cast<std::ptrdiff_t>(sizes->size() / 2);
  std::nth_element(sizes->begin(), middle, sizes->end());
  return 1.4826F * *middle;
}

/// Cauchy's weight: what is far off (occlusion, highlights) has little say, but enough to pull a poor start right.
float cauchyWeight(float residual_scales)
{
  constexpr float WIDTH = 2.385F;  // 95 % efficient for normal errors
  const float ratio = residual_scales / WIDTH;
  return 1 / (1 + ratio * ratio);
}

/// Sums of one kind of residual, whose Jacobian is [a; q x a] for a motion on the left of the camera's transform.
class Sums
{
public:
  void add(const Eigen::Vector3f& q, const Eigen::Vector3f& a, float residual, float weight)
  {
    const Eigen::Vector3f moment = q.cross(a);
    // Six entries, the residual, and nothing: two registers of four.
    Row row;
    row << a.x(), a.y(), a.z(), moment.x(), moment.y(), moment.z(), residual, 0;
    const Row weighted = weight * row;
    for (int column = 0; column < 6; ++column)
      products_.col(column) += row(column) * weighted;
  }
  void addTo(NormalEquations* equations, double factor) const
  {
    equations->A += factor * products_.topRows<6>().cast<double>();
    equations->b -= factor * products_.row(6).transpose().cast<double>();
  }

private:
  using Row = Eigen::Matrix<float, 8, 1>;
  Eigen::Matrix<float, 8, 6> products_ = Eigen::Matrix<float, 8, 6>::Zero();
};

/// Brings the exposure of the frame to that of the reference: equal mean and spread over what both see. Gives the
/// correlation of the two.
double compensateExposure(std::vector<Seen>* seen)
{
  double sum_c = 0, sum_r = 0, square_c = 0, square_r = 0, product = 0, count = 0;
  for (const Seen& s : *seen)
    if (s.textured)
    {
      count += 1;
      sum_c += s.intensity_residual;
      sum_r += s.reference_intensity;
      square_c += s.intensity_residual * s.intensity_residual;
      square_r += s.reference_intensity * s.reference_intensity;
      product += s.intensity_residual * s.reference_intensity;
    }
  if (count < 1)
    return 0;
  const double mean_c = sum_c / count;
  const double mean_r = sum_r / count;
  const double variance_c = std::max(1.0, square_c / count - mean_c * mean_c);
  const double variance_r = std::max(1.0, square_r / count - mean_r * mean_r);
  const auto gain = static_cast<float>(std::clamp(std::sqrt(variance_r / variance_c), 0.7, 1.4));
  for (Seen& s : *seen)
  {
    s.intensity_residual = gain * (s.intensity_residual - static_cast<float>(mean_c)) -
                           (s.reference_intensity - static_cast<float>(mean_r));
    s.gradient_x *= gain;
    s.gradient_y *= gain;
  }
  return (product / count - mean_c * mean_r) / std::sqrt(variance_c * variance_r);
}
}  // namespace

DenseTerm evaluateDense(const std::vector<DensePoint>& points, const DenseLevel& level,
                        const Eigen::Isometry3d& T_camera_session, const Eigen::Isometry3d& T_session_reference,
                        const DenseAlignmentOptions& options)
{
  DenseTerm term;
  const Eigen::Isometry3f T = (T_camera_session * T_session_reference).cast<float>();
  const Eigen::Matrix3f R = T.linear();
  const Eigen::Vector3f t = T.translation();
  const auto max_u = static_cast<float>(level.gray.cols - 3);
  const auto max_v = static_cast<float>(level.gray.rows - 3);
  std::vector<Seen> seen;
  seen.reserve(points.size());
  std::vector<float> depth_sizes, intensity_sizes;
  int with_depth = 0;
  int agreeing = 0;
  for (const DensePoint& point : points)
  {
    Seen s;
    s.q = R * point.p + t;
    if (s.q.z() < MIN_DEPTH_M)
      continue;
    const float inverse_z = 1 / s.q.z();
    const float u = level.fx * s.q.x() * inverse_z + level.cx;
    const float v = level.fy * s.q.y() * inverse_z + level.cy;
    if (!(u >= 1 && v >= 1 && u < max_u && v < max_v))
      continue;
    if (!level.mask.empty() && level.mask.at<std::uint8_t>(cvRound(v), cvRound(u)) == 0)
      continue;
    const float depth_m = interpolateDepth_m(level.depth_m, u, v);
    const float step_m = s.q.z() - depth_m;
    if (step_m > MAX_DEPTH_STEP_RATIO * s.q.z())
      continue;  // something is in front
    ++term.in_view;
    if (!std::isnan(step_m) && !point.n.isZero())
    {
      s.normal = R * point.n;
      // Both points lie on one ray: their distance along it, seen along the normal.
      const float foreshortening = -s.normal.dot(s.q) * inverse_z;
      if (foreshortening > 0.15F)
      {
        ++with_depth;
        s.depth_sigma = depthSigma_m(s.q.z());
        s.depth_residual = -foreshortening * step_m;
        agreeing += std::abs(s.depth_residual) <
                    foreshortening * (AGREEMENT_SIGMAS * s.depth_sigma + AGREEMENT_RATIO * s.q.z());
        s.depth_sigma *= foreshortening;
        s.has_depth = std::abs(step_m) <= MAX_DEPTH_STEP_RATIO * s.q.z();
        if (s.has_depth && with_depth % SCALE_SAMPLES == 0)
          depth_sizes.push_back(std::abs(s.depth_residual / s.depth_sigma));
      }
    }
    s.textured = point.textured;
    if (s.textured)
    {
      // The intensity alone for now; the residual follows when the exposures are known.
      sampleIntensity(level.gray, u, v, &s.intensity_residual, &s.gradient_x, &s.gradient_y);
      s.reference_intensity = point.intensity;
    }
    if (s.has_depth || s.textured)
      seen.push_back(s);
  }
  term.overlap = points.empty() ? 0 : static_cast<double>(term.in_view) / static_cast<double>(points.size());
  term.depth_agreement = with_depth > 0 ? static_cast<double>(agreeing) / with_depth : 0;
  if (seen.size() < MIN_POINTS)
    return term;
  term.correlation = compensateExposure(&seen);
  for (std::size_t i = 0; i < seen.size(); i += SCALE_SAMPLES)
    if (seen[i].textured)
      intensity_sizes.push_back(std::abs(seen[i].intensity_residual));
  const float depth_scale = std::max(1.0F, robustScale(&depth_sizes));
  const float intensity_scale = std::max(MIN_INTENSITY_SCALE, robustScale(&intensity_sizes));
  term.intensity_scale = intensity_scale;
  Sums depth, intensity;
  for (const Seen& s : seen)
  {
    if (s.has_depth)
    {
      const float per_sigma = 1 / (depth_scale * s.depth_sigma);
      const float weight = cauchyWeight(s.depth_residual * per_sigma) * per_sigma * per_sigma;
      depth.add(s.q, s.normal, s.depth_residual, weight);
    }
    if (s.textured)
    {
      const float weight = cauchyWeight(s.intensity_residual / intensity_scale) / (intensity_scale * intensity_scale);
      const float inverse_z = 1 / s.q.z();
      const float x = s.gradient_x * level.fx * inverse_z;
      const float y = s.gradient_y * level.fy * inverse_z;
      intensity.add(s.q, { x, y, -(x * s.q.x() + y * s.q.y()) * inverse_z }, s.intensity_residual, weight);
    }
  }
  depth.addTo(&term.equations, 1 / options.correlated_depths);
  intensity.addTo(&term.equations, 1 / options.correlated_intensities);
  return term;
}

DenseAlignment alignDense(const DenseReference& reference, const Eigen::Isometry3d& T_session_reference,
                          const DensePyramid& frame, const Eigen::Isometry3d& T_session_camera_start,
                          const geometry::Matrix6d& prior, const DenseAlignmentOptions& options)
{
  DenseAlignment alignment;
  const Eigen::Isometry3d T_camera_session_start = T_session_camera_start.inverse();
  Eigen::Isometry3d T_camera_session = T_camera_session_start;
  const int coarsest = std::min({ static_cast<int>(reference.levels().size()) - 1,
                                  static_cast<int>(frame.levels().size()) - 1, options.coarsest_level });
  for (int level = coarsest; level >= options.finest_level; --level)
  {
    bool small_step = false;
    for (int iteration = 0; iteration < options.max_iterations && !small_step; ++iteration)
    {
      alignment.term = evaluateDense(reference.levels()[level], frame.levels()[level], T_camera_session,
                                     T_session_reference, options);
      alignment.T_session_camera = T_camera_session.inverse();
      NormalEquations equations = alignment.term.equations;
      if (equations.A.isZero())
        return alignment;
      const geometry::Vector6d off_start =
          geometry::vectorFromIsometry(T_camera_session * T_camera_session_start.inverse());
      equations.A += prior;
      equations.b -= prior * off_start;
      const geometry::Vector6d step = equations.A.ldlt().solve(equations.b);
      if (!step.allFinite())
        return alignment;
      const double coarse = frame.levels()[level].step / static_cast<double>(frame.levels()[0].step);
      small_step = step.cwiseAbs().maxCoeff() < CONVERGED_STEP * coarse * coarse;
      // The term stands for the pose at which it was evaluated, so the last step is left to whoever uses the term.
      if (!small_step || level > options.finest_level)
        T_camera_session = geometry::normalised(geometry::isometryFromVector(step) * T_camera_session);
    }
    alignment.converged = small_step;
  }
  return alignment;
}

}  // namespace object_modelling::tracking
