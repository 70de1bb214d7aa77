#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/geometry/oriented_box.h"
#include "object_modelling/mesh/textured_mesh.h"
#include "object_modelling/mesh/triangle_mesh.h"
#include "object_modelling/object_properties/object_properties.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::database
{
struct ModelSession
{
  std::string id;
  Eigen::Isometry3d T_model_session = Eigen::Isometry3d::Identity();  ///< the model frame is the object frame
  int keyframe_count = 0;
  /// Of its views, in what was read from a database; the last is before the first where that is not known.
  double first_stamp_s = 0, last_stamp_s = -1;
};

/// A session of the object that its model does without, since it could not be placed beside the others.
struct LeftOutSession
{
  std::string id;
  std::string reason;  ///< for people
};

/// One object as the database holds it. Object frame: origin at the centre of the oriented bounding box, z up in the
/// first resting pose. Metres.
struct ObjectModel
{
  std::string id;
  std::string name;                  ///< for people; the id where none was given
  std::vector<std::string> aliases;  ///< ids of objects that were found to be this one
  /// Counts the changes of the object frame: what was annotated in another version does not hold.
  int frame_version = 1;
  std::vector<ModelSession> sessions;
  std::vector<LeftOutSession> sessions_left_out;  ///< the model is partial where there are any
  geometry::OrientedBox box_model;
  double diameter_m = 0;                           ///< largest distance between two surface points
  std::vector<Eigen::Isometry3d> T_support_model;  ///< resting poses: z up, support at z = 0
  std::map<std::string, double> quality;           ///< figures by name, units in the names
  std::map<std::string, std::string> provenance;   ///< recording, software version, options
  fusion::FusedCloud cloud;                        ///< in the object frame
  mesh::TriangleMesh mesh;
  std::vector<float> mesh_sigmas_m;  ///< per vertex of the mesh: of the fused points near it; may be empty
  std::optional<object_properties::ObjectProperties> properties;  ///< of the mesh
  mesh::TexturedMesh textured;                                    ///< the same mesh with its texture; may be empty
  cv::Mat preview_bgr;                                            ///< CV_8UC3, written as preview.png; may be empty
  cv::Mat turntable_bgr;                                          ///< CV_8UC3, written as turntable.png; may be empty
  std::string quality_yaml;                                       ///< written as quality.yaml; may be empty
  std::vector<rgbd::View> views;                                  ///< their world is the object frame
};

}  // namespace object_modelling::database
