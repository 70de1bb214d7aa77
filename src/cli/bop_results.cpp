#include "bop_results.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace object_modelling::cli
{
namespace
{
constexpr std::size_t MAX_DIGITS = 9;  // of an int
constexpr int NO_NUMBER = -1;

/// The digits that a name begins with, or NO_NUMBER.
int leadingNumber(const std::string& name)
{
  const auto end = std::find_if(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) == 0; });
  const std::string digits(name.begin(), end);
  return digits.empty() || digits.size() > MAX_DIGITS ? NO_NUMBER : std::stoi(digits);
}
}  // namespace

std::vector<int> uniqueNumbers(const std::vector<std::string>& names)
{
  std::multiset<int> own;
  for (const std::string& name : names)
    own.insert(leadingNumber(name));
  std::vector<int> numbers;
  int next = 1;
  for (const std::string& name : names)
  {
    int number = leadingNumber(name);
    if (number == NO_NUMBER || own.count(number) > 1)
    {
      while (own.count(next) > 0)
        ++next;
      number = next++;
    }
    numbers.push_back(number);
  }
  return numbers;
}

bool isOwnNumber(const std::string& name, int number)
{
  return leadingNumber(name) == number;
}

void writeBopHeader(std::ostream& out)
{
  out << "scene_id,im_id,obj_id,score,R,t,time\n";
}

void writeBopRow(std::ostream& out, const BopImage& image, int object, const recognition::Detection& detection)
{
  out << image.scene << "," << image.image << "," << object << "," << detection.confidence_ratio << ",";
  for (int i = 0; i < 9; ++i)
    out << (i > 0 ? " " : "") << detection.T_camera_model.linear()(i / 3, i % 3);
  const Eigen::Vector3d t_mm = 1000 * detection.T_camera_model.translation();
  out << "," << t_mm.x() << " " << t_mm.y() << " " << t_mm.z() << "," << image.seconds << "\n";
}

}  // namespace object_modelling::cli
