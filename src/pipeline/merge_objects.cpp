#include "object_modelling/pipeline/merge_objects.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include <yaml-cpp/yaml.h>

#include "model_build.h"
#include "model_description.h"
#include "model_match.h"
#include "object_modelling/base/options.h"
#include "object_modelling/database/view_files.h"
#include "object_modelling/geometry/plane.h"

namespace object_modelling::pipeline
{
namespace
{
constexpr std::size_t MAX_BASE_LENGTH = 56;  // of a session id that gets a number

bool hasSession(const database::ObjectEntry& entry, const std::string& session_id)
{
  return std::any_of(entry.sessions.begin(), entry.sessions.end(),
                     [&](const database::ModelSession& session) { return session.id == session_id; });
}

/// Id by which a session of the other object is added where its own is taken: that of another recording.
std::string freeId(const std::string& id, const std::vector<std::string>& taken)
{
  std::string free = id;
  for (int i = 2; std::find(taken.begin(), taken.end(), free) != taken.end(); ++i)
    free = id.substr(0, MAX_BASE_LENGTH) + "_" + std::to_string(i);
  return free;
}

/// Whether a session of the kept object is one of the other, perhaps added before by a free id: recordings of one name
/// differ in time.
bool sameRecording(const database::ModelSession& of_keep, const database::ModelSession& of_drop)
{
  const std::string base = of_drop.id.substr(0, MAX_BASE_LENGTH) + "_";
  const bool known = of_keep.first_stamp_s <= of_keep.last_stamp_s && of_drop.first_stamp_s <= of_drop.last_stamp_s;
  return (of_keep.id == of_drop.id || of_keep.id.rfind(base, 0) == 0) && known &&
         of_keep.first_stamp_s <= of_drop.last_stamp_s && of_drop.first_stamp_s <= of_keep.last_stamp_s;
}

const database::ModelSession* sameIn(const database::ObjectEntry& keep, const database::ModelSession& of_drop)
{
  for (const database::ModelSession& of_keep : keep.sessions)
    if (sameRecording(of_keep, of_drop))
      return &of_keep;
  return nullptr;
}

bool addsSessions(const database::ObjectEntry& keep, const database::ObjectEntry& drop)
{
  return !keep.sessions.empty() &&
         std::any_of(drop.sessions.begin(), drop.sessions.end(),
                     [&](const database::ModelSession& session) { return sameIn(keep, session) == nullptr; });
}

/// Pose of the object to go in the frame of the other; by a session of both, or else by alignment.
ModelMatch placedBeside(const database::ObjectDatabase& database, const database::ObjectEntry& keep,
                        const database::ObjectEntry& drop, base::JobControl& control)
{
  ModelMatch match;
  for (const database::ModelSession& of_drop : drop.sessions)
    if (const database::ModelSession* of_keep = sameIn(keep, of_drop))
    {
      match.accepted = true;
      match.probability = 1;
      match.T_stored_model = of_keep->T_model_session * of_drop.T_model_session.inverse();
      return match;
    }
  control.report("compare '" + keep.id + "' with '" + drop.id + "'", 0, 1);
  match = matchModels(partOfStored(database, keep), partOfStored(database, drop), control);
  control.report("compare '" + keep.id + "' with '" + drop.id + "'", 1, 1);
  return match;
}

std::string notOne(const std::string& keep, const std::string& drop, const ModelMatch& match)
{
  return "it is not certain that '" + drop + "' is the same object as '" + keep + "', and how it lies to it (" +
         match.figures +
         "): both stay as they are. If they are one, record the object so that both show more of the "
         "same, or build '" +
         keep +
         "' from the sessions of both, joined by hand ('object_modelling align --accept'); "
         "if '" +
         drop + "' is not needed, 'object_modelling delete' takes it away";
}

/// Keyframes that the stored views are of, as far as quality.yaml tells.
std::vector<int> keyframeIds(const std::string& folder, std::size_t view_count)
{
  std::vector<int> ids;
  for (std::size_t i = 0; i < view_count; ++i)
    ids.push_back(static_cast<int>(i));
  try
  {
    for (const YAML::Node& view : YAML::LoadFile(folder + "/quality.yaml")["views"])
      ids.at(view["index"].as<std::size_t>()) = view["keyframe_id"].as<int>();
  }
  catch (const std::exception&)
  {
    // Numbers of the views serve as well: they name them in the report alone.
  }
  return ids;
}

/// Adds what the database has of an object; sessions that `keep` has are passed over, unless it is null.
void addStored(const database::ObjectDatabase& database, const database::ObjectEntry& entry,
               const database::ObjectEntry* keep, const Eigen::Isometry3d& T_reference_model, BuildInput* input)
{
  const std::string folder = database.root() + "/" + entry.id;
  std::vector<int> places(entry.sessions.size(), -1);
  for (std::size_t i = 0; i < entry.sessions.size(); ++i)
  {
    const database::ModelSession& session = entry.sessions[i];
    if (keep != nullptr && sameIn(*keep, session) != nullptr)
      continue;
    const std::string id = freeId(session.id, idsOf(input->placements));
    places[i] = static_cast<int>(input->placements.size());
    input->placements.push_back({ id, T_reference_model * session.T_model_session });
    input->views.sessions.emplace_back();
    input->views.sessions.back().id = id;
    input->views.sessions.back().keyframe_count = session.keyframe_count;
  }
  std::vector<rgbd::View> views = database::readViews(folder);
  const std::vector<int> keyframe_ids = keyframeIds(folder, views.size());
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    const int place = places.at(static_cast<std::size_t>(views[i].session_index));
    if (place < 0)
      continue;
    views[i].session_index = place;
    rgbd::transform(T_reference_model, &views[i]);
    input->views.origins.push_back({ input->placements[static_cast<std::size_t>(place)].session_id, keyframe_ids[i] });
    input->views.views.push_back(std::move(views[i]));
  }
  for (const Eigen::Isometry3d& T_support_model : entry.T_support_model)
    input->views.support_planes_reference.push_back(geometry::transformed(
        T_reference_model, { T_support_model.linear().row(2).transpose(), T_support_model.translation().z() }));
}

std::vector<database::LeftOutSession> leftOutOfBoth(const database::ObjectEntry& keep,
                                                    const database::ObjectEntry& drop)
{
  std::vector<database::LeftOutSession> left_out = keep.sessions_left_out;
  left_out.insert(left_out.end(), drop.sessions_left_out.begin(), drop.sessions_left_out.end());
  std::vector<database::LeftOutSession> result;
  for (const database::LeftOutSession& session : left_out)
    if (!hasSession(keep, session.id) && !hasSession(drop, session.id) &&
        std::none_of(result.begin(), result.end(),
                     [&](const database::LeftOutSession& other) { return other.id == session.id; }))
      result.push_back(session);
  return result;
}

BuildReport buildBoth(database::ObjectDatabase& database, const database::ObjectEntry& keep,
                      const database::ObjectEntry& drop, const Eigen::Isometry3d& T_keep_drop, BuildOptions options,
                      base::JobControl& control)
{
  options.left_out = leftOutOfBoth(keep, drop);
  options.find_similar = false;
  ModelBuild build(database, options, control);
  BuildInput input;
  input.object_id = keep.id;
  input.name = keep.name;
  input.existing = keep;
  input.T_model_reference = Eigen::Isometry3d::Identity();
  control.report("load", 0, 2);
  addStored(database, keep, nullptr, Eigen::Isometry3d::Identity(), &input);
  control.report("load", 1, 2);
  addStored(database, drop, &keep, T_keep_drop, &input);
  control.report("load", 2, 2);
  return build.run(std::move(input));
}

/// The sessions of an object in the store follow what the database says of it.
void moveSessions(keyframes::SessionStore& store, const database::ObjectEntry& entry, const std::string& former_id)
{
  for (const keyframes::Session& session : store.listSessions())
  {
    if (session.object_id != former_id && session.object_id != entry.id)
      continue;
    keyframes::SessionChange change;
    change.object_id = entry.id;
    change.T_model_session = std::optional<Eigen::Isometry3d>();
    for (const database::ModelSession& placed : entry.sessions)
      if (placed.id == session.id)
        change.T_model_session = placed.T_model_session;
    store.update(session.id, change);
  }
}

void addText(const std::string& text, std::string* message)
{
  *message += (message->empty() || text.empty() ? "" : "; ") + text;
}
}  // namespace

MergeReport mergeObjects(database::ObjectDatabase& database, const std::string& keep, const std::string& drop,
                         const BuildOptions& options, keyframes::SessionStore* store, base::JobControl& control)
{
  base::checked(options);
  if (keep == drop)
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "'" + keep + "' cannot be merged with itself: name two objects");
  const database::ObjectEntry kept = database.entry(keep), dropped = database.entry(drop);
  MergeReport report;
  const ModelMatch match = placedBeside(database, kept, dropped, control);
  report.probability = match.probability;
  if (!match.accepted)
  {
    report.status = { base::StatusCode::FAILED_PRECONDITION, notOne(keep, drop, match) };
    return report;
  }
  if (addsSessions(kept, dropped))
  {
    report.built = buildBoth(database, kept, dropped, match.T_stored_model, options, control);
    report.status = report.built.status;
    if (!report.status.ok())
      return report;
    report.rebuilt = true;
  }
  database.absorb(keep, drop, dropped.content_hash);
  if (store != nullptr)
    try
    {
      moveSessions(*store, database.entry(keep), drop);
    }
    catch (const base::Error& error)
    {
      addText("the objects are merged, but not all their sessions in the store could be told: " +
                  std::string(error.what()) + "; build '" + keep + "' from them to mend that",
              &report.status.message);
    }
  return report;
}

std::string renameObject(database::ObjectDatabase& database, const std::string& object_id, const std::string& new_id,
                         keyframes::SessionStore* store, base::JobControl& control)
{
  std::string warning;
  const auto remake = [&](const std::string& folder)
  {
    const std::string path = folder + "/report.html";
    if (!std::filesystem::exists(path))
      return;
    std::filesystem::remove(path);  // it has the old id inside
    warning = reportWarning(folder, new_id, database.root(), control);
  };
  std::vector<std::string> moved;
  const auto move = [&](const std::string& session_id, const std::string& owner)
  {
    keyframes::SessionChange change;
    change.object_id = owner;
    store->update(session_id, change);
  };
  std::vector<keyframes::Session> sessions;
  if (store != nullptr)
    sessions = store->listSessions();
  database.rename(object_id, new_id, remake);
  try
  {
    for (const keyframes::Session& session : sessions)
      if (session.object_id == object_id)
      {
        move(session.id, new_id);
        moved.push_back(session.id);
      }
  }
  catch (const base::Error&)
  {
    database.rename(new_id, object_id, remake);
    for (const std::string& id : moved)
      move(id, object_id);
    throw;
  }
  return warning;
}

}  // namespace object_modelling::pipeline
