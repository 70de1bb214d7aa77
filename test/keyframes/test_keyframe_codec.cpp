#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>

#include "../../src/keyframes/keyframe_codec.h"
#include "../../src/keyframes/number_text.h"
#include "store_fixtures.h"

namespace object_modelling::keyframes
{
using base::StatusCode;

TEST(KeyframeCodec, GivesBackEverythingAndDepthWithinHalfAUnit)
{
  const rgbd::Keyframe keyframe = makeKeyframe(3);
  const EncodedKeyframe row = encodeKeyframe(keyframe);
  EXPECT_EQ(row.depth_unit_m, 1e-4);
  const rgbd::Keyframe decoded = decodeKeyframe(row, "keyframe 3");
  expectSame(decoded, keyframe);
  EXPECT_LE(depthDifference_m(decoded.frame.depth_m, keyframe.frame.depth_m), 0.5e-4 + 1e-6);
}

TEST(KeyframeCodec, TakesTheCoarserUnitForFarDepth)
{
  rgbd::Keyframe keyframe = makeKeyframe(0);
  keyframe.frame.depth_m.at<float>(5, 5) = 6.5f;
  EXPECT_EQ(encodeKeyframe(keyframe).depth_unit_m, 1e-4);
  keyframe.frame.depth_m.at<float>(5, 5) = 6.6f;
  keyframe.frame.depth_m.at<float>(6, 6) = 65.4f;
  const EncodedKeyframe row = encodeKeyframe(keyframe);
  EXPECT_EQ(row.depth_unit_m, 1e-3);
  EXPECT_LE(depthDifference_m(decodeKeyframe(row, "").frame.depth_m, keyframe.frame.depth_m), 0.5e-3 + 1e-5);
}

TEST(KeyframeCodec, KeepsMissingDepthMissing)
{
  rgbd::Keyframe keyframe = makeKeyframe(0);
  keyframe.frame.depth_m.setTo(std::numeric_limits<float>::quiet_NaN());
  const rgbd::Keyframe decoded = decodeKeyframe(encodeKeyframe(keyframe), "");
  EXPECT_EQ(depthDifference_m(decoded.frame.depth_m, keyframe.frame.depth_m), 0);
}

TEST(KeyframeCodec, WorksWithoutMasksAndObservations)
{
  rgbd::Keyframe keyframe = makeKeyframe(1);
  keyframe.frame.object_mask.release();
  keyframe.frame.moving_mask.release();
  keyframe.observations.clear();
  const EncodedKeyframe row = encodeKeyframe(keyframe);
  EXPECT_TRUE(row.mask_png.empty() && row.moving_mask_png.empty());
  EXPECT_EQ(row.observations.size(), 4u);
  expectSame(decodeKeyframe(row, ""), keyframe);
}

TEST(KeyframeCodec, SameKeyframeSameBytes)
{
  const EncodedKeyframe a = encodeKeyframe(makeKeyframe(2)), b = encodeKeyframe(makeKeyframe(2));
  EXPECT_EQ(a.color_png, b.color_png);
  EXPECT_EQ(a.depth_png, b.depth_png);
  EXPECT_EQ(a.session_from_camera, b.session_from_camera);
}

TEST(KeyframeCodec, RefusesWhatCannotBeStored)
{
  const auto refused = [](const std::function<void(rgbd::Keyframe*)>& spoil)
  {
    rgbd::Keyframe keyframe = makeKeyframe(0);
    spoil(&keyframe);
    return statusOf([&] { encodeKeyframe(keyframe); }).code == StatusCode::INVALID_ARGUMENT;
  };
  EXPECT_TRUE(refused([](rgbd::Keyframe* k) { k->id = -1; }));
  EXPECT_TRUE(refused([](rgbd::Keyframe* k) { k->frame.color_bgr.release(); }));
  EXPECT_TRUE(refused([](rgbd::Keyframe* k) { k->frame.color_bgr = k->frame.gray; }));
  EXPECT_TRUE(refused([](rgbd::Keyframe* k) { k->frame.depth_m = k->frame.depth_m.rowRange(0, 10); }));
  EXPECT_TRUE(refused([](rgbd::Keyframe* k) { k->frame.depth_m = cv::Mat::ones(48, 64, CV_16UC1); }));
  EXPECT_TRUE(refused([](rgbd::Keyframe* k) { k->frame.object_mask = cv::Mat::ones(4, 6, CV_8UC1); }));
  EXPECT_TRUE(refused([](rgbd::Keyframe* k) { k->frame.moving_mask = cv::Mat::ones(4, 6, CV_8UC1); }));
  EXPECT_TRUE(refused([](rgbd::Keyframe* k) { k->frame.camera.width = 63; }));
  EXPECT_TRUE(refused([](rgbd::Keyframe* k) { k->frame.camera.fx = 0; }));
  EXPECT_TRUE(refused([](rgbd::Keyframe* k) { k->frame.stamp_s = std::nan(""); }));
  EXPECT_TRUE(refused([](rgbd::Keyframe* k) { k->T_session_camera.translation().x() = std::nan(""); }));
}

TEST(KeyframeCodec, NamesDamagedParts)
{
  const auto damaged = [](const std::function<void(EncodedKeyframe*)>& spoil, const std::string& part)
  {
    EncodedKeyframe row = encodeKeyframe(makeKeyframe(0));
    spoil(&row);
    const base::Status status = statusOf([&] { decodeKeyframe(row, "keyframe 0 of session 'a'"); });
    EXPECT_EQ(status.code, StatusCode::BAD_INPUT) << part;
    EXPECT_NE(status.message.find(part), std::string::npos) << status.message;
    EXPECT_NE(status.message.find("keyframe 0 of session 'a'"), std::string::npos) << status.message;
  };
  damaged([](EncodedKeyframe* r) { r->color_png = "not a picture"; }, "colour image");
  damaged([](EncodedKeyframe* r) { r->color_png.clear(); }, "colour image");
  damaged([](EncodedKeyframe* r) { r->depth_png = r->mask_png; }, "depth image");
  damaged([](EncodedKeyframe* r) { r->mask_png = r->color_png; }, "mask");
  damaged([](EncodedKeyframe* r) { r->moving_mask_png = r->color_png; }, "moving mask");
  damaged([](EncodedKeyframe* r) { r->observations.pop_back(); }, "observations");
  damaged([](EncodedKeyframe* r) { r->observations = "\xff\xff\xff\xff"; }, "observations");
  damaged([](EncodedKeyframe* r) { r->observations.clear(); }, "observations");
  damaged([](EncodedKeyframe* r) { r->session_from_camera += " 1"; }, "session_from_camera");
  damaged([](EncodedKeyframe* r) { r->covariance.replace(0, 1, "x"); }, "covariance");
}

TEST(ObservationCodec, HasTheDocumentedLayout)
{
  const std::string bytes = encodeObservations({ { 0x0102030405060708u, { 1.0f, -2.0f }, 0.5f } });
  const std::string expected(
      "\x01\0\0\0"
      "\x08\x07\x06\x05\x04\x03\x02\x01"
      "\0\0\x80\x3f"
      "\0\0\0\xc0"
      "\0\0\0\x3f",
      24);
  EXPECT_EQ(bytes, expected);
}

TEST(NumberText, IsExactInEveryLocale)
{
  const double values[] = {
    1.0 / 3, -1e-300, 1e300, 0, 5e-324, std::nan(""), -std::numeric_limits<double>::infinity()
  };
  const std::string before = std::setlocale(LC_ALL, nullptr);
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  const std::string text = textFromNumbers(values, 7);
  const std::vector<double> read = numbersFromText(text, 7, "values");
  std::setlocale(LC_ALL, before.c_str());
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(read[i], values[i]) << text;
  EXPECT_TRUE(std::isnan(read[5]));
  EXPECT_EQ(read[6], values[6]);
}

}  // namespace object_modelling::keyframes
