#include "support/synthetic_scene.h"

#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "object_modelling/rgbd/keyframe_view.h"
#include "support/ray_casting.h"
#include "support/sensor_simulation.h"

namespace object_modelling::test_support
{
namespace
{
constexpr float NOTHING = std::numeric_limits<float>::quiet_NaN();

/// Lambertian light from one direction on top of an ambient share: the same from every viewpoint.
float shading(const Eigen::Vector3f& n_camera, const Eigen::Vector3f& to_light_camera)
{
  return 0.65f + 0.35f * std::max(0.0f, n_camera.dot(to_light_camera));
}

SceneObject standing(Shape shape, const Eigen::Vector3d& size_m, double x_m, double y_m, double yaw_rad,
                     std::uint32_t seed)
{
  SceneObject object;
  object.shape = shape;
  object.size_m = size_m;
  object.T_world_object.translation() = Eigen::Vector3d(x_m, y_m, 0.5 * size_m.z());
  object.T_world_object.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  object.texture.cell_m = 0.015f;
  object.texture.seed = seed;
  return object;
}

}  // namespace

double SceneObject::signedDistance_m(const Eigen::Vector3d& p_world) const
{
  const Eigen::Vector3d p = T_world_object.inverse(Eigen::Isometry) * p_world;
  if (shape == Shape::SPHERE)
    return p.norm() - 0.5 * size_m.x();
  const Eigen::VectorXd beyond =
      shape == Shape::BOX
          ? Eigen::VectorXd(p.cwiseAbs() - 0.5 * size_m)
          : Eigen::VectorXd(Eigen::Vector2d(p.head<2>().norm() - 0.5 * size_m.x(), std::abs(p.z()) - 0.5 * size_m.z()));
  return beyond.cwiseMax(0).norm() + std::min(0.0, beyond.maxCoeff());
}

SceneObject standingBox(const Eigen::Vector3d& size_m, double x_m, double y_m, double yaw_rad, std::uint32_t seed)
{
  return standing(Shape::BOX, size_m, x_m, y_m, yaw_rad, seed);
}

SceneObject standingCylinder(double diameter_m, double height_m, double x_m, double y_m, std::uint32_t seed)
{
  return standing(Shape::CYLINDER, { diameter_m, diameter_m, height_m }, x_m, y_m, 0, seed);
}

SceneObject standingSphere(double diameter_m, double x_m, double y_m, std::uint32_t seed)
{
  return standing(Shape::SPHERE, Eigen::Vector3d::Constant(diameter_m), x_m, y_m, 0, seed);
}

SyntheticScene boxOnTable()
{
  SyntheticScene scene;
  scene.objects.push_back(standingBox({ 0.08, 0.12, 0.2 }));
  return scene;
}

SceneImage renderScene(const SyntheticScene& scene, const geometry::PinholeCamera& camera,
                       const Eigen::Isometry3d& T_world_camera, const SensorNoise& noise, double stamp_s)
{
  const SceneView view(scene, T_world_camera);
  const Eigen::Vector3f to_light =
      T_world_camera.linear().cast<float>().transpose() * Eigen::Vector3f(0.4f, -0.5f, 0.8f).normalized();
  const cv::Size size(camera.width, camera.height);
  SceneImage image;
  image.depth_m = cv::Mat(size, CV_32FC1, cv::Scalar(NOTHING));
  image.normals = cv::Mat(size, CV_32FC3, cv::Scalar::all(NOTHING));
  image.instances = cv::Mat::zeros(size, CV_8UC1);
  cv::Mat color(size, CV_8UC3, cv::Scalar::all(90));
  for (int v = 0; v < size.height; ++v)
  {
    for (int u = 0; u < size.width; ++u)
    {
      const Eigen::Vector3f ray = camera.unproject(u, v, 1).cast<float>();
      const Hit hit = view.cast(ray);
      if (hit.depth_m <= 0)
        continue;
      const Texture& texture =
          hit.instance == 0 ? scene.table : scene.objects[static_cast<std::size_t>(hit.instance - 1)].texture;
      // What a pixel covers grows as the surface turns away; the geometric mean of both directions.
      const float cosine = std::max(0.05f, -hit.n_camera.dot(ray) / ray.norm());
      const float footprint = hit.depth_m / static_cast<float>(camera.fx) / std::sqrt(cosine);
      const Eigen::Vector3f bgr =
          shading(hit.n_camera, to_light) * textureColor(texture, hit.a_m, hit.b_m, hit.face, footprint);
      color.at<cv::Vec3b>(v, u) = { cv::saturate_cast<std::uint8_t>(bgr[0]), cv::saturate_cast<std::uint8_t>(bgr[1]),
                                    cv::saturate_cast<std::uint8_t>(bgr[2]) };
      image.depth_m.at<float>(v, u) = hit.depth_m;
      image.normals.at<cv::Vec3f>(v, u) = { hit.n_camera.x(), hit.n_camera.y(), hit.n_camera.z() };
      image.instances.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(hit.instance);
    }
  }
  image.frame.stamp_s = stamp_s;
  image.frame.camera = camera;
  image.frame.camera.distortion.clear();
  image.frame.color_bgr = color;
  image.frame.depth_m = image.depth_m.clone();
  cv::compare(image.instances, 1, image.frame.object_mask, cv::CMP_EQ);
  addSensorNoise(noise, &image);
  cv::cvtColor(image.frame.color_bgr, image.frame.gray, cv::COLOR_BGR2GRAY);
  return image;
}

rgbd::Frame renderFrame(const SyntheticScene& scene, const geometry::PinholeCamera& camera,
                        const Eigen::Isometry3d& T_world_camera, const SensorNoise& noise, double stamp_s)
{
  return renderScene(scene, camera, T_world_camera, noise, stamp_s).frame;
}

std::vector<rgbd::Keyframe> renderKeyframes(const SyntheticScene& scene, const geometry::PinholeCamera& camera,
                                            const std::vector<Eigen::Isometry3d>& T_world_cameras,
                                            const SensorNoise& noise)
{
  std::vector<rgbd::Keyframe> keyframes;
  for (const Eigen::Isometry3d& T_world_camera : T_world_cameras)
  {
    SensorNoise own_noise = noise;
    own_noise.seed = noise.seed + 1000 * keyframes.size();
    rgbd::Keyframe keyframe;
    keyframe.id = static_cast<int>(keyframes.size());
    keyframe.frame = renderFrame(scene, camera, T_world_camera, own_noise, static_cast<double>(keyframes.size()));
    keyframe.T_session_camera = T_world_camera;
    keyframes.push_back(keyframe);
  }
  return keyframes;
}

std::vector<rgbd::View> renderViews(const SyntheticScene& scene, const geometry::PinholeCamera& camera,
                                    const std::vector<Eigen::Isometry3d>& T_world_cameras, const SensorNoise& noise)
{
  return rgbd::viewsOf(renderKeyframes(scene, camera, T_world_cameras, noise));
}

geometry::PinholeCamera vgaCamera()
{
  geometry::PinholeCamera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 525;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

geometry::PinholeCamera smallCamera()
{
  geometry::PinholeCamera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 262.5;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

}  // namespace object_modelling::test_support
