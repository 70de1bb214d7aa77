#pragma once

#include <memory>
#include <string>

#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::cli
{
/// A keyframe store in a temporary folder of its own, removed with it; for runs whose sessions are not kept.
class TemporaryStore
{
public:
  TemporaryStore();
  ~TemporaryStore();
  TemporaryStore(const TemporaryStore&) = delete;
  TemporaryStore& operator=(const TemporaryStore&) = delete;
  keyframes::SessionStore& get() { return *store_; }

private:
  std::string folder_;
  std::unique_ptr<keyframes::SessionStore> store_;
};

}  // namespace object_modelling::cli
