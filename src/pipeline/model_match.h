#pragma once

#include <string>
#include <vector>

#include "object_modelling/alignment/pair_alignment.h"
#include "object_modelling/database/object_database.h"
#include "object_modelling/registration/partial_model.h"
#include "object_modelling/report/quality_report.h"

// A new model against those that a database has, by the alignment of sessions: shape, texture and empty space.
namespace object_modelling::pipeline
{
/// A model as alignment takes it, in the frame of its cloud and views.
registration::PartialModel partOfModel(const std::string& id, const fusion::FusedCloud& cloud,
                                       const std::vector<rgbd::View>& views);
/// One of the database, in the object frame; of its views some, spread evenly. Throws base::Error (BAD_INPUT,
/// NOT_FOUND, FAILED_PRECONDITION).
registration::PartialModel partOfStored(const database::ObjectDatabase& database, const database::ObjectEntry& entry);

struct ModelMatch
{
  bool accepted = false;  ///< by the limits that hold for sessions, and the textures are alike
  double probability = 0;
  Eigen::Isometry3d T_stored_model = Eigen::Isometry3d::Identity();  ///< set where the probability is not 0
  std::string figures;  ///< "probability 0.41, 63 % of the surface in common, 8 % in space seen empty"
};

/// Whether a pose brings other prints together: sessions are known to be of one object, models are not, and the shape
/// alone would do.
bool texturesDiffer(const registration::PairQuality& quality);

ModelMatch matchModels(const registration::PartialModel& stored, const registration::PartialModel& model,
                       base::JobControl& control);

/// The new model of an object against the stored one. One that cannot be read fits nothing: its figures say why.
ModelMatch matchExisting(const database::ObjectDatabase& database, const database::ObjectEntry& existing,
                         const fusion::FusedCloud& cloud, const std::vector<rgbd::View>& views,
                         base::JobControl& control);

/// Why an object is not replaced, and what to do.
std::string frameWouldChange(const std::string& object_id, const ModelMatch& match);
/// That it was replaced nevertheless.
std::string frameHasChanged(const std::string& object_id, int frame_version, const ModelMatch& match);

struct SimilarObjects
{
  std::vector<report::SimilarObject> found;  ///< most probable first
  std::size_t compared_count = 0;
};

/// Objects of the database that a new one, with its size and views, is probably the same as. Only
/// the few that are nearest to it in size are compared, with progress. Those that cannot be read are passed over.
SimilarObjects similarObjects(const database::ObjectDatabase& database, const database::ObjectModel& model,
                              const fusion::FusedCloud& cloud_model, base::JobControl& control);

/// What they are and how to make one of both; empty without any.
std::string looksLikeText(const std::vector<report::SimilarObject>& similar, const std::string& object_id,
                          const std::string& database_root);

}  // namespace object_modelling::pipeline
