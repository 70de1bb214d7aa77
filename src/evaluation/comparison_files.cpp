#include "object_modelling/evaluation/comparison_files.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <locale>
#include <sstream>

#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/status.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::evaluation
{
namespace
{
using base::Error;
using base::StatusCode;

constexpr double RIGID_TOLERANCE = 1e-3;  // transforms are typed or copied with few digits
}  // namespace

Eigen::Isometry3d readTransform(const std::string& path)
{
  std::istringstream in(base::readTextFile(path));
  in.imbue(std::locale::classic());
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      in >> matrix(row, column);
  std::string rest;
  if (!in || in >> rest)
    throw Error(StatusCode::BAD_INPUT, "'" + path + "' is no transform: 16 numbers, row by row, are");
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  const bool rigid = matrix.allFinite() && matrix.row(3) == Eigen::RowVector4d(0, 0, 0, 1) &&
                     (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < RIGID_TOLERANCE && R.determinant() > 0;
  if (!rigid)
    throw Error(StatusCode::BAD_INPUT, "'" + path +
                                           "' is no rigid transform: a rotation and a shift (m) are needed, "
                                           "and 0 0 0 1 below");
  return geometry::normalized(Eigen::Isometry3d(matrix));
}

void writeTransform(const std::string& path, const Eigen::Isometry3d& T_target_source)
{
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::setprecision(12);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      out << T_target_source(row, column) << (column < 3 ? " " : "\n");
  base::writeTextFile(path, out.str());
}

Histogram histogramOf(const std::vector<double>& distances_m, double bin_width_m, std::size_t bin_count)
{
  Histogram histogram{ bin_width_m, std::vector<std::size_t>(bin_count, 0) };
  for (const double distance_m : distances_m)
  {
    const double bin = std::min(distance_m / bin_width_m, static_cast<double>(bin_count - 1));
    ++histogram.counts[static_cast<std::size_t>(bin)];
  }
  return histogram;
}

void writeHistogram(const std::string& path, const Histogram& histogram, const DistanceStatistics& statistics)
{
  const cv::Mat image = drawHistogram(histogram, statistics);
  base::writeFileAtomically(path,
                            [&](const std::string& temporary)
                            {
                              bool written = false;
                              try
                              {
                                written = cv::imwrite(temporary, image);
                              }
                              catch (const cv::Exception&)
                              {
                                throw Error(StatusCode::INVALID_ARGUMENT,
                                            "'" + path + "': no image format has this extension; use .png");
                              }
                              if (!written)
                                throw Error(StatusCode::STORAGE, "writing '" + path + "' failed: is the disk full?");
                            });
}

void writeColoredCloud(const std::string& path, const Comparison& comparison, double red_from_m)
{
  const auto count = static_cast<int>(comparison.distances_m.size());
  cv::Mat levels(count, 1, CV_8UC1), colors_bgr;
  for (int i = 0; i < count; ++i)
    levels.at<std::uint8_t>(i) = cv::saturate_cast<std::uint8_t>(255 * comparison.distances_m[i] / red_from_m);
  cv::applyColorMap(levels, colors_bgr, cv::COLORMAP_JET);
  pcl::PointCloud<pcl::PointXYZRGB> cloud;
  cloud.resize(comparison.distances_m.size());
  for (int i = 0; i < count; ++i)
  {
    const auto& color = colors_bgr.at<cv::Vec3b>(i);
    cloud[i].getVector3fMap() = comparison.points_reference[i].cast<float>();
    cloud[i].b = color[0];
    cloud[i].g = color[1];
    cloud[i].r = color[2];
  }
  base::writeFileAtomically(path,
                            [&](const std::string& temporary)
                            {
                              if (pcl::PLYWriter().write(temporary, cloud, true, false) != 0)
                                throw Error(StatusCode::STORAGE, "writing '" + path + "' failed: is the disk full?");
                            });
}

}  // namespace object_modelling::evaluation
