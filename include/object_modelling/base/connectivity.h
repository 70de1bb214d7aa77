#pragma once

#include <vector>

#include <Eigen/Core>

namespace object_modelling::base
{
/// The sets of keyframes that are connected by pairs sharing at least `min_shared` landmarks, each ascending, ordered
/// by their lowest index.
std::vector<std::vector<int>> components(const Eigen::MatrixXi& shared, int min_shared);

/// The largest set of keyframes that are connected by pairs sharing at least `min_shared` landmarks (of equal ones,
/// that with the lowest index), ascending; empty without keyframes.
std::vector<int> largestComponent(const Eigen::MatrixXi& shared, int min_shared);

}  // namespace object_modelling::base
