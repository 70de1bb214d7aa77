#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/geometry/transform.h"

namespace object_modelling::keyframes
{
/// Numbers as text columns: readable in any SQL shell, the same on every backend, and exact (17 digits give back the
/// same double, whatever the process's locale). Separated by single spaces; nan, inf and -inf are kept.
std::string textFromNumbers(const double* values, std::size_t count);
/// Throws base::Error (BAD_INPUT) naming `what` if the text does not hold exactly `count` numbers.
std::vector<double> numbersFromText(const std::string& text, std::size_t count, const std::string& what);
/// However many numbers there are.
std::vector<double> numbersFromText(const std::string& text, const std::string& what);

/// 4x4, row by row.
std::string textFromTransform(const Eigen::Isometry3d& T_target_source);
Eigen::Isometry3d transformFromText(const std::string& text, const std::string& what);
/// 6x6, row by row.
std::string textFromCovariance(const geometry::Matrix6d& covariance);
geometry::Matrix6d covarianceFromText(const std::string& text, const std::string& what);

}  // namespace object_modelling::keyframes
