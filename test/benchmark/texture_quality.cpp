#include "texture_quality.h"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace object_modelling::benchmark_texture
{
namespace
{
/// gain, offset
cv::Vec2d fit(const cv::Mat& from, const cv::Mat& to, const cv::Mat& mask, bool with_offset)
{
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (int v = 0; v < mask.rows; ++v)
    for (int u = 0; u < mask.cols; ++u)
    {
      if (!mask.at<std::uint8_t>(v, u))
        continue;
      const double a = from.at<float>(v, u), b = to.at<float>(v, u);
      n += 1;
      x += a;
      y += b;
      xx += a * a;
      xy += a * b;
    }
  if (!with_offset)
    return { xx > 0 ? xy / xx : 1, 0 };
  const double determinant = n * xx - x * x;
  const double gain = determinant > 0 ? (n * xy - x * y) / determinant : 1;
  return { gain, (y - gain * x) / n };
}
}  // namespace

double psnrAfterFit_dB(const cv::Mat& image, const cv::Mat& reference, const cv::Mat& mask, bool with_offset,
                       cv::Mat* fitted)
{
  const int count = cv::countNonZero(mask);
  if (count == 0)
    return std::numeric_limits<double>::quiet_NaN();
  std::vector<cv::Mat> channels, targets;
  cv::Mat image_f, reference_f;
  image.convertTo(image_f, CV_32F);
  reference.convertTo(reference_f, CV_32F);
  cv::split(image_f, channels);
  cv::split(reference_f, targets);
  double squares = 0;
  for (int c = 0; c < 3; ++c)
  {
    const cv::Vec2d line = fit(channels[c], targets[c], mask, with_offset);
    channels[c].convertTo(channels[c], CV_32F, line[0], line[1]);
    squares += std::pow(cv::norm(channels[c], targets[c], cv::NORM_L2, mask), 2);
  }
  if (fitted != nullptr)
  {
    cv::merge(channels, *fitted);
    fitted->convertTo(*fitted, CV_8U);
  }
  return 10 * std::log10(255. * 255. * 3 * count / std::max(squares, 1e-9));
}

double psnrUnderLight_dB(const cv::Mat& image, const cv::Mat& reference, const cv::Mat& normals, const cv::Mat& mask,
                         cv::Mat* fitted)
{
  using Row = Eigen::Matrix<double, 5, 1>;
  const int count = cv::countNonZero(mask);
  if (count == 0)
    return std::numeric_limits<double>::quiet_NaN();
  cv::Mat lit = reference.clone();
  double squares = 0;
  for (int c = 0; c < 3; ++c)
  {
    const auto row_at = [&](int v, int u)
    {
      const auto& n = normals.at<cv::Vec3f>(v, u);
      const double r = reference.at<cv::Vec3b>(v, u)[c];
      Row row;
      row << r, r * n[0], r * n[1], r * n[2], 1;
      return row;
    };
    const auto for_each = [&](const auto& action)
    {
      for (int v = 0; v < mask.rows; ++v)
        for (int u = 0; u < mask.cols; ++u)
          if (mask.at<std::uint8_t>(v, u))
            action(v, u);
    };
    Eigen::Matrix<double, 5, 5> normal = 1e-3 * Eigen::Matrix<double, 5, 5>::Identity();
    Row right = Row::Zero();
    for_each(
        [&](int v, int u)
        {
          const Row row = row_at(v, u);
          normal += row * row.transpose();
          right += image.at<cv::Vec3b>(v, u)[c] * row;
        });
    const Row solution = normal.ldlt().solve(right);
    for_each(
        [&](int v, int u)
        {
          const double value = solution.dot(row_at(v, u));
          squares += std::pow(value - image.at<cv::Vec3b>(v, u)[c], 2);
          lit.at<cv::Vec3b>(v, u)[c] = cv::saturate_cast<std::uint8_t>(value);
        });
  }
  if (fitted != nullptr)
    *fitted = lit;
  return 10 * std::log10(255. * 255. * 3 * count / std::max(squares, 1e-9));
}

}  // namespace object_modelling::benchmark_texture
