#include <limits>

#include <Eigen/Core>

#include "object_modelling/features/described_points.h"

namespace object_modelling::features
{
namespace
{
/// The nearest two of a row or column of the distance matrix.
struct NearestTwo
{
  int index = -1;
  float first = std::numeric_limits<float>::infinity();
  float second = std::numeric_limits<float>::infinity();

  void add(int candidate, float distance)
  {
    if (distance < first)
    {
      second = first;
      first = distance;
      index = candidate;
    }
    else if (distance < second)
      second = distance;
  }
  bool distinct(double max_ratio) const { return first < max_ratio * second; }
};

/// CV_32FC1, squared for NORM_L2. One matrix product for those: twice as fast as difference by difference, and exact,
/// as SIFT's descriptors hold whole numbers below 256.
cv::Mat distanceMatrix(const cv::Mat& a, const cv::Mat& b, int norm)
{
  cv::Mat distances(a.rows, b.rows, CV_32F);
  if (norm != cv::NORM_L2)
  {
    cv::Mat counts;
    cv::batchDistance(a, b, counts, CV_32S, cv::noArray(), norm);
    counts.convertTo(distances, CV_32F);
    return distances;
  }
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Rows> A(a.ptr<float>(), a.rows, a.cols), B(b.ptr<float>(), b.rows, b.cols);
  Eigen::Map<Rows> D(distances.ptr<float>(), a.rows, b.rows);
  D.noalias() = -2 * A * B.transpose();
  D.colwise() += A.rowwise().squaredNorm();
  D.rowwise() += B.rowwise().squaredNorm().transpose();
  return distances;
}
}  // namespace

std::vector<DescriptorMatch> matchDescriptors(const cv::Mat& a, const cv::Mat& b, int norm, double max_ratio)
{
  std::vector<DescriptorMatch> result;
  if (a.rows < 2 || b.rows < 2)
    return result;
  const cv::Mat distances = distanceMatrix(a, b, norm);
  std::vector<NearestTwo> of_a(a.rows), of_b(b.rows);
  for (int i = 0; i < a.rows; ++i)
  {
    const float* row = distances.ptr<float>(i);
    for (int j = 0; j < b.rows; ++j)
    {
      of_a[i].add(j, row[j]);
      of_b[j].add(i, row[j]);
    }
  }
  const double ratio = norm == cv::NORM_L2 ? max_ratio * max_ratio : max_ratio;
  for (int i = 0; i < a.rows; ++i)
  {
    const int j = of_a[i].index;
    if (j >= 0 && of_b[j].index == i && of_a[i].distinct(ratio) && of_b[j].distinct(ratio))
      result.push_back({ i, j });
  }
  return result;
}

}  // namespace object_modelling::features
