#include "object_modelling/pipeline/build_object.h"

#include <algorithm>

#include "model_build.h"
#include "model_description.h"
#include "object_modelling/base/options.h"

namespace object_modelling::pipeline
{
namespace
{
/// What is known without any work.
base::Status check(keyframes::SessionStore& store, const std::string& object_id,
                   const std::vector<alignment::SessionPlacement>& placements, const BuildOptions& options)
{
  try
  {
    database::checkObjectId(object_id);
  }
  catch (const base::Error& error)
  {
    return error.status();
  }
  if (placements.empty())
    return { base::StatusCode::FAILED_PRECONDITION,
             "object '" + object_id + "' has no session to build from: record one first" };
  const std::vector<std::string> placed = idsOf(placements);
  for (const database::LeftOutSession& left_out : options.left_out)
  {
    store.session(left_out.id);  // NOT_FOUND names it
    if (std::find(placed.begin(), placed.end(), left_out.id) != placed.end())
      return { base::StatusCode::INVALID_ARGUMENT,
               "session '" + left_out.id + "' is placed and left out: name it once" };
  }
  return {};
}

}  // namespace

std::vector<std::string> BuildOptions::violations() const
{
  base::OptionsCheck check("build_object");
  check.include(fusion.violations());
  check.include(surface.violations());
  check.include(texture.violations());
  check.include(properties.violations());
  return check.violations();
}

BuildReport buildObject(keyframes::SessionStore& store, database::ObjectDatabase& database,
                        const std::string& object_id, const std::string& name,
                        const std::vector<alignment::SessionPlacement>& placements, const BuildOptions& options,
                        base::JobControl& control)
{
  base::checked(options);
  ModelBuild build(database, options, control);
  BuildReport refused;
  refused.status = check(store, object_id, placements, options);
  if (!refused.status.ok())
    return refused;
  BuildInput input;
  input.object_id = object_id;
  input.name = name.empty() ? object_id : name;
  input.placements = placements;
  refused.status = loadViews(store, placements, control, &input.views);
  if (!refused.status.ok())
    return refused;
  input.existing = existingEntry(database, object_id);
  if (input.existing)
    input.T_model_reference = sharedFrame(*input.existing, placements, input.views.views);
  BuildReport report = build.run(std::move(input));
  if (report.status.ok())
    updateSessions(store, build.model());
  return report;
}

}  // namespace object_modelling::pipeline
