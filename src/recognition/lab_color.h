#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

namespace object_modelling::recognition
{
/// CV_8UC3 (BGR) to CV_32FC3: CIE L*a*b*, L in [0, 100].
inline cv::Mat labOf(const cv::Mat& bgr)
{
  cv::Mat scaled, lab;
  bgr.convertTo(scaled, CV_32F, 1.0 / 255);
  cv::cvtColor(scaled, lab, cv::COLOR_BGR2Lab);
  return lab;
}

inline std::vector<Eigen::Vector3f> labOf(const std::vector<Eigen::Matrix<std::uint8_t, 3, 1>>& rgb)
{
  std::vector<Eigen::Vector3f> result;
  if (rgb.empty())
    return result;
  cv::Mat bgr(1, static_cast<int>(rgb.size()), CV_8UC3);
  for (int i = 0; i < bgr.cols; ++i)
    bgr.at<cv::Vec3b>(i) = { rgb[i].z(), rgb[i].y(), rgb[i].x() };
  const cv::Mat lab = labOf(bgr);
  for (int i = 0; i < lab.cols; ++i)
    result.emplace_back(lab.at<cv::Vec3f>(i)[0], lab.at<cv::Vec3f>(i)[1], lab.at<cv::Vec3f>(i)[2]);
  return result;
}

}  // namespace object_modelling::recognition
