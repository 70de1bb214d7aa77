#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "object_modelling/recognition/recogniser.h"

namespace object_modelling::cli
{
/// A number for each of these different names, no two alike: the digits that a name begins with, unless they are
/// another's too; the others get the smallest numbers from 1 on that no name begins with.
std::vector<int> uniqueNumbers(const std::vector<std::string>& names);

/// Whether a name begins with this number.
bool isOwnNumber(const std::string& name, int number);

/// What a row of the results is of.
struct BopImage
{
  int scene = 0, image = 0;
  double seconds = 0;
};

/// The first line of a file of results as the BOP benchmark has them, and a row for one detection (mm).
void writeBopHeader(std::ostream& out);
void writeBopRow(std::ostream& out, const BopImage& image, int object, const recognition::Detection& detection);

}  // namespace object_modelling::cli
