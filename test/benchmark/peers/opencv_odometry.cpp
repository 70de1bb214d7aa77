// The RGB-D odometry of OpenCV contrib on a recording, as its user would run it: every frame against the last keyframe,
// whose pyramids and normals are kept. Writes the trajectory and prints the times as JSON; see README.md.
//   opencv_odometry RECORDING --out TRAJECTORY [--method rgbd|icp|rgbd_icp]
#include <algorithm>
#include <chrono>
#include <ctime>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/rgbd.hpp>

#include "object_modelling/geometry/transform.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/source/trajectory_file.h"
#include "object_modelling/source/tum_folder.h"

namespace
{
using namespace object_modelling;
using cv::rgbd::Odometry;
using cv::rgbd::OdometryFrame;

struct Arguments
{
  std::string recording, out, method = "rgbd", start = "velocity";
  int every = 1, skip = 0;
  double keyframe_m = 0.05, keyframe_deg = 5;
};

constexpr double RAD_PER_DEG = 0.017453292519943295;
constexpr double MAX_STEP_M = 0.5, MAX_STEP_RAD = 30 * RAD_PER_DEG;  ///< between two frames: more is a failure
constexpr int MAX_FAILURES = 30;  ///< in a row: then the present frame is the new keyframe, where the last pose was

bool within(const Eigen::Isometry3d& T, double meters, double radians)
{
  return T.translation().norm() <= meters && geometry::rotationAngle_rad(T) <= radians;
}

cv::Ptr<Odometry> createOdometry(const std::string& method, const geometry::PinholeCamera& camera)
{
  const cv::Mat K = (cv::Mat_<float>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  if (method == "icp")
    return cv::rgbd::ICPOdometry::create(K);
  if (method == "rgbd_icp")
    return cv::rgbd::RgbdICPOdometry::create(K);
  return cv::rgbd::RgbdOdometry::create(K);
}

/// Chains the odometry's relative poses. On failure the last pose is kept.
class Chain
{
public:
  explicit Chain(const Arguments& arguments) : arguments_(arguments) {}

  /// Returns whether the frame was placed.
  bool add(const rgbd::Frame& frame)
  {
    if (!odometry_)
      odometry_ = createOdometry(arguments_.method, frame.camera);
    cv::Ptr<OdometryFrame> current = OdometryFrame::create(frame.gray, frame.depth_m);
    if (!keyframe_)
    {
      setKeyframe(current);
      return true;
    }
    const Eigen::Isometry3d guess =
        arguments_.start == "velocity" ? T_keyframe_camera_ * last_step_ : T_keyframe_camera_;
    cv::Mat initial, found;
    cv::eigen2cv(Eigen::Matrix4d(guess.matrix()), initial);
    bool placed = false;
    try
    {
      placed = odometry_->compute(current, keyframe_, found, initial);
    }
    catch (const cv::Exception&)  // a frame without depth or texture
    {
    }
    Eigen::Isometry3d T_keyframe_camera = Eigen::Isometry3d::Identity();
    if (placed)
    {
      Eigen::Matrix4d matrix;
      cv::cv2eigen(found, matrix);
      T_keyframe_camera = geometry::normalized(Eigen::Isometry3d(matrix));
      const Eigen::Isometry3d step = T_keyframe_camera_.inverse() * T_keyframe_camera;
      placed = within(step, MAX_STEP_M, MAX_STEP_RAD);
      last_step_ = placed ? step : Eigen::Isometry3d::Identity();
    }
    failures_ = placed ? 0 : failures_ + 1;
    if (placed)
      T_keyframe_camera_ = T_keyframe_camera;
    const double keyframe_rad = arguments_.keyframe_deg * RAD_PER_DEG;
    if (failures_ >= MAX_FAILURES || (placed && !within(T_keyframe_camera_, arguments_.keyframe_m, keyframe_rad)))
      setKeyframe(current);
    return placed;
  }

  Eigen::Isometry3d T_map_camera() const { return T_map_keyframe_ * T_keyframe_camera_; }

private:
  void setKeyframe(const cv::Ptr<OdometryFrame>& frame)
  {
    T_map_keyframe_ = T_map_camera();
    T_keyframe_camera_.setIdentity();
    keyframe_ = frame;
    failures_ = 0;
  }

  Arguments arguments_;
  cv::Ptr<Odometry> odometry_;
  cv::Ptr<OdometryFrame> keyframe_;
  Eigen::Isometry3d T_map_keyframe_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_keyframe_camera_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d last_step_ = Eigen::Isometry3d::Identity();
  int failures_ = 0;
};

double cpu_ms()
{
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double wall_ms()
{
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

nlohmann::json statistics(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const auto at = [&values](double share)
  { return values.empty() ? 0 : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))]; };
  return { { "median", at(0.5) }, { "p95", at(0.95) }, { "max", at(1) } };
}

void run(const Arguments& arguments)
{
  const auto source = source::openTumFolder(arguments.recording);
  rgbd::FrameBuilder builder;
  Chain chain(arguments);
  std::vector<source::StampedPose> trajectory;
  std::vector<double> wall, cpu;
  int lost = 0;
  for (int index = 0; const auto raw = source->next(); ++index)
  {
    if (index < arguments.skip || (index - arguments.skip) % arguments.every != 0)
      continue;
    const base::Result<rgbd::Frame> frame = builder.build(*raw);
    if (frame.ok())
    {
      const double wall_start = wall_ms(), cpu_start = cpu_ms();
      lost += !chain.add(frame.value);
      wall.push_back(wall_ms() - wall_start);
      cpu.push_back(cpu_ms() - cpu_start);
    }
    else
      ++lost;
    trajectory.push_back({ raw->stamp_s, chain.T_map_camera() });
  }
  source::writeTrajectory(arguments.out, trajectory);
  std::cout << nlohmann::json{
    { "method", "opencv_" + arguments.method },
    { "frames", trajectory.size() },
    { "lost", lost },
    { "wall_ms", statistics(wall) },
    { "cpu_ms", statistics(cpu) }
  }.dump() << std::endl;
}
}  // namespace

int main(int argc, char** argv)
{
  CLI::App app("RGB-D odometry of OpenCV contrib on a TUM-style recording.");
  Arguments arguments;
  app.add_option("recording", arguments.recording, "TUM-style folder")->required();
  app.add_option("--out", arguments.out, "Trajectory to write, TUM format")->required();
  app.add_option("--method", arguments.method, "Which odometry")->check(CLI::IsMember({ "rgbd", "icp", "rgbd_icp" }));
  app.add_option("--every", arguments.every, "Only every Nth frame")->check(CLI::PositiveNumber);
  app.add_option("--skip", arguments.skip, "Leave out the first N frames")->check(CLI::NonNegativeNumber);
  app.add_option("--start", arguments.start, "Where the search starts: constant velocity, or the last pose")
      ->check(CLI::IsMember({ "velocity", "last" }));
  app.add_option("--keyframe-m", arguments.keyframe_m, "Motion to the next keyframe; 0: frame to frame");
  app.add_option("--keyframe-deg", arguments.keyframe_deg, "Rotation to the next keyframe");
  CLI11_PARSE(app, argc, argv);
  try
  {
    run(arguments);
  }
  catch (const base::Error& error)
  {
    std::cerr << "opencv_odometry: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}
