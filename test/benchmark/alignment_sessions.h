#pragma once

#include <string>
#include <vector>

#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::benchmark_alignment
{
/// A recorded, refined and segmented session.
struct StoredSession
{
  keyframes::Session session;
  std::vector<rgbd::Keyframe> keyframes;
  double made_s = 0;  ///< time it took; 0: it was there
};

/// The last two path components, since "session_1" is not unique: "004_sugar_box.session_1".
std::string sessionIdOf(const std::string& folder);
/// The first of these two.
std::string objectFolderOf(const std::string& folder);

/// From `cache`/<session id>.sqlite, or made as the command `model` makes it and kept there. What is there already was
/// made with the noise model of then. Throws base::Error; a session that could not be made leaves no file.
StoredSession storedSession(const std::string& folder, const std::string& cache,
                            const rgbd::SensorNoiseModel& noise_model);

}  // namespace object_modelling::benchmark_alignment
