#include <cmath>
#include <filesystem>

#include "content_hash.h"
#include "manifest.h"
#include "object_modelling/database/object_database.h"
#include "object_modelling/mesh/mesh_files.h"
#include "object_yaml.h"
#include "properties_yaml.h"
#include "yaml_text.h"

namespace object_modelling::database
{
namespace
{
namespace fs = std::filesystem;

constexpr double RIGID_TOLERANCE = 1e-6;
constexpr double PROBABILITY_TOLERANCE = 1e-4;

using Problems = std::vector<std::string>;

void checkUnits(const std::string& path, const std::string& unit, const std::string& handedness, Problems* problems)
{
  if (unit != UNIT)
    problems->push_back(path + ": unit is '" + unit + "', must be '" + UNIT + "'");
  if (handedness != HANDEDNESS)
    problems->push_back(path + ": handedness is '" + handedness + "', must be '" + HANDEDNESS + "'");
}

bool rigid(const Eigen::Isometry3d& T)
{
  const Eigen::Matrix3d R = T.linear();
  return T.matrix().allFinite() && (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < RIGID_TOLERANCE &&
         R.determinant() > 0 && T.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1);
}

void checkFrames(const std::string& path, const ObjectEntry& entry, Problems* problems)
{
  const auto check = [&](const Eigen::Isometry3d& T, const std::string& name)
  {
    if (!rigid(T))
      problems->push_back(path + ": " + name + " is no rigid transform");
  };
  if (!(entry.size_m.minCoeff() > 0) || !(entry.diameter_m > 0))
    problems->push_back(path + ": size_m and diameter_m must be greater than 0");
  check(entry.box_model.T_frame_box, "model_from_box");
  for (const Eigen::Isometry3d& T_support_model : entry.T_support_model)
    check(T_support_model, "support_from_model");
  for (const ModelSession& session : entry.sessions)
    check(session.T_model_session, "model_from_session of session '" + session.id + "'");
}

void checkProperties(const std::string& path, const ObjectEntry& entry, Problems* problems)
{
  const auto require = [&](bool holds, const std::string& what)
  {
    if (!holds)
      problems->push_back(path + ": " + what);
  };
  const object_properties::ObjectProperties& properties = *entry.properties;
  require(isFinite(properties), "mass_properties, resting_poses or symmetries have numbers that are not finite");
  require(properties.mass.volume_m3 >= 0 && properties.mass.mass_kg >= 0 &&
              properties.mass.inertia_per_density_m5.isApprox(properties.mass.inertia_per_density_m5.transpose(), 1e-6),
          "mass_properties: volume and mass must not be negative, the inertia must be symmetric");
  double probability = properties.resting_poses.empty() ? 1 : 0;
  for (const object_properties::RestingPose& pose : properties.resting_poses)
  {
    require(rigid(pose.T_support_model), "resting_poses/support_from_model is no rigid transform");
    probability += pose.probability;
  }
  require(std::abs(probability - 1) < PROBABILITY_TOLERANCE, "the probabilities of resting_poses do not add up to 1");
  for (const object_properties::Symmetry& symmetry : properties.symmetries)
    require(std::abs(symmetry.axis.norm() - 1) < PROBABILITY_TOLERANCE && symmetry.order >= 0 && symmetry.order != 1 &&
                symmetry.error_m >= 0,
            "a symmetry has an axis that is not of unit length, an order of 1 or less, or a negative error");
  if (properties.unseen)
    require(properties.unseen->ratio >= 0 && properties.unseen->ratio <= 1, "unseen/ratio is not within [0, 1]");
}

/// Files that object.yaml promises by a key must also be in its list.
void checkPromised(const std::string& folder, const ObjectDescription& object, Problems* problems)
{
  for (const std::string& file : object.entry.collision_paths)
    if (object.file_hashes.count(file.substr(folder.size() + 1)) == 0)
      problems->push_back(folder + "/object.yaml: collision_parts promises " + file + ", which it does not list");
  if (object.entry.properties && object.entry.properties->unseen && fs::exists(object.entry.mesh_path) &&
      mesh::readMesh(object.entry.mesh_path).seen.empty())
    problems->push_back(object.entry.mesh_path + " lacks the vertex property 'seen', but object.yaml has 'unseen'");
}

void checkLeftOut(const std::string& path, const ObjectEntry& entry, bool listed_partial, Problems* problems)
{
  const auto text = [](bool partial) { return partial ? "true" : "false"; };
  if (entry.partial == entry.sessions_left_out.empty())
    problems->push_back(path + ": partial is " + text(entry.partial) + ", but sessions_left_out has " +
                        std::to_string(entry.sessions_left_out.size()) + " sessions");
  if (entry.partial != listed_partial)
    problems->push_back(path + ": partial is " + text(entry.partial) + ", but " + text(listed_partial) +
                        " in manifest.yaml");
  for (const LeftOutSession& left_out : entry.sessions_left_out)
    for (const ModelSession& session : entry.sessions)
      if (session.id == left_out.id)
        problems->push_back(path + ": session '" + session.id + "' is in sessions and in sessions_left_out");
}

void checkFiles(const std::string& folder, const std::map<std::string, std::string>& expected, Problems* problems)
{
  const std::map<std::string, std::string> found = hashesOfFolder(folder);
  for (const auto& [file, hash] : expected)
  {
    const auto match = found.find(file);
    if (match == found.end())
      problems->push_back(folder + "/" + file + " is missing");
    else if (match->second != hash)
      problems->push_back(folder + "/" + file + " has been changed: its SHA-256 is not the one in object.yaml");
  }
  for (const auto& [file, hash] : found)
    if (expected.count(file) == 0)
      problems->push_back(folder + "/" + file + " is not listed in object.yaml");
}

void checkObject(const std::string& folder, const std::string& id, const ListedObject& listed, Problems* problems)
{
  if (!fs::is_directory(folder))
  {
    problems->push_back(folder + " is missing, but listed in manifest.yaml");
    return;
  }
  const std::string path = folder + "/object.yaml";
  const ObjectDescription object = readObject(folder);
  if (object.entry.content_hash != listed.content_hash)
    problems->push_back(path + " has been changed: its SHA-256 is not the content_hash in manifest.yaml");
  if (object.entry.id != id)
    problems->push_back(path + ": id is '" + object.entry.id + "', but the folder is '" + id + "'");
  checkUnits(path, object.unit, object.handedness, problems);
  checkFrames(path, object.entry, problems);
  checkLeftOut(path, object.entry, listed.partial, problems);
  checkFiles(folder, object.file_hashes, problems);
  if (object.entry.properties)
    checkProperties(path, object.entry, problems);
  checkPromised(folder, object, problems);
  const Problems of_report = checkReport(folder);
  problems->insert(problems->end(), of_report.begin(), of_report.end());
}
}  // namespace

std::vector<std::string> ObjectDatabase::check() const
{
  Problems problems;
  Manifest manifest;
  try
  {
    manifest = readManifest(manifestPath(root_));
  }
  catch (const base::Error& error)
  {
    return { error.what() };
  }
  checkUnits(manifestPath(root_), manifest.unit, manifest.handedness, &problems);
  for (const auto& [id, listed] : manifest.objects)
  {
    try
    {
      checkObject(root_ + "/" + id, id, listed, &problems);
    }
    catch (const std::exception& error)  // of the file system, or of our own reading
    {
      problems.emplace_back(error.what());
    }
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(root_))
  {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory() && name[0] != '.' && name != "exports" && manifest.objects.count(name) == 0)
      problems.push_back(entry.path().string() + " is a folder that manifest.yaml does not list");
  }
  return problems;
}

}  // namespace object_modelling::database
