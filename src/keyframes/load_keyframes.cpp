#include <future>

#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::keyframes
{
std::vector<rgbd::Keyframe> loadKeyframes(SessionStore& store, const std::string& session_id,
                                          const std::function<void(std::size_t, std::size_t)>& progress)
{
  const std::vector<int> ids = store.keyframeIds(session_id);
  std::vector<rgbd::Keyframe> keyframes;
  keyframes.reserve(ids.size());
  std::future<rgbd::Keyframe> last;  // waits for its thread where something is thrown
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    if (progress)
      progress(i, ids.size());
    auto encoded = std::make_shared<const EncodedKeyframe>(store.encodedKeyframe(session_id, ids[i]));
    if (last.valid())
      keyframes.push_back(last.get());
    last = std::async(std::launch::async, [encoded, &session_id] { return decoded(*encoded, session_id); });
  }
  if (last.valid())
    keyframes.push_back(last.get());
  if (progress)
    progress(ids.size(), ids.size());
  return keyframes;
}

}  // namespace object_modelling::keyframes
