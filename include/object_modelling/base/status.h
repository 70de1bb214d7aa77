#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace object_modelling::base
{
/// Why an operation ended as it did. The numbers are those of msg/Status.msg; never renumber.
enum class StatusCode : unsigned char
{
  OK = 0,
  INVALID_ARGUMENT = 1,     ///< the caller asked for something malformed
  NOT_FOUND = 2,            ///< a session, object, file that does not exist
  FAILED_PRECONDITION = 3,  ///< right call, wrong time (stop before start, no keyframes yet)
  BAD_INPUT = 4,            ///< sensor data or a file that cannot be used
  NO_RESULT = 5,            ///< the method ran and found nothing (no plane, no overlap)
  STORAGE = 6,              ///< disk full, locked, not writable, newer schema
  CANCELLED = 7,
  TIMEOUT = 8,
  INTERNAL = 9,
};

/// Outcome with a message that names the thing, the value and the remedy. OK has none, or a warning.
struct Status
{
  StatusCode code = StatusCode::OK;
  std::string message;

  Status() = default;
  Status(StatusCode status_code, std::string text) : code(status_code), message(std::move(text)) {}
  bool ok() const { return code == StatusCode::OK; }
};

/// Failure of files, devices and configuration. Nodes and command lines turn it into a Status.
class Error : public std::runtime_error
{
public:
  Error(StatusCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  StatusCode code() const { return code_; }
  Status status() const { return { code_, what() }; }

private:
  StatusCode code_;
};

/// A value, or the reason why there is none.
template <typename T>
struct Result
{
  Status status;
  T value{};  ///< meaningful only if status.ok()

  bool ok() const { return status.ok(); }
};

}  // namespace object_modelling::base
