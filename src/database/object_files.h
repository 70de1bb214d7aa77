#pragma once

#include <string>

#include "object_modelling/base/job_control.h"
#include "object_modelling/database/object_model.h"

namespace object_modelling::database
{
/// Throws base::Error (INVALID_ARGUMENT) naming what the database could not keep: id, empty mesh, views whose images
/// and camera differ in size, numbers that are not finite.
void checkModel(const ObjectModel& model);

/// mesh/collision_00.ply and so on.
void writeCollisionParts(const std::string& folder, const object_properties::ObjectProperties& properties);

/// All files of the object but object.yaml, into an empty folder. Reports progress; throws base::Error (STORAGE),
/// Cancelled.
void writeObjectFiles(const std::string& folder, const ObjectModel& model, base::JobControl& control);

}  // namespace object_modelling::database
