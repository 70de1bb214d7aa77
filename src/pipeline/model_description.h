#pragma once

#include <optional>
#include <string>
#include <vector>

#include "build_views.h"
#include "object_modelling/database/object_database.h"

namespace object_modelling::pipeline
{
/// T_model_reference of the object as it stands in the database, through a session that both builds share; none where
/// the object is new, or where `replace` allows another frame. FAILED_PRECONDITION where its frame would change.
base::Result<std::optional<Eigen::Isometry3d>> inheritedFrame(
    const database::ObjectDatabase& database, const std::string& object_id,
    const std::vector<alignment::SessionPlacement>& placements, bool replace);

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
