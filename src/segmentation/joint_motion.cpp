#include "joint_motion.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace object_modelling::segmentation
{
namespace
{
constexpr double THINNED_WIDTH_PX = 160;
constexpr int MIN_PIXELS = 60;
constexpr double MIN_TEXTURE = 6;  // standard deviation in grey levels; motion of plainer surfaces is not observable
constexpr double CHANGED_CORRELATION = 0.75;
constexpr double SAME_CORRELATION = 0.93;
constexpr double MOVED_OVERLAP_RATIO = 0.6;
constexpr int MIN_FRAMES_APART = 3;
constexpr int MAX_AGE_FRAMES = 60;  // light changes meanwhile

enum class Change
{
  UNKNOWN,
  SAME,
  CHANGED
};

Change changeWithin(const cv::Mat& a, const cv::Mat& b, const cv::Mat& mask)
{
  if (cv::countNonZero(mask) < MIN_PIXELS)
    return Change::UNKNOWN;
  cv::Scalar mean_a, mean_b, sigma_a, sigma_b;
  cv::meanStdDev(a, mean_a, sigma_a, mask);
  cv::meanStdDev(b, mean_b, sigma_b, mask);
  if (std::min(sigma_a[0], sigma_b[0]) < MIN_TEXTURE)
    return Change::UNKNOWN;
  cv::Mat product;
  cv::multiply(a, b, product, 1, CV_32F);
  const double correlation = (cv::mean(product, mask)[0] - mean_a[0] * mean_b[0]) / (sigma_a[0] * sigma_b[0]);
  return correlation < CHANGED_CORRELATION ? Change::CHANGED
         : correlation > SAME_CORRELATION  ? Change::SAME
                                           : Change::UNKNOWN;
}

cv::Mat thinned(const cv::Mat& image, int interpolation)
{
  const double scale = std::min(1.0, THINNED_WIDTH_PX / image.cols);
  cv::Mat thin;
  cv::resize(image, thin, {}, scale, scale, interpolation);
  return thin;
}
}  // namespace

bool JointMotion::together(const cv::Mat& gray, const cv::Mat& object, const cv::Mat& carrier)
{
  const cv::Mat thin = thinned(gray, cv::INTER_AREA);
  const cv::Mat thin_object = thinned(object, cv::INTER_NEAREST), thin_carrier = thinned(carrier, cv::INTER_NEAREST);
  bool renew = gray_.size() != thin.size() || ++age_ > MAX_AGE_FRAMES;
  if (gray_.size() == thin.size())
  {
    const cv::Mat both = thin_object & object_;
    const bool moved = cv::countNonZero(both) < MOVED_OVERLAP_RATIO * cv::countNonZero(thin_object | object_);
    const bool object_changed = moved || changeWithin(gray_, thin, both) == Change::CHANGED;
    const Change carrier_change = changeWithin(gray_, thin, thin_carrier & carrier_);
    apart_count_ = object_changed && carrier_change == Change::SAME ? apart_count_ + 1 : 0;
    if (apart_count_ >= MIN_FRAMES_APART)
      together_ = false;
    if (object_changed && carrier_change == Change::CHANGED)
    {
      together_ = true;
      renew = true;
    }
  }
  if (renew)
  {
    gray_ = thin;
    object_ = thin_object;
    carrier_ = thin_carrier;
    age_ = 0;
  }
  return together_;
}

}  // namespace object_modelling::segmentation
