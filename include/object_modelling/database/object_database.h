#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/database/object_model.h"

namespace object_modelling::database
{
/// Contents of manifest.yaml and object.yaml for one object; no geometry loaded.
struct ObjectEntry
{
  std::string id, name;
  std::string content_hash;          ///< SHA-256 of object.yaml, which holds that of every other file
  std::vector<std::string> aliases;  ///< ids of objects that were found to be this one
  int frame_version = 1;             ///< counts the changes of the object frame
  std::vector<ModelSession> sessions;
  bool partial = false;                              ///< made without some of the object's sessions ...
  std::vector<LeftOutSession> sessions_left_out;     ///< ... which are these
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< of box_model
  geometry::OrientedBox box_model;
  double diameter_m = 0;
  std::vector<Eigen::Isometry3d> T_support_model;  ///< resting poses
  std::map<std::string, double> quality;
  std::string mesh_path;  ///< absolute, mesh/mesh.ply
  int schema_version = 0;
  /// None in objects of schema version 1; the collision parts are not loaded, but in these files (absolute paths).
  std::optional<object_properties::ObjectProperties> properties;
  std::vector<std::string> collision_paths;
};

/// Makes report.html in an object's folder, from what lies there. May throw.
using ReportMaker = std::function<void(const std::string& folder)>;

/// Throws base::Error (INVALID_ARGUMENT) for names that no object can have: all but keyframes::isValidId(), and the
/// names of the database's own files.
void checkObjectId(const std::string& object_id);

/// A folder of models, readable without us (layout: docs/object_database.md). Every write goes to a temporary folder
/// inside the root and is renamed; a crash leaves the old object whole. Several readers, one writer (a lock file).
/// Safe for several threads. Throws base::Error: STORAGE (not writable, disk full, newer schema), NOT_FOUND,
/// INVALID_ARGUMENT (object id).
class ObjectDatabase
{
public:
  /// Opens; creates the folder and an empty manifest if `create`. Checks at once that it can be written if `create`.
  ObjectDatabase(const std::string& root, bool create);

  /// By id. Objects that cannot be read are left out with a warning; check() names them.
  std::vector<ObjectEntry> list() const;
  ObjectEntry entry(const std::string& object_id) const;
  /// By id, of manifest.yaml alone: tells quickly what has changed, and names objects that cannot be read, too.
  std::map<std::string, std::string> contentHashes() const;
  /// Writes or replaces one object in one atomic step; returns its folder. The same model gives the same bytes.
  /// Cancelling leaves the database as it was.
  /// `make_report` may add report.html to the finished folder before it is put in place.
  std::string write(const ObjectModel& model, base::JobControl& control, const ReportMaker& make_report = {});
  /// Runs `make_report` on an object that is there, for a report that is missing or was made by another version.
  void remakeReport(const std::string& object_id, base::JobControl& control, const ReportMaker& make_report);
  void remove(const std::string& object_id);
  /// The same object by another id, with its files as they are; NOT_FOUND, or INVALID_ARGUMENT if the new id is taken.
  /// `make_report` is run on the finished folder before it is put in place.
  void rename(const std::string& object_id, const std::string& new_id, const ReportMaker& make_report = {});
  /// Takes an object away that is the same as another one, which gets its id and aliases as aliases.
  /// FAILED_PRECONDITION if the content hash of the one to go is not the given one: somebody else has changed it. A
  /// crash between leaves both.
  void absorb(const std::string& object_id, const std::string& absorbed_id, const std::string& absorbed_hash);
  /// Brings an object of an older schema to the present one: properties of its mesh are added, all else stays, in one
  /// atomic step. False if it is up to date.
  bool migrate(const std::string& object_id, base::JobControl& control);
  /// Keeps a file that follows from an object, as its recognition/<name>; no part of the object and its hash. False if
  /// the object is not the one of that content hash any more. `write` is given the path of a temporary file.
  bool keepDerived(const std::string& object_id, const std::string& content_hash, const std::string& name,
                   const std::function<void(const std::string& path)>& write, const base::JobControl& control);
  static std::string derivedPath(const std::string& root, const std::string& object_id, const std::string& name);
  /// Every broken file, hash, unit or frame, one message each; empty when sound.
  std::vector<std::string> check() const;
  const std::string& root() const { return root_; }

private:
  std::string root_;
};

}  // namespace object_modelling::database
