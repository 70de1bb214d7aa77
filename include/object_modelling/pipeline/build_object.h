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
  bool replace = false;     ///< allow another object frame for an object that exists with none of these sessions
  bool make_report = true;  ///< report.html, which takes a few seconds
  /// Sessions of the object that `placements` lacks, from leftOutOf(): with any, the object is marked as partial.
  std::vector<database::LeftOutSession> left_out;
  std::vector<std::string> violations() const;
};

using report::StageTime;

struct BuildReport
{
  base::Status status;  ///< OK with a message: the model is there, but partial, or without texture or report.html
  std::string object_folder;
  std::string preview_path;                          ///< PNG of four sides, inside the object's folder
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< along the object frame's x, y, z
  double diameter_m = 0;
  std::size_t point_count = 0, vertex_count = 0, triangle_count = 0;
  std::string properties;  ///< in one line: volume, symmetries, resting poses, what was not seen
  /// In their order: load, joint refinement (of several sessions), fuse, surface, texture, properties, describe, write,
  /// report.
  std::vector<StageTime> stages;
};

/// Fused cloud, mesh, texture, views and report of one object from its placed sessions, written into the database in
/// one atomic step; sets object_id and T_model_session of the sessions in the store (no T_model_session of those left
/// out). Refuses with the reason: no session, no keyframes, no masks, an existing object in another frame (unless
/// `replace`).
BuildReport buildObject(keyframes::SessionStore& store, database::ObjectDatabase& database,
                        const std::string& object_id, const std::string& name,
                        const std::vector<alignment::SessionPlacement>& placements, const BuildOptions& options,
                        base::JobControl& control);

}  // namespace object_modelling::pipeline
