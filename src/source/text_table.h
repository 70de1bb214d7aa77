#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/status.h"

namespace object_modelling::source
{
/// One line of a list file: words between blanks, '#' comments and empty lines left out, any line ending.
struct TextRow
{
  std::string where;  ///< "path:line", for messages
  std::vector<std::string> words;

  /// Throws base::Error (BAD_INPUT) if there are fewer words.
  void requireWords(std::size_t count, const std::string& expected) const;
  /// Finite number, whole word, '.' as decimal point whatever the locale; throws base::Error (BAD_INPUT).
  double number(std::size_t index) const;
};

/// Throws base::Error (NOT_FOUND, STORAGE).
std::vector<TextRow> readTextTable(const std::string& path);

base::Error badInput(const std::string& where, const std::string& what);

}  // namespace object_modelling::source
