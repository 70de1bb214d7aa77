#include "dense_residuals.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/base/statistics.h"
#include "object_modelling/rgbd/depth_sampling.h"

namespace object_modelling::registration
{
namespace
{
constexpr float NEAR_PLANE_M = 0.05F;
constexpr float MAX_DEPTH_STEP_RATIO = 0.05F;     // of depth: further off is another surface
constexpr float MIN_INTENSITY_SCALE = 3;          // grey levels: sensor noise and interpolation
constexpr float SYSTEMATIC_DEPTH_RATIO = 0.001F;  // of depth: calibration, which averaging does not remove
constexpr float AGREEMENT_SIGMAS = 3;
constexpr float AGREEMENT_RATIO = 0.005F;  // of depth, for what calibration and oblique surfaces add
constexpr float MIN_FACING_COSINE = 0.15F;
constexpr int SCALE_SAMPLES = 3;  // one of so many residuals is used to estimate the robust scale

/// Bilinear intensity and the central differences at it.
void sampleIntensity(const cv::Mat& gray, const geometry::SubPixel& at, float* value, float* gradient_x,
                     float* gradient_y)
{
  const std::uint8_t* row0 = gray.ptr<std::uint8_t>(at.v - 1) + at.u;
  const std::uint8_t* row1 = row0 + gray.step;
  const std::uint8_t* row2 = row1 + gray.step;
  const std::uint8_t* row3 = row2 + gray.step;
  const auto across = [&at](const std::uint8_t* row, int x) { return geometry::between(row[x], row[x + 1], at.a); };
  const float middle1 = across(row1, 0);
  const float middle2 = across(row2, 0);
  *value = geometry::between(middle1, middle2, at.b);
  *gradient_x = 0.5F * geometry::between(across(row1, 1) - across(row1, -1), across(row2, 1) - across(row2, -1), at.b);
  *gradient_y = 0.5F * geometry::between(middle2 - across(row0, 0), across(row3, 0) - middle1, at.b);
}

/// Standard deviation from the median absolute value.
float robustScale(std::vector<float>* sizes)
{
  return 1.4826F * base::median(sizes);
}

/// Brings the exposure of the frame to that of the reference: equal mean and spread over what both see. Gives the
/// correlation of the two.
double compensateExposure(std::vector<DenseResidual>* all)
{
  double sum_c = 0, sum_r = 0, square_c = 0, square_r = 0, product = 0, count = 0;
  for (const DenseResidual& s : *all)
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
  for (DenseResidual& s : *all)
  {
    s.intensity_residual = gain * (s.intensity_residual - static_cast<float>(mean_c)) -
                           (s.reference_intensity - static_cast<float>(mean_r));
    s.gradient_x *= gain;
    s.gradient_y *= gain;
  }
  return (product / count - mean_c * mean_r) / std::sqrt(variance_c * variance_r);
}
}  // namespace

float averagedDepthSigma_m(const rgbd::SensorNoiseModel& noise_model, float z_m)
{
  const auto noise_m = static_cast<float>(noise_model.axialSigma_m(z_m, 0)) * 0.7F;
  const float systematic_m = SYSTEMATIC_DEPTH_RATIO * z_m;
  return std::sqrt(noise_m * noise_m + systematic_m * systematic_m);
}

namespace
{
/// The depth residual of a point whose normal and place are known; `step_m`: how far it is behind what was measured.
void compareDepth(float step_m, float inverse_z, const rgbd::SensorNoiseModel& noise_model, DenseResiduals* residuals,
                  DenseResidual* s, std::vector<float>* sizes)
{
  const float z_m = s->q.z();
  // Both points lie on one ray: their distance along it, seen along the normal.
  const float foreshortening = -s->normal.dot(s->q) * inverse_z;
  if (!(foreshortening > MIN_FACING_COSINE))
    return;
  ++residuals->with_depth;
  const float sigma_m = averagedDepthSigma_m(noise_model, z_m);
  s->depth_residual = -foreshortening * step_m;
  residuals->agreeing += std::abs(step_m) < AGREEMENT_SIGMAS * sigma_m + AGREEMENT_RATIO * z_m;
  s->depth_sigma = foreshortening * sigma_m;
  s->has_depth = std::abs(step_m) <= MAX_DEPTH_STEP_RATIO * z_m;
  if (s->has_depth && residuals->with_depth % SCALE_SAMPLES == 0)
    sizes->push_back(std::abs(s->depth_residual / s->depth_sigma));
}
}  // namespace

void observe(const DensePoints& points, const DenseLevel& level, const Eigen::Isometry3d& T_camera_reference,
             DenseResiduals* residuals)
{
  const Eigen::Isometry3f T = T_camera_reference.cast<float>();
  const Eigen::Matrix3f R = T.linear();
  const Eigen::Vector3f t = T.translation();
  const auto max_u = static_cast<float>(level.gray.cols - 3);
  const auto max_v = static_cast<float>(level.gray.rows - 3);
  residuals->in_view = residuals->with_depth = residuals->agreeing = 0;
  residuals->pixels_per_point = points.pixels_per_point;
  residuals->edges_per_point = points.edges_per_point;
  residuals->all.clear();
  residuals->all.reserve(points.all.size());
  std::vector<float> depth_sizes, intensity_sizes;
  depth_sizes.reserve(points.all.size() / SCALE_SAMPLES + 1);
  for (const DensePoint& point : points.all)
  {
    const Eigen::Vector3f q = R * point.p + t;
    if (q.z() < NEAR_PLANE_M)
      continue;
    const float inverse_z = 1 / q.z();
    const float u = level.fx * q.x() * inverse_z + level.cx;
    const float v = level.fy * q.y() * inverse_z + level.cy;
    if (!(u >= 1 && v >= 1 && u < max_u && v < max_v))
      continue;
    if (!level.mask.empty() && level.mask.at<std::uint8_t>(cvRound(v), cvRound(u)) == 0)
      continue;
    const geometry::SubPixel at(u, v);
    const rgbd::DepthBetween depth = rgbd::depthBetween(level.depth_m, at);
    const bool one_surface = depth.step_m <= MAX_DEPTH_STEP_RATIO * depth.z_m;
    const float step_m = one_surface ? q.z() - depth.z_m : std::nanf("");
    if (step_m > MAX_DEPTH_STEP_RATIO * q.z())
      continue;  // something is in front
    ++residuals->in_view;
    DenseResidual& s = residuals->all.emplace_back();
    s.q = q;
    if (!std::isnan(step_m) && !point.n.isZero())
    {
      s.normal = R * point.n;
      compareDepth(step_m, inverse_z, level.noise_model, residuals, &s, &depth_sizes);
    }
    s.textured = point.textured;
    if (s.textured)
    {
      // What the frame shows; compensateExposure() makes a residual of it.
      sampleIntensity(level.gray, at, &s.intensity_residual, &s.gradient_x, &s.gradient_y);
      s.reference_intensity = point.intensity;
    }
    if (!s.has_depth && !s.textured)
      residuals->all.pop_back();
  }
  residuals->correlation = compensateExposure(&residuals->all);
  for (std::size_t i = 0; i < residuals->all.size(); i += SCALE_SAMPLES)
    if (residuals->all[i].textured)
      intensity_sizes.push_back(std::abs(residuals->all[i].intensity_residual));
  residuals->depth_scale = std::max(1.0F, robustScale(&depth_sizes));
  residuals->intensity_scale = std::max(MIN_INTENSITY_SCALE, robustScale(&intensity_sizes));
}

}  // namespace object_modelling::registration
