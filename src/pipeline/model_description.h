#pragma once

#include <optional>
#include <string>
#include <vector>

#include "build_views.h"
#include "object_modelling/database/object_database.h"

namespace object_modelling::pipeline
{
std::vector<std::string> idsOf(const std::vector<alignment::SessionPlacement>& placements);

/// The object of this id, if there is one that can be read.
std::optional<database::ObjectEntry> existingEntry(const database::ObjectDatabase& database, const std::string& id);

/// T_model_reference of the object as it stands in the database, through a session that both builds share; none where
/// there is no such session. A session of the same id whose views are of another time is another recording.
std::optional<Eigen::Isometry3d> sharedFrame(const database::ObjectEntry& existing,
                                             const std::vector<alignment::SessionPlacement>& placements,
                                             const std::vector<rgbd::View>& views);

/// Box, resting poses and sessions of a model.
void describe(const Views& views, const std::vector<alignment::SessionPlacement>& placements,
              const Eigen::Isometry3d& T_model_reference, const geometry::OrientedBox& box_reference,
              database::ObjectModel* model);

/// Preview and turntable of a model, with its texture if it has one.
void drawPictures(database::ObjectModel* model);

/// Says that a model is partial, and what it lacks; empty where it is whole.
std::string partialText(const database::ObjectModel& model);

/// Tells the store which sessions the model has, and where; those left out belong to the object, but lie nowhere in it.
void updateSessions(keyframes::SessionStore& store, const database::ObjectModel& model);

}  // namespace object_modelling::pipeline
