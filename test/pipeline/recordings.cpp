#include "recordings.h"

#include <map>
#include <sstream>

#include "object_modelling/geometry/transform.h"
#include "support/handheld_trajectory.h"

namespace object_modelling::pipeline
{
namespace
{
constexpr double START_S = 1000;
constexpr double RATE_HZ = 30;

test_support::SensorNoise sensorNoise(std::uint64_t seed)
{
  test_support::SensorNoise noise;
  noise.depth_sigma_scale = 0.5;
  noise.depth_quantum_m = 0.001;
  noise.missing_edge_px = 1;
  noise.color_sigma = 1;
  noise.seed = seed;
  return noise;
}

void print(const Eigen::MatrixXd& matrix, std::ostream* out)
{
  *out << matrix.format({ Eigen::FullPrecision, Eigen::DontAlignCols, " ", " " }) << '\n';
}
}  // namespace

const Recording& walkRoundBox(int frame_count, double turn_rad)
{
  static std::map<std::pair<int, double>, Recording> made;
  Recording& recording = made[{ frame_count, turn_rad }];
  if (!recording.frames.empty())
    return recording;
  const test_support::SyntheticScene scene = test_support::boxOnTable();
  test_support::HandheldOptions walk;
  walk.frame_count = frame_count;
  walk.turn_rad = turn_rad;
  walk.radius_m = 0.6;
  walk.start_s = START_S;
  walk.rate_hz = RATE_HZ;
  for (const test_support::StampedCamera& camera : test_support::handheldTrajectory(walk))
  {
    const test_support::SensorNoise noise = sensorNoise(1000 * recording.frames.size() + 1);
    recording.frames.push_back(
        test_support::renderFrame(scene, smallCamera(), camera.T_world_camera, noise, camera.stamp_s));
    recording.T_object_cameras.push_back(scene.objects[0].T_world_object.inverse() * camera.T_world_camera);
  }
  return recording;
}

namespace
{
/// The camera stands still, all objects of the scene turn about the world's vertical axis.
Recording turning(test_support::SyntheticScene scene, int frame_count, double turn_rad)
{
  Recording recording;
  const Eigen::Isometry3d T_world_camera = test_support::orbitPose({ 0, 0, 0.08 }, 0.6, 0.4, 0.6);
  const std::vector<test_support::SceneObject> start = scene.objects;
  for (int i = 0; i < frame_count; ++i)
  {
    for (std::size_t k = 0; k < start.size(); ++k)
      scene.objects[k].T_world_object =
          Eigen::AngleAxisd(turn_rad * i / frame_count, Eigen::Vector3d::UnitZ()) * start[k].T_world_object;
    recording.frames.push_back(test_support::renderFrame(scene, smallCamera(), T_world_camera,
                                                         sensorNoise(1000 * i + 1), START_S + i / RATE_HZ));
    recording.T_object_cameras.push_back(scene.objects[0].T_world_object.inverse() * T_world_camera);
  }
  return recording;
}
}  // namespace

Recording turningBox(int frame_count, double turn_rad)
{
  return turning(test_support::boxOnTable(), frame_count, turn_rad);
}

Recording turntable(int frame_count, double turn_rad)
{
  constexpr double HEIGHT_M = 0.025;
  test_support::SyntheticScene scene = test_support::boxOnTable();
  scene.objects[0].T_world_object.pretranslate(Eigen::Vector3d(0, 0, HEIGHT_M));
  scene.objects[0].texture = test_support::plainTexture();
  scene.objects.push_back(test_support::standingCylinder(0.36, HEIGHT_M));
  return turning(scene, frame_count, turn_rad);
}

std::optional<rgbd::RawFrame> MemorySource::next()
{
  if (next_ == recording_.frames.size())
    return std::nullopt;
  const rgbd::Frame& frame = recording_.frames[next_];
  rgbd::RawFrame raw;
  raw.stamp_s = raw.depth_stamp_s = frame.stamp_s;
  raw.color = frame.color_bgr;
  raw.depth = frame.depth_m;
  raw.camera = frame.camera;
  if (spoil_)
    spoil_(static_cast<int>(next_), &raw);
  ++next_;
  return raw;
}

void removeDepth(rgbd::RawFrame* raw)
{
  // A new image: assigning an expression would write into the one that the recording shares.
  raw->depth = cv::Mat(raw->depth.size(), raw->depth.type(), cv::Scalar::all(0));
}

keyframes::Session named(const std::string& session_id)
{
  keyframes::Session session;
  session.id = session_id;
  return session;
}

void storeRenderedSession(keyframes::SessionStore& store, const std::string& session_id, int view_count,
                          const test_support::SyntheticScene& scene)
{
  keyframes::Session session = named(session_id);
  session.camera_frame_id = "camera_optical";
  session.closed = true;
  session.support_plane_session = geometry::Plane{ Eigen::Vector3d::UnitZ(), 0 };
  store.createSession(session);
  const std::vector<Eigen::Isometry3d> poses = test_support::orbitPoses(view_count, { 0, 0, 0.08 }, 0.6);
  for (const rgbd::Keyframe& keyframe : test_support::renderKeyframes(scene, smallCamera(), poses, sensorNoise(1)))
    store.addKeyframe(session_id, keyframe);
}

TrajectoryError trajectoryError(const std::vector<source::StampedPose>& trajectory, const Recording& truth)
{
  TrajectoryError error;
  const auto indexOf = [](const source::StampedPose& pose)
  { return static_cast<std::size_t>(std::lround((pose.stamp_s - START_S) * RATE_HZ)); };
  for (const source::StampedPose& pose : trajectory)
  {
    const Eigen::Isometry3d T_first_camera = trajectory.front().T_map_camera.inverse() * pose.T_map_camera;
    const Eigen::Isometry3d T_first_camera_true =
        truth.T_object_cameras.at(indexOf(trajectory.front())).inverse() * truth.T_object_cameras.at(indexOf(pose));
    const Eigen::Isometry3d difference = T_first_camera_true.inverse() * T_first_camera;
    error.position_m = std::max(error.position_m, difference.translation().norm());
    error.angle_rad = std::max(error.angle_rad, geometry::rotationAngle_rad(difference));
  }
  return error;
}

std::string fingerprint(keyframes::SessionStore& store, const std::string& session_id)
{
  std::ostringstream text;
  const keyframes::Session session = store.session(session_id);
  text << session.object_id << ' ' << session.closed << session.reference_is_object << session.keyframe_count << '\n';
  if (session.support_plane_session)
  {
    print(session.support_plane_session->normal, &text);
    text << session.support_plane_session->offset_m << '\n';
  }
  if (session.T_model_session)
    print(session.T_model_session->matrix(), &text);
  for (const rgbd::Keyframe& keyframe : keyframes::loadKeyframes(store, session_id))
  {
    print(keyframe.T_session_camera.matrix(), &text);
    text << (keyframe.frame.object_mask.empty() ? -1 : cv::countNonZero(keyframe.frame.object_mask)) << '\n';
  }
  return text.str();
}

}  // namespace object_modelling::pipeline
