#pragma once

#include <map>
#include <string>
#include <vector>

#include "object_modelling/alignment/session_alignment.h"
#include "object_modelling/base/job_control.h"
#include "object_modelling/database/object_database.h"
#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/keyframes/session_store.h"
#include "object_modelling/report/quality_report.h"
#include "object_modelling/surface/surface_reconstruction.h"
#include "object_modelling/texture/texturing.h"

namespace object_modelling::pipeline
{
struct BuildOptions
{
  fusion::CloudFusionOptions fusion;
  surface::SurfaceOptions surface;
  texture::TextureOptions texture;
  object_properties::PropertyOptions properties;
  /// Replace an object that exists with none of these sessions even where it is not certain how the new model lies to
  /// the stored one: its frame changes then.
  bool replace = false;
  bool find_similar = true;  ///< compare a new object with those of its size
  bool make_report = true;   ///< report.html, which takes a few seconds
  /// Sessions of the object that `placements` lacks, from leftOutOf(): with any, the object is marked as partial.
  std::vector<database::LeftOutSession> left_out;
  std::vector<std::string> violations() const;
};

using report::StageTime;

struct BuildReport
{
  /// OK with a message: the model is there, but partial, without texture or report.html, in a new frame, or it looks
  /// like another object.
  base::Status status;
  std::string object_folder;
  std::string preview_path;                          ///< PNG of four sides, inside the object's folder
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< along the object frame's x, y, z
  double diameter_m = 0;
  std::size_t point_count = 0, vertex_count = 0, triangle_count = 0;
  int frame_version = 1;
  report::FrameOrigin frame;
  std::vector<report::SimilarObject> looks_like;  ///< objects of the database, most probable first
  std::string properties;                         ///< in one line: volume, symmetries, resting poses, what was not seen
  /// In their order: load, joint refinement (of several sessions), fuse, surface, texture, compare (with the database;
  /// before surface where the object exists with other sessions), properties, describe, write, report.
  std::vector<StageTime> stages;
};

/// Fused cloud, mesh, texture, views and report of one object from its placed sessions, written into the database in
/// one atomic step; sets object_id and T_model_session of the sessions in the store (no T_model_session of those left
/// out). An object that exists keeps its frame: by a session that it has already, or else by aligning the new model
/// with the stored one. Refuses with the reason: no session, no keyframes, no masks, an existing object to which the
/// new model does not certainly lie in one way (unless `replace`).
BuildReport buildObject(keyframes::SessionStore& store, database::ObjectDatabase& database,
                        const std::string& object_id, const std::string& name,
                        const std::vector<alignment::SessionPlacement>& placements, const BuildOptions& options,
                        base::JobControl& control);

}  // namespace object_modelling::pipeline
