#include "support/ray_casting.h"

#include <cmath>
#include <limits>

namespace object_modelling::test_support
{
namespace
{
bool nearer(float depth, const Hit& hit)
{
  return depth > 0 && (hit.depth_m == 0 || depth < hit.depth_m);
}

/// Smaller root of a t^2 + 2 b t + c = 0, the entry into a quadric; 0 if there is none.
float entry(float a, float b, float c)
{
  const float discriminant = b * b - a * c;
  return discriminant > 0 && a > 0 ? (-b - std::sqrt(discriminant)) / a : 0.0f;
}

}  // namespace

SceneView::SceneView(const SyntheticScene& scene, const Eigen::Isometry3d& T_world_camera)
    : has_table_(scene.has_table),
      table_half_size_(static_cast<float>(scene.table_half_size_m)),
      R_world_camera_(T_world_camera.linear().cast<float>()),
      t_world_camera_(T_world_camera.translation().cast<float>())
{
  for (const SceneObject& object : scene.objects)
  {
    const Eigen::Isometry3d T_object_camera = object.T_world_object.inverse(Eigen::Isometry) * T_world_camera;
    Body body;
    body.shape = object.shape;
    body.half_size = (0.5 * object.size_m).cast<float>();
    body.R_object_camera = T_object_camera.linear().cast<float>();
    body.t_object_camera = T_object_camera.translation().cast<float>();
    body.instance = static_cast<int>(bodies_.size()) + 1;
    body.center_camera = T_object_camera.inverse(Eigen::Isometry).translation().cast<float>();
    body.radius_squared = body.half_size.squaredNorm();
    bodies_.push_back(body);
  }
}

void SceneView::castTable(const Eigen::Vector3f& ray_camera, Hit* hit) const
{
  const Eigen::Vector3f ray = R_world_camera_ * ray_camera;
  const float depth = -t_world_camera_.z() / ray.z();
  const float a = t_world_camera_.x() + depth * ray.x();
  const float b = t_world_camera_.y() + depth * ray.y();
  if (!nearer(depth, *hit) || t_world_camera_.z() < 0 || std::abs(a) > table_half_size_ ||
      std::abs(b) > table_half_size_)
    return;
  *hit = { depth, 0, 0, a, b, R_world_camera_.row(2).transpose() };
}

void SceneView::castBox(const Body& body, const Eigen::Vector3f& ray, Hit* hit)
{
  const Eigen::Vector3f& eye = body.t_object_camera;
  float enter = -std::numeric_limits<float>::infinity();
  float leave = std::numeric_limits<float>::infinity();
  int axis = 0;
  for (int i = 0; i < 3; ++i)
  {
    const float towards = ray[i] > 0 ? 1.0f : -1.0f;
    const float first = (-towards * body.half_size[i] - eye[i]) / ray[i];
    const float last = (towards * body.half_size[i] - eye[i]) / ray[i];
    if (first > enter)
    {
      enter = first;
      axis = i;
    }
    leave = std::min(leave, last);
  }
  if (enter > leave || !nearer(enter, *hit))
    return;
  const Eigen::Vector3f p = eye + enter * ray;
  const float side = ray[axis] > 0 ? -1.0f : 1.0f;
  *hit = { enter,
           body.instance,
           2 * axis + (side > 0 ? 1 : 0),
           p[(axis + 1) % 3],
           p[(axis + 2) % 3],
           side * body.R_object_camera.row(axis).transpose() };
}

void SceneView::castCylinder(const Body& body, const Eigen::Vector3f& ray, Hit* hit)
{
  const Eigen::Vector3f& eye = body.t_object_camera;
  const float radius = body.half_size.x();
  const float half_height = body.half_size.z();
  const float wall = entry(ray.head<2>().squaredNorm(), ray.head<2>().dot(eye.head<2>()),
                           eye.head<2>().squaredNorm() - radius * radius);
  const Eigen::Vector3f p_wall = eye + wall * ray;
  if (nearer(wall, *hit) && std::abs(p_wall.z()) <= half_height)
  {
    const Eigen::Vector3f normal = Eigen::Vector3f(p_wall.x(), p_wall.y(), 0).normalized();
    *hit = { wall,       body.instance,
             0,          radius * std::atan2(p_wall.y(), p_wall.x()),
             p_wall.z(), body.R_object_camera.transpose() * normal };
  }
  const float side = ray.z() > 0 ? -1.0f : 1.0f;
  const float cap = (side * half_height - eye.z()) / ray.z();
  const Eigen::Vector3f p_cap = eye + cap * ray;
  if (nearer(cap, *hit) && p_cap.head<2>().squaredNorm() <= radius * radius)
    *hit = {
      cap, body.instance, side > 0 ? 2 : 1, p_cap.x(), p_cap.y(), side * body.R_object_camera.row(2).transpose()
    };
}

void SceneView::castSphere(const Body& body, const Eigen::Vector3f& ray, Hit* hit)
{
  const Eigen::Vector3f& eye = body.t_object_camera;
  const float radius = body.half_size.x();
  const float depth = entry(ray.squaredNorm(), ray.dot(eye), eye.squaredNorm() - radius * radius);
  if (!nearer(depth, *hit))
    return;
  const Eigen::Vector3f p = eye + depth * ray;
  // The texture is laid on like that of a cube round the sphere: no poles.
  int axis = 0;
  p.cwiseAbs().maxCoeff(&axis);
  const float stretch = radius / std::abs(p[axis]);
  *hit = { depth,
           body.instance,
           2 * axis + (p[axis] > 0 ? 1 : 0),
           stretch * p[(axis + 1) % 3],
           stretch * p[(axis + 2) % 3],
           body.R_object_camera.transpose() * p.normalized() };
}

Hit SceneView::cast(const Eigen::Vector3f& ray_camera) const
{
  Hit hit;
  if (has_table_)
    castTable(ray_camera, &hit);
  for (const Body& body : bodies_)
  {
    // Squared distance of the body's centre from the ray.
    const float along = ray_camera.dot(body.center_camera);
    if (body.center_camera.squaredNorm() - along * along / ray_camera.squaredNorm() > body.radius_squared)
      continue;
    const Eigen::Vector3f ray_object = body.R_object_camera * ray_camera;
    if (body.shape == Shape::BOX)
      castBox(body, ray_object, &hit);
    else if (body.shape == Shape::CYLINDER)
      castCylinder(body, ray_object, &hit);
    else
      castSphere(body, ray_object, &hit);
  }
  return hit;
}

}  // namespace object_modelling::test_support
