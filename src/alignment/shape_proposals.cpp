#include <cmath>

#include "proposals.h"

namespace object_modelling::alignment
{
std::vector<Proposal> proposeByShape(const registration::MatchedSurface& a, const registration::MatchedSurface& b,
                                     int rotations)
{
  constexpr double PHI = 1.4142135623730951, PSI = 1.533751168755204288118041;
  std::vector<Proposal> proposals(rotations);
  for (int i = 0; i < rotations; ++i)
  {
    const double s = i + 0.5, t = s / rotations;
    const double inner = std::sqrt(t), outer = std::sqrt(1 - t);
    const double alpha = 2 * M_PI * s / PHI, beta = 2 * M_PI * s / PSI;
    const Eigen::Quaterniond R(outer * std::cos(beta), inner * std::sin(alpha), inner * std::cos(alpha),
                               outer * std::sin(beta));
    Eigen::Isometry3f& T = proposals[i].T_a_b;
    T.linear() = R.normalized().toRotationMatrix().cast<float>();
    T.translation() = a.center - T.linear() * b.center;
  }
  return proposals;
}

}  // namespace object_modelling::alignment
