#pragma once

#include <vector>

#include <Eigen/Core>

namespace object_modelling::refinement
{
/// The largest set of keyframes that are connected by pairs sharing at least `min_shared` landmarks (of equal ones,
/// that with the lowest index), ascending.
std::vector<int> largestComponent(const Eigen::MatrixXi& shared, int min_shared);

}  // namespace object_modelling::refinement
