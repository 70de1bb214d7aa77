#include "keyframe_codec.h"

#include <cmath>
#include <future>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "number_text.h"
#include "object_modelling/base/status.h"
#include "object_modelling/rgbd/corrected.h"
#include "object_modelling/rgbd/depth_units.h"

namespace object_modelling::keyframes
{
namespace
{
using base::Error;
using base::StatusCode;

// 16 bits of 0.1 mm reach 6.5 m, finer than any sensor of this kind; farther scenes keep their range instead.
constexpr double FINE_DEPTH_UNIT_M = 1e-4;
constexpr double COARSE_DEPTH_UNIT_M = 1e-3;
constexpr float MAX_FINE_DEPTH_M = 6.5f;

[[noreturn]] void refuse(int id, const std::string& reason)
{
  throw Error(StatusCode::INVALID_ARGUMENT, "keyframe " + std::to_string(id) + " cannot be stored: " + reason);
}

std::string sizeText(const cv::Mat& image)
{
  return std::to_string(image.cols) + " x " + std::to_string(image.rows);
}

void check(const rgbd::Keyframe& keyframe)
{
  const rgbd::Frame& frame = keyframe.frame;
  const geometry::PinholeCamera& camera = frame.camera;
  if (keyframe.id < 0)
    refuse(keyframe.id, "ids count from 0");
  if (!std::isfinite(frame.stamp_s))
    refuse(keyframe.id, "its stamp is not a finite time");
  if (!keyframe.T_session_camera.matrix().allFinite())
    refuse(keyframe.id, "its pose holds numbers that are not finite");
  const std::vector<std::string> violations = camera.violations();
  if (!violations.empty())
    refuse(keyframe.id, "camera intrinsics: " + violations.front());
  if (frame.color_bgr.type() != CV_8UC3 || frame.depth_m.type() != CV_32FC1)
    refuse(keyframe.id, "colour must be CV_8UC3 and depth CV_32FC1");
  const cv::Size size(camera.width, camera.height);
  if (frame.color_bgr.size() != size || frame.depth_m.size() != size)
    refuse(keyframe.id, "colour is " + sizeText(frame.color_bgr) + " px and depth " + sizeText(frame.depth_m) +
                            " px, the camera " + std::to_string(size.width) + " x " + std::to_string(size.height));
}

std::string encodePng(const cv::Mat& image)
{
  // Run-length strategy at level 1: as small as deflate's level 3 on camera images, in half the time.
  static const std::vector<int> PARAMETERS = { cv::IMWRITE_PNG_COMPRESSION, 1, cv::IMWRITE_PNG_STRATEGY,
                                               cv::IMWRITE_PNG_STRATEGY_RLE };
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes, PARAMETERS))
    throw Error(StatusCode::INTERNAL, "PNG encoder failed on an image of " + sizeText(image) + " px");
  return { bytes.begin(), bytes.end() };
}

cv::Mat decodePng(const std::string& bytes, int type, const cv::Size& size, const std::string& what)
{
  cv::Mat image;
  try
  {
    const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
    image = bytes.empty() ? cv::Mat() : cv::imdecode(buffer, cv::IMREAD_UNCHANGED);
  }
  catch (const cv::Exception&)
  {
    image.release();
  }
  if (image.type() != type || image.size() != size)
    throw Error(StatusCode::BAD_INPUT, what +
                                           " is damaged: not the PNG image that was stored; delete the keyframe's "
                                           "session or import it again from an export");
  return image;
}

double depthUnit_m(const cv::Mat& depth_m)
{
  for (int v = 0; v < depth_m.rows; ++v)
  {
    const float* row = depth_m.ptr<float>(v);
    for (int u = 0; u < depth_m.cols; ++u)
      if (row[u] > MAX_FINE_DEPTH_M && std::isfinite(row[u]))
        return COARSE_DEPTH_UNIT_M;
  }
  return FINE_DEPTH_UNIT_M;
}
}  // namespace

std::string encodeMask(const cv::Mat& mask, int width, int height, const std::string& what)
{
  if (mask.empty())
    return "";
  if (mask.type() != CV_8UC1 || mask.size() != cv::Size(width, height))
    throw Error(StatusCode::INVALID_ARGUMENT, what + " must be CV_8UC1 of " + std::to_string(width) + " x " +
                                                  std::to_string(height) + " px, not " + sizeText(mask) + " px");
  return encodePng(mask);
}

EncodedKeyframe encodeKeyframe(const rgbd::Keyframe& keyframe)
{
  check(keyframe);
  const rgbd::Frame& frame = keyframe.frame;
  EncodedKeyframe row;
  row.id = keyframe.id;
  row.stamp_s = frame.stamp_s;
  row.camera = frame.camera;
  row.session_from_camera = textFromTransform(keyframe.T_session_camera);
  row.covariance = textFromCovariance(keyframe.covariance);
  row.depth_unit_m = depthUnit_m(frame.depth_m);
  std::future<std::string> depth_png = std::async(std::launch::async, [&frame, unit_m = row.depth_unit_m]
                                                  { return encodePng(rgbd::depthAs16Bit(frame.depth_m, unit_m)); });
  row.color_png = encodePng(frame.color_bgr);
  row.mask_png = encodeMask(frame.object_mask, frame.camera.width, frame.camera.height);
  row.moving_mask_png = encodeMask(frame.moving_mask, frame.camera.width, frame.camera.height, "moving mask");
  row.observations = encodeObservations(keyframe.observations);
  row.depth_png = depth_png.get();
  return row;
}

rgbd::Keyframe decodeKeyframe(const EncodedKeyframe& row, const std::string& what)
{
  const cv::Size size(row.camera.width, row.camera.height);
  rgbd::Keyframe keyframe;
  keyframe.id = row.id;
  keyframe.T_session_camera = transformFromText(row.session_from_camera, "session_from_camera of " + what);
  keyframe.covariance = covarianceFromText(row.covariance, "covariance of " + what);
  keyframe.observations = decodeObservations(row.observations, what);
  rgbd::Frame& frame = keyframe.frame;
  frame.stamp_s = row.stamp_s;
  frame.camera = row.camera;
  frame.color_bgr = decodePng(row.color_png, CV_8UC3, size, "colour image of " + what);
  cv::cvtColor(frame.color_bgr, frame.gray, cv::COLOR_BGR2GRAY);
  frame.depth_m =
      rgbd::depthInMeters(decodePng(row.depth_png, CV_16UC1, size, "depth image of " + what), row.depth_unit_m);
  if (!row.mask_png.empty())
    frame.object_mask = decodePng(row.mask_png, CV_8UC1, size, "mask of " + what);
  if (!row.moving_mask_png.empty())
    frame.moving_mask = decodePng(row.moving_mask_png, CV_8UC1, size, "moving mask of " + what);
  return keyframe;
}

rgbd::Keyframe decoded(const EncodedKeyframe& encoded, const std::string& session_id)
{
  rgbd::Keyframe keyframe =
      decodeKeyframe(encoded, "keyframe " + std::to_string(encoded.id) + " of session '" + session_id + "'");
  keyframe.frame.noise_model = encoded.calibration.noise_model;
  return encoded.calibration.correction.isIdentity() ? keyframe
                                                     : rgbd::corrected(keyframe, encoded.calibration.correction);
}

}  // namespace object_modelling::keyframes
