#pragma once

#include <string>

#include "object_modelling/pipeline/build_object.h"

// Two objects of a database that are one, and an object that gets another id.
namespace object_modelling::pipeline
{
struct MergeReport
{
  /// OK: merged, or with a message that says what could not be done besides. Otherwise both objects are as they were.
  base::Status status;
  bool rebuilt = false;    ///< false: the kept model stays as it is, since the other one adds no session to it
  double probability = 0;  ///< that both are one object
  BuildReport built;       ///< of the common model, where it was rebuilt
};

/// Makes one object of two: `keep` gets the views of both, in its own frame, and a new model of them; the other one
/// goes, and its id becomes an alias. A model that was imported from a mesh is not built anew and adds nothing to
/// another. The sessions of both in `store`, unless null, then belong to `keep`. A crash at any point leaves both
/// objects, or the common one; called again, it goes on. FAILED_PRECONDITION where it is not certain that and how both
/// are one. Throws base::Error (NOT_FOUND, INVALID_ARGUMENT, BAD_INPUT: an object that cannot be read, STORAGE),
/// Cancelled.
MergeReport mergeObjects(database::ObjectDatabase& database, const std::string& keep, const std::string& drop,
                         const BuildOptions& options, keyframes::SessionStore* store, base::JobControl& control);

/// Gives an object another id, also where its report and the sessions of `store`, unless null, name it: all or nothing.
/// Returns what could not be done besides: a report that could not be made anew is taken away. Throws as
/// ObjectDatabase::rename() and the store do.
std::string renameObject(database::ObjectDatabase& database, const std::string& object_id, const std::string& new_id,
                         keyframes::SessionStore* store, base::JobControl& control);

}  // namespace object_modelling::pipeline
