#pragma once

#include <gtest/gtest.h>

#include "object_modelling/pipeline/build_object.h"
#include "recordings.h"
#include "support/temp_dir.h"

namespace object_modelling::pipeline
{
/// The stages that took time, in their order.
inline std::vector<std::string> stagesOf(const BuildReport& report)
{
  std::vector<std::string> names;
  for (const StageTime& time : report.stages)
    names.push_back(time.stage);
  return names;
}

/// A store with the rendered session "box", and an empty database. Coarse, to be quick.
class BuildObject : public ::testing::Test
{
protected:
  void SetUp() override { storeRenderedSession(*store_, "box"); }

  static BuildOptions coarse()
  {
    BuildOptions options;
    options.fusion.resolution_m = options.surface.resolution_m = 0.004;
    options.surface.max_support_distance_m = 0.012;
    options.make_report = false;
    return options;
  }
  BuildReport build(const std::vector<std::string>& session_ids, const BuildOptions& options = coarse(),
                    const std::string& object_id = "carton")
  {
    std::vector<alignment::SessionPlacement> placements;
    for (const std::string& id : session_ids)
      placements.push_back({ id, Eigen::Isometry3d::Identity() });
    return buildObject(*store_, database_, object_id, "", placements, options, control_);
  }
  /// Hash of the object, empty if there is none.
  std::string contentHash(const std::string& object_id = "carton") const
  {
    for (const database::ObjectEntry& entry : database_.list())
      if (entry.id == object_id)
        return entry.content_hash;
    return {};
  }
  void removeMasks(const std::string& session_id)
  {
    std::vector<keyframes::MaskUpdate> updates;
    for (const int id : store_->keyframeIds(session_id))
      updates.push_back({ id, cv::Mat() });
    store_->update(session_id, keyframes::SessionChange::ofMasks(updates));
  }

  test_support::TempDir folder_;
  std::unique_ptr<keyframes::SessionStore> store_ = keyframes::openSqlStore(folder_.path("store.db"));
  database::ObjectDatabase database_{ folder_.path("objects"), true };
  base::JobControl control_;
};

}  // namespace object_modelling::pipeline
