#pragma once

#include "icp_driver.h"

namespace object_modelling::multi_view_icp
{
/// `problem`: matched at the outcome.
MultiViewIcpResult reportOf(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options,
                            const IcpProblem& problem, const IcpOutcome& outcome);

}  // namespace object_modelling::multi_view_icp
