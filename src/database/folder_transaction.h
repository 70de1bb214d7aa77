#pragma once

#include <map>
#include <string>

#include "manifest.h"
#include "object_modelling/base/job_control.h"

/// How a database changes: the new object is made complete in a temporary folder, the manifest that lists it lies ready
/// beside the old one, then both are renamed. What a crash leaves of this is mended by the next writer.
namespace object_modelling::database
{
/// The one writer of a database, among processes and threads, for the life of the object.
class WriterLock
{
public:
  /// Waits up to 10 s. Throws base::Error: STORAGE (busy, not writable), Cancelled.
  WriterLock(const std::string& root, const base::JobControl& control);
  ~WriterLock();
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

private:
  int descriptor_;
};

/// Folder in which the next state of an object is made, empty; under the lock.
std::string makeTemporaryFolder(const std::string& root, const std::string& object_id);
/// Flushes a folder with all that is in it.
void syncFolder(const std::string& folder);

/// Puts the temporary folder of the object in its place, and the manifest with it.
void commitObject(const std::string& root, const std::string& object_id, const ListedObject& listed);
/// Takes the object away, and its line in the manifest.
void commitRemoval(const std::string& root, const std::string& object_id);

/// Finishes or undoes what a writer that died has begun, and removes its temporaries; under the lock.
void recover(const std::string& root);
/// Removes the temporaries of the running change, whether it succeeded or not; never throws.
void removeTemporaries(const std::string& root);

/// Puts `replacement` at `target` and what was there at `parked`: in one step where the file system can exchange two
/// folders (any local one), else one after the other. Exposed for tests.
void replaceFolder(const std::string& replacement, const std::string& target, const std::string& parked,
                   bool can_exchange = true);

}  // namespace object_modelling::database
