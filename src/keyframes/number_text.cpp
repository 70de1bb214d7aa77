#include "number_text.h"

#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

#include "object_modelling/base/status.h"

namespace object_modelling::keyframes
{
namespace
{
template <int N>
using RowMajor = Eigen::Matrix<double, N, N, Eigen::RowMajor>;

double numberFromToken(const std::string& token, const std::string& what)
{
  if (token == "nan" || token == "-nan")
    return std::numeric_limits<double>::quiet_NaN();
  if (token == "inf" || token == "-inf")
    return (token[0] == '-' ? -1 : 1) * std::numeric_limits<double>::infinity();
  std::istringstream in(token);
  in.imbue(std::locale::classic());
  double value = 0;
  if (!(in >> value) || in.peek() != std::char_traits<char>::eof())
    throw base::Error(base::StatusCode::BAD_INPUT, what + ": '" + token + "' is not a number");
  return value;
}
}  // namespace

std::string textFromNumbers(const double* values, std::size_t count)
{
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  for (std::size_t i = 0; i < count; ++i)
    out << (i == 0 ? "" : " ") << values[i];
  return out.str();
}

std::vector<double> numbersFromText(const std::string& text, const std::string& what)
{
  std::vector<double> values;
  std::istringstream in(text);
  for (std::string token; in >> token;)
    values.push_back(numberFromToken(token, what));
  return values;
}

std::vector<double> numbersFromText(const std::string& text, std::size_t count, const std::string& what)
{
  std::vector<double> values = numbersFromText(text, what);
  if (values.size() != count)
    throw base::Error(base::StatusCode::BAD_INPUT,
                      what + ": " + std::to_string(values.size()) + " numbers instead of " + std::to_string(count));
  return values;
}

std::string textFromTransform(const Eigen::Isometry3d& T_target_source)
{
  const RowMajor<4> rows = T_target_source.matrix();
  return textFromNumbers(rows.data(), 16);
}

Eigen::Isometry3d transformFromText(const std::string& text, const std::string& what)
{
  const std::vector<double> values = numbersFromText(text, 16, what);
  Eigen::Isometry3d T;
  T.matrix() = Eigen::Map<const RowMajor<4>>(values.data());
  return T;
}

std::string textFromCovariance(const geometry::Matrix6d& covariance)
{
  const RowMajor<6> rows = covariance;
  return textFromNumbers(rows.data(), 36);
}

geometry::Matrix6d covarianceFromText(const std::string& text, const std::string& what)
{
  const std::vector<double> values = numbersFromText(text, 36, what);
  return Eigen::Map<const RowMajor<6>>(values.data());
}

}  // namespace object_modelling::keyframes
