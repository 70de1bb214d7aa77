#include "object_modelling/bundle_adjustment/keyframe_linker.h"

#include <algorithm>
#include <optional>

#include "in_batches.h"
#include "link_verification.h"
#include "object_modelling/base/options.h"
#include "object_modelling/bundle_adjustment/pair_selection.h"
#include "object_modelling/features/keyframe_features.h"

namespace object_modelling::bundle_adjustment
{
std::vector<std::string> KeyframeLinkerOptions::violations() const
{
  base::OptionsCheck check("keyframe_linker");
  check.inRange("max_features", max_features, 50, 20000);
  check.inRange("max_match_ratio", max_match_ratio, 0.1, 1.0);
  check.positive("sigma_px", sigma_px);
  check.atLeast("min_inliers", min_inliers, 4);
  check.inRange("max_view_angle_rad", max_view_angle_rad, 0.0, 3.2);
  check.inRange("min_overlap_ratio", min_overlap_ratio, 0.0, 1.0);
  check.atLeast("max_partners", max_partners, 1);
  check.atLeast("appearance_limit", appearance_limit, 0);
  check.inRange("max_violation_ratio", max_violation_ratio, 0.0, 1.0);
  return check.violations();
}

std::vector<VerifiedLink> linkKeyframes(const std::vector<rgbd::Keyframe>& keyframes, const Eigen::MatrixXi& shared,
                                        int enough_shared, const KeyframeLinkerOptions& options,
                                        base::JobControl& control)
{
  base::checked(options);
  std::vector<features::KeyframeFeatures> features(keyframes.size());
  inBatches("keyframe features", static_cast<int>(keyframes.size()), control,
            [&](int k)
            { features[k] = features::detectFeatures(keyframes[k].frame, options.max_features, options.object_only); });
  const std::vector<IndexPair> pairs = selectPairs(keyframes, features, shared, enough_shared, options);
  std::vector<std::optional<VerifiedLink>> verified(pairs.size());
  inBatches("keyframe links", static_cast<int>(pairs.size()), control,
            [&](int i) { verified[i] = verifyLink(keyframes, features, pairs[i].first, pairs[i].second, options); });
  std::vector<VerifiedLink> links;
  for (std::optional<VerifiedLink>& link : verified)
    if (link)
      links.push_back(std::move(*link));
  return links;
}

}  // namespace object_modelling::bundle_adjustment
