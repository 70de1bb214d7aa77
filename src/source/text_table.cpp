#include "text_table.h"

#include <cmath>
#include <locale>
#include <sstream>

#include "object_modelling/base/atomic_file.h"

namespace object_modelling::source
{
base::Error badInput(const std::string& where, const std::string& what)
{
  return { base::StatusCode::BAD_INPUT, where + ": " + what };
}

void TextRow::requireWords(std::size_t count, const std::string& expected) const
{
  if (words.size() < count)
    throw badInput(where, "has " + std::to_string(words.size()) + " words, expected \"" + expected + "\"");
}

double TextRow::number(std::size_t index) const
{
  const std::string& word = words.at(index);
  std::istringstream in(word);
  in.imbue(std::locale::classic());
  double value = 0;
  if (!(in >> value) || in.peek() != std::istringstream::traits_type::eof() || !std::isfinite(value))
    throw badInput(where, "\"" + word + "\" is not a number");
  return value;
}

std::vector<TextRow> readTextTable(const std::string& path)
{
  std::istringstream file(base::readTextFile(path));
  std::vector<TextRow> rows;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number)
  {
    std::istringstream in(line);  // blanks include the carriage return of DOS files
    TextRow row{ path + ":" + std::to_string(number), {} };
    for (std::string word; in >> word && word.front() != '#';)
      row.words.push_back(word);
    if (!row.words.empty())
      rows.push_back(row);
  }
  return rows;
}

}  // namespace object_modelling::source
