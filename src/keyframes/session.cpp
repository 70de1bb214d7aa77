#include "object_modelling/keyframes/session.h"

#include <algorithm>

namespace object_modelling::keyframes
{
namespace
{
constexpr std::size_t MAX_ID_LENGTH = 64;

// Not std::isalnum: what is a letter must not depend on the process's locale.
bool isIdCharacter(char c)
{
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '-';
}
}  // namespace

bool isValidId(const std::string& id)
{
  return !id.empty() && id.size() <= MAX_ID_LENGTH && id[0] != '.' && id[0] != '-' &&
         std::all_of(id.begin(), id.end(), isIdCharacter);
}

}  // namespace object_modelling::keyframes
