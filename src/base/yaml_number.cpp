#include "object_modelling/base/yaml_number.h"

#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

namespace object_modelling::base
{
std::string yamlNumber(double value)
{
  if (std::isnan(value))
    return ".nan";
  if (std::isinf(value))
    return value > 0 ? ".inf" : "-.inf";
  std::string text;
  for (int precision = 15; precision <= std::numeric_limits<double>::max_digits10; ++precision)
  {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(precision);
    out << value;
    text = out.str();
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    double read = 0;
    if (in >> read && read == value)
      break;
  }
  return text;
}

}  // namespace object_modelling::base
