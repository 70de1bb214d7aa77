#include "refiner.h"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <utility>

#include "object_modelling/rgbd/corrected.h"
#include "object_modelling/rgbd/keyframe_view.h"

namespace object_modelling::pipeline
{
namespace
{
constexpr double WORSE_RATIO = 1.05;  // scores nearer than this are equal
constexpr char LIVE[] = "live";

/// The last, which is what was asked for, unless others fit better; those before it are simpler.
std::size_t bestOf(const std::vector<multi_view_icp::PoseScore>& scores)
{
  double least = scores.front().total();
  for (const multi_view_icp::PoseScore& score : scores)
    least = std::min(least, score.total());
  std::size_t best = scores.size() - 1;
  while (best > 0 && scores[best].total() > WORSE_RATIO * least)
    --best;
  return best;
}

std::string nameText(const std::string& by)
{
  if (by == LIVE)
    return "as tracked";
  if (by == nameOf(RefinementMethod::BOTH))
    return "of bundle adjustment and multi-view ICP";
  return by == nameOf(RefinementMethod::MULTI_VIEW_ICP) ? "of multi-view ICP alone" : "of bundle adjustment alone";
}

std::string choiceText(const SessionRefinement& refined)
{
  std::ostringstream text;
  text << std::setprecision(2) << "kept the poses " << nameText(refined.chosen)
       << ", which fit best (mean robust error of depth and grey levels over all pairs of keyframes:";
  for (std::size_t i = 0; i < refined.compared.size(); ++i)
    text << (i == 0 ? " " : ", ") << nameText(refined.compared[i].by) << " " << refined.compared[i].score.depth
         << " and " << refined.compared[i].score.gray;
  text << "); see that colour is registered to depth (docs/refinement.md)";
  return text.str();
}
}  // namespace

Refiner::Candidate Refiner::candidateOf(const std::string& by, multi_view_icp::PoseSet poses,
                                        std::vector<geometry::Matrix6d> covariance)
{
  covariance.resize(poses.T_world_camera.size(), geometry::Matrix6d::Zero());
  return { by, std::move(poses), std::move(covariance) };
}

Refiner::Refiner(RefinementOptions options, std::vector<rgbd::Keyframe> keyframes,
                 const Eigen::Vector2d& color_offset_px, base::JobControl& control)
    : options_(std::move(options)), keyframes_(std::move(keyframes)), control_(control)
{
  Candidate live;
  live.by = LIVE;
  live.poses.color_offset_px = color_offset_px;
  for (const rgbd::Keyframe& keyframe : keyframes_)
  {
    live.poses.T_world_camera.push_back(keyframe.T_session_camera);
    live.covariance.push_back(keyframe.covariance);
    refined_.keyframe_ids.push_back(keyframe.id);
  }
  candidates_ = { live };
}

SessionRefinement Refiner::run()
{
  if (options_.method != RefinementMethod::MULTI_VIEW_ICP)
    adjustBundle();
  if (options_.method != RefinementMethod::BUNDLE_ADJUSTMENT)
    alignSurfaces();
  choose();
  return std::move(refined_);
}

bool Refiner::corrected() const
{
  return refined_.bundle_adjustment && !refined_.bundle_adjustment->sensor.isIdentity();
}

void Refiner::place(const Candidate& candidate)
{
  for (std::size_t i = 0; i < keyframes_.size(); ++i)
  {
    keyframes_[i].T_session_camera = candidate.poses.T_world_camera[i];
    keyframes_[i].covariance = candidate.covariance[i];
  }
}

void Refiner::adjustBundle()
{
  refined_.bundle_adjustment = bundle_adjustment::adjustBundle(keyframes_, options_.bundle_adjustment, control_);
  refined_.status = refined_.bundle_adjustment->status;
  if (!refined_.status.ok())
    return;
  const bundle_adjustment::BundleAdjustmentResult& result = *refined_.bundle_adjustment;
  candidates_.push_back(candidateOf(nameOf(RefinementMethod::BUNDLE_ADJUSTMENT),
                                    { result.T_session_camera, result.color_offset_px }, result.covariance));
  place(candidates_.back());
  if (corrected())
    for (rgbd::Keyframe& keyframe : keyframes_)
      keyframe = rgbd::corrected(keyframe, result.sensor);
}

void Refiner::alignSurfaces()
{
  const bool adjusted = candidates_.size() > 1;
  multi_view_icp::MultiViewIcpOptions options = options_.multi_view_icp;
  if (adjusted)
    options.start_error_m = std::min(AFTER_BUNDLE_M, options.start_error_m);
  const Eigen::Vector2d color_offset_px = candidates_.back().poses.color_offset_px;
  multi_view_icp::MultiViewIcpResult result =
      multi_view_icp::refineByMultiViewIcp(rgbd::viewsOf(keyframes_, color_offset_px), options, control_);
  if (adjusted && !corrected() && drivesSurfacesApart())
    alignSurfacesAlone();
  if (result.status.ok())
    candidates_.push_back(candidateOf(nameOf(adjusted ? RefinementMethod::BOTH : RefinementMethod::MULTI_VIEW_ICP),
                                      { result.T_world_camera, color_offset_px }, result.covariance));
  if (!adjusted)
    refined_.status = result.status;
  refined_.multi_view_icp = std::move(result);
}

void Refiner::alignSurfacesAlone()
{
  place(candidates_.front());
  const Eigen::Vector2d color_offset_px = candidates_.front().poses.color_offset_px;
  alone_ = multi_view_icp::refineByMultiViewIcp(rgbd::viewsOf(keyframes_, color_offset_px), options_.multi_view_icp,
                                                control_);
  if (alone_->status.ok())
    candidates_.push_back(candidateOf(nameOf(RefinementMethod::MULTI_VIEW_ICP),
                                      { alone_->T_world_camera, color_offset_px }, alone_->covariance));
}

std::vector<multi_view_icp::PoseScore> Refiner::scores() const
{
  std::vector<multi_view_icp::PoseSet> sets;
  for (const Candidate& candidate : candidates_)
    sets.push_back(candidate.poses);
  multi_view_icp::PoseComparisonOptions options;
  options.object_only = objectOnly();
  return multi_view_icp::comparePoses(rgbd::viewsOf(keyframes_), sets, options, control_);
}

bool Refiner::drivesSurfacesApart() const
{
  const std::vector<multi_view_icp::PoseScore> both = scores();
  return both[1].depth > WORSE_RATIO * both[0].depth;
}

void Refiner::choose()
{
  std::size_t best = candidates_.size() - 1;
  if (candidates_.size() > 1 && !corrected())
  {
    const std::vector<multi_view_icp::PoseScore> judged = scores();
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      refined_.compared.push_back({ candidates_[i].by, judged[i] });
    best = bestOf(judged);
  }
  const Candidate& chosen = candidates_[best];
  place(chosen);
  refined_.chosen = chosen.by;
  refined_.T_session_camera = chosen.poses.T_world_camera;
  if (alone_ && chosen.by == nameOf(RefinementMethod::MULTI_VIEW_ICP))
    refined_.multi_view_icp = std::move(alone_);
  if (best + 1 < candidates_.size())
    refined_.status.message = choiceText(refined_);
}

}  // namespace object_modelling::pipeline
