#include "database_watch.h"

#include <chrono>

#include <ros/console.h>

#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace
{
/// Objects that are learnt while others still wait are used after so long.
constexpr std::chrono::seconds MAX_DELAY(5);
}  // namespace

DatabaseWatch::DatabaseWatch(std::string root, double poll_period_s, const recognition::RecogniserOptions& options,
                             Callback on_change)
    : root_(std::move(root)),
      poll_period_s_(poll_period_s),
      options_(options),
      on_change_(std::move(on_change)),
      thread_([this] { run(); })
{
}

DatabaseWatch::~DatabaseWatch()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
  }
  control_.cancel();
  changed_.notify_all();
  thread_.join();
}

std::shared_ptr<const KnownObjects> DatabaseWatch::known() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return known_;
}

std::shared_ptr<const KnownObjects> DatabaseWatch::reload()
{
  std::unique_lock<std::mutex> lock(mutex_);
  const std::size_t ticket = ++asked_;
  changed_.notify_all();
  changed_.wait(lock, [&] { return stopped_ || answered_ >= ticket; });
  if (stopped_)
    throw base::Error(base::StatusCode::CANCELLED, "the node ends");
  return known_;
}

void DatabaseWatch::run()
{
  const auto period = std::chrono::duration<double>(poll_period_s_);
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopped_)
  {
    const std::size_t asked = asked_;
    const bool again = asked > answered_;
    lock.unlock();
    const base::Status status = ros_bridge::guarded([&] { look(again); });
    if (!status.ok() && status.code != base::StatusCode::CANCELLED)
      ROS_WARN_THROTTLE(60, "cannot look at the object database: %s", status.message.c_str());
    lock.lock();
    answered_ = asked;
    changed_.notify_all();
    changed_.wait_for(lock, period, [&] { return stopped_ || asked_ > answered_; });
  }
}

std::map<std::string, std::string> DatabaseWatch::listed(base::Status* status) const
{
  std::map<std::string, std::string> hashes;
  *status = ros_bridge::guarded([&] { hashes = database::ObjectDatabase(root_, false).contentHashes(); });
  if (status->code == base::StatusCode::NOT_FOUND)
    status->message = "no object database at " + root_ + " yet: it is made with the first object; waiting for it";
  return hashes;
}

void DatabaseWatch::look(bool again)
{
  base::Status status;
  const std::map<std::string, std::string> hashes = listed(&status);
  // A manifest that cannot be read says nothing of the objects: those that are known stay so.
  const bool unreadable = !status.ok() && status.code != base::StatusCode::NOT_FOUND;
  bool changed = again || known()->learning || status.code != database_status_.code;
  database_status_ = status;
  for (auto object = learnt_.begin(); !unreadable && object != learnt_.end();)
  {
    const bool gone = hashes.count(object->first) == 0;
    if (gone)
      ROS_INFO("object '%s' is forgotten: the database has it no more", object->first.c_str());
    changed = changed || gone;
    object = gone ? learnt_.erase(object) : std::next(object);
  }
  auto last = std::chrono::steady_clock::now();
  for (const auto& [id, hash] : hashes)
  {
    const auto found = learnt_.find(id);
    if (found != learnt_.end() && found->second.manifest_hash == hash && !(again && !found->second.knowledge))
      continue;
    learnt_[id] = learn(id, hash);
    changed = true;
    if (std::chrono::steady_clock::now() - last < MAX_DELAY)
      continue;
    publish(known()->learning);
    last = std::chrono::steady_clock::now();
  }
  if (changed)
    publish(false);
}

DatabaseWatch::Learnt DatabaseWatch::learn(const std::string& id, const std::string& manifest_hash)
{
  Learnt learnt;
  learnt.manifest_hash = manifest_hash;
  recognition::LearntObject object;
  const base::Status status = ros_bridge::guarded(
      [&]
      {
        database::ObjectDatabase database(root_, false);
        object = recognition::recallOrLearn(database, database.entry(id), {}, control_);
      });
  control_.checkCancelled();
  learnt.knowledge = object.knowledge;
  learnt.failure = status.message;
  if (status.ok())
    ROS_INFO("object '%s' is %s", id.c_str(), object.recalled ? "known from earlier" : "learnt");
  else
    ROS_WARN("object '%s' of %s cannot be learnt and is left out: %s", id.c_str(), root_.c_str(),
             status.message.c_str());
  if (!object.kept.ok())
    ROS_WARN("object '%s' works from memory, and has to be learnt again after the next start: %s", id.c_str(),
             object.kept.message.c_str());
  return learnt;
}

void DatabaseWatch::publish(bool learning)
{
  auto known = std::make_shared<KnownObjects>();
  known->learning = learning;
  known->status = database_status_;
  std::vector<std::shared_ptr<const recognition::ObjectKnowledge>> objects;
  std::string failures;
  for (const auto& [id, learnt] : learnt_)
  {
    if (!learnt.knowledge)
    {
      failures += (failures.empty() ? "" : "; ") + ("object '" + id + "': " + learnt.failure);
      continue;
    }
    known->objects[id] = learnt.knowledge;
    objects.push_back(learnt.knowledge);
  }
  if (known->status.ok() && !failures.empty())
    known->status = { base::StatusCode::BAD_INPUT, "cannot be read and left out: " + failures };
  if (!objects.empty())
    known->recogniser = std::make_shared<const recognition::Recogniser>(std::move(objects), options_);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    known_ = known;
  }
  on_change_(*known);
}

}  // namespace object_modelling::nodes
