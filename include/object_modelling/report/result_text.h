#pragma once

#include <string>

#include "object_modelling/alignment/session_alignment.h"
#include "object_modelling/bundle_adjustment/bundle_adjustment.h"
#include "object_modelling/multi_view_icp/multi_view_icp.h"

// What the methods found, for people: lines that begin with a word of ten columns.
namespace object_modelling::report
{
std::string toText(const bundle_adjustment::BundleAdjustmentResult& result);
std::string toText(const multi_view_icp::MultiViewIcpResult& result);
std::string toText(const alignment::AlignmentResult& result);

}  // namespace object_modelling::report
