#pragma once

#include <memory>
#include <vector>

#include "object_modelling/features/keyframe_features.h"
#include "object_modelling/recognition/candidate.h"
#include "object_modelling/recognition/object_knowledge.h"
#include "scene.h"

namespace object_modelling::recognition
{
/// All features of all objects in one index: what it costs hardly depends on the number of objects.
class TextureIndex
{
public:
  explicit TextureIndex(const std::vector<std::shared_ptr<const ObjectKnowledge>>& objects);
  ~TextureIndex();
  TextureIndex(TextureIndex&&) noexcept;
  TextureIndex& operator=(TextureIndex&&) noexcept;

  /// Poses that matched features agree on: per object one after the other, each of what the last has left.
  std::vector<PoseHypothesis> poses(const Scene& scene, const features::KeyframeFeatures& found,
                                    std::uint64_t seed) const;

private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace object_modelling::recognition
