#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "object_modelling/base/job_control.h"
#include "object_modelling/recognition/recogniser.h"

namespace object_modelling::nodes
{
/// What is known of a database at one time. Never changed once made, and shared; the recogniser is for one thread.
struct KnownObjects
{
  std::map<std::string, std::shared_ptr<const recognition::ObjectKnowledge>> objects;  ///< by id
  std::shared_ptr<const recognition::Recogniser> recogniser;                           ///< null without objects
  base::Status status;   ///< NOT_FOUND: no database yet; BAD_INPUT names the objects that cannot be read
  bool learning = true;  ///< the first look at the database is not over
};

/// Follows an object database in a thread of its own: learns objects that are new or changed, forgets those that are
/// gone. What was known before goes on working meanwhile. All calls are safe for several threads.
class DatabaseWatch
{
public:
  using Callback = std::function<void(const KnownObjects&)>;

  /// `on_change` is called on the thread of the watch.
  DatabaseWatch(std::string root, double poll_period_s, const recognition::RecogniserOptions& options,
                Callback on_change);
  ~DatabaseWatch();

  std::shared_ptr<const KnownObjects> known() const;
  /// Looks now, and again at objects that could not be read; returns what is known then. Throws base::Error (CANCELLED)
  /// at the end of the watch.
  std::shared_ptr<const KnownObjects> reload();

private:
  /// What came of an object: `knowledge`, or the reason why there is none.
  struct Learnt
  {
    std::string manifest_hash;
    std::shared_ptr<const recognition::ObjectKnowledge> knowledge;
    std::string failure;
  };

  void run();
  void look(bool again);
  /// Hashes by id as the manifest has them; empty, with a status, where it cannot be read.
  std::map<std::string, std::string> listed(base::Status* status) const;
  Learnt learn(const std::string& id, const std::string& manifest_hash);
  void publish(bool learning);

  const std::string root_;
  const double poll_period_s_;
  const recognition::RecogniserOptions options_;
  const Callback on_change_;

  // Of the thread alone.
  std::map<std::string, Learnt> learnt_;  ///< by id
  base::Status database_status_;
  base::JobControl control_;

  mutable std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  std::shared_ptr<const KnownObjects> known_ = std::make_shared<KnownObjects>();
  std::size_t asked_ = 0, answered_ = 0;  ///< calls of reload()
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace object_modelling::nodes
