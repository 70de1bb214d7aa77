#include "edge_fraying.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::calibration
{
namespace
{
constexpr int REACH_PX = EdgeProfile::REACH_PX;
constexpr double MIN_LENGTH_PX = 60;
constexpr double CORNER_PX = 10;
constexpr double FAR_M = 0.05;       ///< behind the wall: background
constexpr double MAX_WANDER_PX = 2;  ///< of the rim about its straight line
constexpr double MIN_PROFILE_LENGTH_PX = 400;
constexpr std::size_t MAX_EDGES = 4;  ///< per frame

enum Kind : std::uint8_t
{
  OTHER = 0,  ///< nearer than the wall
  WALL = 1,
  BEHIND = 2,  ///< background
  MISSING = 3,
};

/// A straight rim; `out` is the normal that points away from the wall.
struct Rim
{
  Eigen::Vector2d start, along, out;
  double length_px = 0;
};

cv::Mat classify(const rgbd::Frame& frame, const WallView& view)
{
  cv::Mat kinds(frame.depth_m.size(), CV_8UC1);
  for (int v = 0; v < kinds.rows; ++v)
    for (int u = 0; u < kinds.cols; ++u)
    {
      const double z_m = frame.depthAt_m(u, v);
      const double wall_m =
          view.depthAt_m((u - frame.camera.cx) / frame.camera.fx, (v - frame.camera.cy) / frame.camera.fy);
      const double gate_m = std::max(FAR_M, 6 * view.noise_m);
      kinds.at<std::uint8_t>(v, u) = !(z_m > 0)                         ? MISSING
                                     : z_m > wall_m + gate_m            ? BEHIND
                                     : std::abs(z_m - wall_m) <= gate_m ? WALL
                                                                        : OTHER;
    }
  return kinds;
}

std::vector<Rim> candidates(const cv::Mat& kinds, const cv::Mat& region)
{
  cv::Mat wall, lines, grown;
  cv::dilate(region, grown, cv::getStructuringElement(cv::MORPH_RECT, { 15, 15 }));
  wall = (kinds == WALL) & grown;
  cv::medianBlur(wall, wall, 7);
  cv::Canny(wall, lines, 50, 150);
  std::vector<cv::Vec4i> segments;
  cv::HoughLinesP(lines, segments, 1, CV_PI / 360, 50, MIN_LENGTH_PX + 2 * CORNER_PX, 6);
  std::vector<Rim> rims;
  for (const cv::Vec4i& segment : segments)
  {
    const Eigen::Vector2d start(segment[0], segment[1]), end(segment[2], segment[3]);
    Rim rim;
    rim.along = (end - start).normalized();
    rim.length_px = (end - start).norm() - 2 * CORNER_PX;
    rim.start = start + CORNER_PX * rim.along;
    rim.out = { -rim.along.y(), rim.along.x() };
    rims.push_back(rim);
  }
  std::stable_sort(rims.begin(), rims.end(), [](const Rim& a, const Rim& b) { return a.length_px > b.length_px; });
  return rims;
}

bool sameLine(const Rim& a, const Rim& b)
{
  const Eigen::Vector2d middle = b.start + 0.5 * b.length_px * b.along;
  return std::abs(a.along.dot(b.along)) > 0.98 && std::abs(a.out.dot(middle - a.start)) < 2 * REACH_PX;
}

Kind kindAt(const cv::Mat& kinds, const Eigen::Vector2d& at)
{
  const cv::Point pixel(cvRound(at.x()), cvRound(at.y()));
  return cv::Rect({ 0, 0 }, kinds.size()).contains(pixel) ? static_cast<Kind>(kinds.at<std::uint8_t>(pixel)) : OTHER;
}

/// Turns `out` away from the wall; false unless there is wall on one side and measured background on the other: depth
/// also ends, in a straight line and without fraying, where the depth camera's view or its projector's light does.
bool orient(const cv::Mat& kinds, Rim* rim)
{
  int wall[2] = { 0, 0 }, behind[2] = { 0, 0 }, count = 0;
  for (double s = 0; s < rim->length_px; s += 2, ++count)
    for (const int side : { 0, 1 })
    {
      const Kind kind = kindAt(kinds, rim->start + s * rim->along + (side == 0 ? -1 : 1) * REACH_PX * rim->out);
      wall[side] += kind == WALL;
      behind[side] += kind == BEHIND;
    }
  if (wall[1] > wall[0])
  {
    rim->out = -rim->out;
    std::swap(wall[0], wall[1]);
    std::swap(behind[0], behind[1]);
  }
  return wall[0] > 0.9 * count && behind[1] > 0.8 * count;
}

/// Moves the line to where the wall's pixels end, by least squares; false if the rim is not straight.
bool straighten(const cv::Mat& kinds, Rim* rim)
{
  std::vector<Eigen::Vector2d> ends;  // along the rim, across it
  for (double s = 0; s < rim->length_px; s += 1)
  {
    double across = -REACH_PX - 0.5;
    for (int d = -REACH_PX; d <= REACH_PX; ++d)
      across += kindAt(kinds, rim->start + s * rim->along + d * rim->out) == WALL;
    ends.emplace_back(s, across);
  }
  Eigen::Vector2d line = Eigen::Vector2d::Zero();
  double wander_px = 2 * MAX_WANDER_PX;
  for (int iteration = 0; iteration < 4; ++iteration)
  {
    Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    double sum = 0, count = 0;
    for (const Eigen::Vector2d& end : ends)
    {
      const Eigen::Vector2d row(1, end.x());
      const double error_px = end.y() - row.dot(line);
      if (iteration > 0 && std::abs(error_px) > 3 * wander_px)
        continue;
      A += row * row.transpose();
      b += row * end.y();
      sum += error_px * error_px;
      count += 1;
    }
    if (count < 0.8 * static_cast<double>(ends.size()))
      return false;
    if (iteration > 0)
      wander_px = std::max(0.3, std::sqrt(sum / count));
    line = geometry::solveSymmetric(A, b);
  }
  const Eigen::Vector2d start = rim->start + line[0] * rim->out;
  const Eigen::Vector2d end =
      rim->start + rim->length_px * rim->along + (line[0] + line[1] * rim->length_px) * rim->out;
  const bool outward = rim->out.dot(Eigen::Vector2d(-rim->along.y(), rim->along.x())) > 0;
  rim->along = (end - start).normalized();
  rim->start = start;
  rim->out = (outward ? 1 : -1) * Eigen::Vector2d(-rim->along.y(), rim->along.x());
  return wander_px <= MAX_WANDER_PX && line.allFinite() && std::abs(line[1]) < 0.1;
}

void addProfile(const cv::Mat& kinds, const Rim& rim, EdgeProfile* profile)
{
  const Eigen::Vector2d end = rim.start + rim.length_px * rim.along;
  const int left = static_cast<int>(std::min(rim.start.x(), end.x())) - REACH_PX;
  const int top = static_cast<int>(std::min(rim.start.y(), end.y())) - REACH_PX;
  const int right = static_cast<int>(std::max(rim.start.x(), end.x())) + REACH_PX + 1;
  const int bottom = static_cast<int>(std::max(rim.start.y(), end.y())) + REACH_PX + 1;
  for (int v = std::max(0, top); v <= std::min(kinds.rows - 1, bottom); ++v)
    for (int u = std::max(0, left); u <= std::min(kinds.cols - 1, right); ++u)
    {
      const Eigen::Vector2d from_start = Eigen::Vector2d(u, v) - rim.start;
      const double along_px = from_start.dot(rim.along), across_px = from_start.dot(rim.out);
      if (along_px < 0 || along_px > rim.length_px || std::abs(across_px) >= REACH_PX)
        continue;
      const auto bin = static_cast<std::size_t>((across_px + REACH_PX) * EdgeProfile::BINS_PER_PX);
      profile->all[bin] += 1;
      profile->wall[bin] += kinds.at<std::uint8_t>(v, u) == WALL;
    }
}

/// Squared error of the best step with this place and width: its levels follow by least squares.
double stepError(const EdgeProfile& profile, double middle_px, double sigma_px)
{
  Eigen::Matrix2d A = Eigen::Matrix2d::Identity() * 1e-9;
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double squares = 0;
  for (int i = 0; i < EdgeProfile::BINS; ++i)
  {
    if (profile.all[i] <= 0)
      continue;
    const double d = (i + 0.5) / EdgeProfile::BINS_PER_PX - REACH_PX;
    const Eigen::Vector2d row(1, 0.5 * std::erfc((d - middle_px) / (M_SQRT2 * sigma_px)));
    const double share = profile.wall[i] / profile.all[i];
    A += profile.all[i] * row * row.transpose();
    b += profile.all[i] * share * row;
    squares += profile.all[i] * share * share;
  }
  const Eigen::Vector2d levels = geometry::solveSymmetric(A, b);
  return squares - 2 * levels.dot(b) + levels.dot(A * levels);
}

}  // namespace

void addEdges(const rgbd::Frame& frame, const WallView& view, EdgeProfiles* profiles)
{
  const cv::Mat kinds = classify(frame, view);
  std::vector<Rim> taken;
  for (Rim& rim : candidates(kinds, view.region))
  {
    if (taken.size() >= MAX_EDGES)
      return;
    if (rim.length_px < MIN_LENGTH_PX ||
        std::any_of(taken.begin(), taken.end(), [&](const Rim& other) { return sameLine(other, rim); }) ||
        !orient(kinds, &rim) || !straighten(kinds, &rim) || !straighten(kinds, &rim))
      continue;
    taken.push_back(rim);
    const Eigen::Vector2d middle = rim.start + 0.5 * rim.length_px * rim.along;
    const double theta_rad = view.theta_rad((middle.x() - frame.camera.cx) / frame.camera.fx,
                                            (middle.y() - frame.camera.cy) / frame.camera.fy);
    EdgeProfile& profile = (*profiles)[static_cast<int>(theta_rad * 18 / M_PI)];
    addProfile(kinds, rim, &profile);
    profile.theta_sum_rad += theta_rad;
    profile.length_px += rim.length_px;
    ++profile.edge_count;
  }
}

double frayingSigma_px(const EdgeProfile& profile)
{
  double best_sigma_px = 0, least = std::numeric_limits<double>::infinity();
  for (double middle_px = -1.5; middle_px <= 1.5; middle_px += 0.05)
    for (double sigma_px = 0.1; sigma_px <= 4; sigma_px *= 1.02)
    {
      const double error = stepError(profile, middle_px, sigma_px);
      if (error < least)
      {
        least = error;
        best_sigma_px = sigma_px;
      }
    }
  return best_sigma_px < 3.9 ? best_sigma_px : 0;
}

void fitLateralSigma(const EdgeProfiles& profiles, const NoiseCalibrationOptions& options,
                     NoiseCalibration* calibration)
{
  rgbd::SensorNoiseModel& model = calibration->model;
  const auto shape = [](double theta_rad) { return theta_rad / (M_PI / 2 - theta_rad); };
  CoefficientReport constant{ "lateral_constant_px", false, "" }, grazing{ "lateral_grazing_px", false, "" };
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double length_px = 0, widest_rad = 0, mean_px = 0;
  int groups = 0;
  for (const auto& [step, profile] : profiles)
  {
    const double sigma_px = profile.length_px >= MIN_PROFILE_LENGTH_PX ? frayingSigma_px(profile) : 0;
    if (!(sigma_px > 0))
      continue;
    const double theta_rad = profile.theta_sum_rad / profile.edge_count;
    const Eigen::Vector2d row(1, shape(theta_rad));
    A += profile.length_px * row * row.transpose();
    b += profile.length_px * sigma_px * row;
    mean_px += profile.length_px * (sigma_px - model.lateral_grazing_px * row[1]);
    length_px += profile.length_px;
    widest_rad = std::max(widest_rad, theta_rad);
    calibration->edge_count += profile.edge_count;
    calibration->lateral_bins.push_back({ theta_rad, profile.edge_count, profile.length_px, sigma_px });
    ++groups;
  }
  constant.fitted = groups > 0;
  if (groups == 0)
    constant.reason = grazing.reason =
        "no straight rim of the wall before a far background: show the edge of an open door";
  else
  {
    constant.reason = std::to_string(calibration->edge_count) + " straight edges";
    grazing.reason = widest_rad < options.grazing_from_rad ? "no edges at more than 65 deg from the wall's normal"
                                                           : "the edges do not fray more at large angles";
    model.lateral_constant_px = std::clamp(mean_px / length_px, 0.0, 20.0);
    const Eigen::Vector2d both = geometry::solveSymmetric(A, b);
    if (groups >= 3 && widest_rad >= options.grazing_from_rad && both[0] > 0 && both[1] >= 0 && both[1] < 20)
    {
      model.lateral_constant_px = both[0];
      model.lateral_grazing_px = both[1];
      grazing = { grazing.name, true, constant.reason };
    }
  }
  calibration->coefficients.push_back(constant);
  calibration->coefficients.push_back(grazing);
}

}  // namespace object_modelling::calibration
