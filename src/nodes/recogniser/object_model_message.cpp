#include "object_model_message.h"

#include <algorithm>

#include <sensor_msgs/point_cloud2_iterator.h>

#include "object_modelling/database/cloud_file.h"
#include "object_modelling/database/object_database.h"
#include "object_modelling/mesh/mesh_files.h"
#include "object_modelling/ros_bridge/pose_conversion.h"

namespace object_modelling::nodes
{
namespace
{
using object_properties::Symmetry;

constexpr int ATTEMPTS = 3;  // at an object that is replaced while it is read

geometry_msgs::Point32 toPoint32(const Eigen::Vector3f& vector)
{
  geometry_msgs::Point32 point;
  point.x = vector.x();
  point.y = vector.y();
  point.z = vector.z();
  return point;
}

object_modelling::TriangleMesh toMessage(const mesh::TriangleMesh& mesh)
{
  object_modelling::TriangleMesh message;
  std::transform(mesh.vertices.begin(), mesh.vertices.end(), std::back_inserter(message.vertices), toPoint32);
  std::transform(mesh.normals.begin(), mesh.normals.end(), std::back_inserter(message.normals), toPoint32);
  for (const auto& rgb : mesh.colors)
  {
    std_msgs::ColorRGBA color;
    color.r = rgb[0] / 255.0F;
    color.g = rgb[1] / 255.0F;
    color.b = rgb[2] / 255.0F;
    color.a = 1;
    message.colors.push_back(color);
  }
  message.seen = mesh.seen;
  for (const auto& triangle : mesh.triangles)
    message.triangles.insert(message.triangles.end(), triangle.begin(), triangle.end());
  return message;
}

/// As PCL reads it: its PointXYZRGBNormal.
sensor_msgs::PointCloud2 toMessage(const fusion::FusedCloud& cloud)
{
  sensor_msgs::PointCloud2 message;
  message.is_dense = true;
  sensor_msgs::PointCloud2Modifier modifier(message);
  constexpr int FLOAT = sensor_msgs::PointField::FLOAT32;
  modifier.setPointCloud2Fields(7, "x", 1, FLOAT, "y", 1, FLOAT, "z", 1, FLOAT, "rgb", 1, FLOAT, "normal_x", 1, FLOAT,
                                "normal_y", 1, FLOAT, "normal_z", 1, FLOAT);
  modifier.resize(cloud.size());
  if (cloud.size() == 0)
    return message;  // an iterator takes the address of the first byte
  sensor_msgs::PointCloud2Iterator<float> xyz(message, "x"), normal(message, "normal_x");
  sensor_msgs::PointCloud2Iterator<std::uint8_t> bgr(message, "rgb");  // little-endian 0x00rrggbb
  for (std::size_t i = 0; i < cloud.size(); ++i, ++xyz, ++normal, ++bgr)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      xyz[axis] = cloud.points[i][axis];
      normal[axis] = cloud.normals[i][axis];
      bgr[axis] = cloud.colors[i][2 - axis];
    }
  }
  return message;
}

object_modelling::RestingPose toMessage(const object_properties::RestingPose& pose)
{
  object_modelling::RestingPose message;
  message.support_from_model = ros_bridge::toPoseMessage(pose.T_support_model);
  message.probability = pose.probability;
  message.seen = pose.seen;
  return message;
}

object_modelling::Symmetry toMessage(const Symmetry& symmetry)
{
  object_modelling::Symmetry message;
  message.of =
      symmetry.of == Symmetry::Of::SHAPE ? object_modelling::Symmetry::SHAPE : object_modelling::Symmetry::TEXTURE;
  message.axis = ros_bridge::toVectorMessage(symmetry.axis);
  message.point.x = symmetry.point_m.x();
  message.point.y = symmetry.point_m.y();
  message.point.z = symmetry.point_m.z();
  message.order = symmetry.order;
  message.error_m = symmetry.error_m;
  return message;
}

geometry_msgs::Inertia toMessage(const object_properties::MassProperties& mass)
{
  geometry_msgs::Inertia message;
  message.m = mass.mass_kg;
  message.com = ros_bridge::toVectorMessage(mass.center_of_mass_m);
  const Eigen::Matrix3d inertia = mass.density_kg_m3 * mass.inertia_per_density_m5;
  message.ixx = inertia(0, 0);
  message.ixy = inertia(0, 1);
  message.ixz = inertia(0, 2);
  message.iyy = inertia(1, 1);
  message.iyz = inertia(1, 2);
  message.izz = inertia(2, 2);
  return message;
}

void fillProperties(const object_properties::ObjectProperties& properties, object_modelling::ObjectModel* message)
{
  message->has_properties = true;
  for (const object_properties::RestingPose& pose : properties.resting_poses)
    message->resting_poses.push_back(toMessage(pose));
  for (const Symmetry& symmetry : properties.symmetries)
    message->symmetries.push_back(toMessage(symmetry));
  message->inertia = toMessage(properties.mass);
  message->density_kg_m3 = properties.mass.density_kg_m3;
  message->volume_m3 = properties.mass.volume_m3;
  message->closed = properties.mass.closed;
  message->has_unseen = properties.unseen.has_value();
  if (!properties.unseen)
    return;
  message->unseen_ratio = properties.unseen->ratio;
  message->bottom_unseen = properties.unseen->bottom;
}

object_modelling::ObjectModel toMessage(const database::ObjectEntry& entry)
{
  object_modelling::ObjectModel message;
  message.object_id = entry.id;
  message.name = entry.name;
  message.content_hash = entry.content_hash;
  message.size_m = ros_bridge::toVectorMessage(entry.box_model.size_m);
  message.model_from_box = ros_bridge::toPoseMessage(entry.box_model.T_frame_box);
  message.diameter_m = entry.diameter_m;
  if (entry.properties)
  {
    fillProperties(*entry.properties, &message);
    return message;
  }
  for (const Eigen::Isometry3d& T_support_model : entry.T_support_model)
    message.resting_poses.push_back(toMessage(object_properties::RestingPose{ T_support_model, 0, true }));
  return message;
}

void checkKnown(const database::ObjectDatabase& database, const std::string& object_id)
{
  const std::map<std::string, std::string> hashes = database.contentHashes();
  if (hashes.count(object_id) > 0)
    return;
  std::string ids;
  for (const auto& [id, hash] : hashes)
    ids += (ids.empty() ? "" : ", ") + id;
  throw base::Error(base::StatusCode::NOT_FOUND, "object '" + object_id + "' is not in the database " +
                                                     database.root() + ": it has " + (ids.empty() ? "none" : ids));
}
}  // namespace

object_modelling::ObjectModel objectModelMessage(const std::string& root, const std::string& object_id)
{
  const database::ObjectDatabase database(root, false);
  for (int attempt = 0; attempt < ATTEMPTS; ++attempt)
  {
    checkKnown(database, object_id);
    const database::ObjectEntry entry = database.entry(object_id);
    object_modelling::ObjectModel message = toMessage(entry);
    message.mesh = toMessage(mesh::readMesh(entry.mesh_path));
    message.cloud = toMessage(database::readCloud(database.root() + "/" + object_id + "/cloud.pcd"));
    if (database.entry(object_id).content_hash == entry.content_hash)
      return message;
  }
  throw base::Error(base::StatusCode::FAILED_PRECONDITION,
                    "object '" + object_id + "' is being replaced again and again: try again");
}

}  // namespace object_modelling::nodes
