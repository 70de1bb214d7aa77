#include "alignment_review.h"

#include <algorithm>

#include "alignment_message.h"
#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace
{
constexpr std::size_t PAIRS_TO_CLICK = 3;

std::vector<alignment::PointPair> pairsOf(const AlignByPoints::Request& request)
{
  if (request.points_a.size() != request.points_b.size())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      std::to_string(request.points_a.size()) + " points of one session and " +
                          std::to_string(request.points_b.size()) + " of the other: give the same spots of both");
  const auto vector = [](const geometry_msgs::Point& p) { return Eigen::Vector3d(p.x, p.y, p.z); };
  std::vector<alignment::PointPair> pairs;
  for (std::size_t i = 0; i < request.points_a.size(); ++i)
    pairs.push_back({ vector(request.points_a[i]), vector(request.points_b[i]) });
  return pairs;
}

bool isOf(const alignment::AlignmentEdge& edge, const AlignmentScene& scene)
{
  const std::string &a = scene.a().session_id, &b = scene.b().session_id;
  return (edge.session_a == a && edge.session_b == b) || (edge.session_a == b && edge.session_b == a);
}

/// Points of one part, in the order in which they were clicked.
std::vector<Eigen::Vector3d> clickedOn(bool in_a, const std::vector<AlignmentScene::Spot>& clicks)
{
  std::vector<Eigen::Vector3d> points;
  for (const AlignmentScene::Spot& spot : clicks)
    if (spot.in_a == in_a)
      points.push_back(spot.p_session);
  return points;
}
}  // namespace

template <typename Service>
void AlignmentReview::serve(ros::NodeHandle& node, const std::string& name,
                            void (AlignmentReview::*handler)(const typename Service::Request&,
                                                             typename Service::Response&))
{
  using Callback = boost::function<bool(typename Service::Request&, typename Service::Response&)>;
  servers_.push_back(node.advertiseService(
      name, Callback(
                [this, handler](typename Service::Request& request, typename Service::Response& response)
                {
                  return ros_bridge::answer(response,
                                            [&]
                                            {
                                              const std::lock_guard<std::mutex> lock(mutex_);
                                              (this->*handler)(request, response);
                                            });
                })));
}

AlignmentReview::AlignmentReview(ros::NodeHandle& node, ros::NodeHandle& private_node,
                                 ros_bridge::RemoteSessionStore& store, const SessionAlignerOptions& options)
    : options_(options), store_(store), display_(private_node, options.display_frame_id)
{
  serve<AcceptAlignment>(private_node, "accept", &AlignmentReview::accept);
  serve<RefuseAlignment>(private_node, "refuse", &AlignmentReview::refuse);
  serve<ForgetAlignment>(private_node, "forget", &AlignmentReview::forget);
  serve<AlignByPoints>(private_node, "align_by_points", &AlignmentReview::alignByPoints);
  serve<ShowAlignment>(private_node, "show", &AlignmentReview::showPair);
  clicked_point_ = node.subscribe("/clicked_point", 10, &AlignmentReview::onClickedPoint, this);
}

void AlignmentReview::show(const std::vector<alignment::AlignmentEdge>& edges,
                           std::vector<registration::PartialModel> parts)
{
  if (edges.empty())
    return;
  const auto refused =
      std::find_if(edges.begin(), edges.end(), [](const alignment::AlignmentEdge& edge) { return !edge.accepted; });
  const alignment::AlignmentEdge& edge = refused == edges.end() ? edges.front() : *refused;
  const std::lock_guard<std::mutex> lock(mutex_);
  parts_.clear();
  for (registration::PartialModel& part : parts)
    if (part.session_id == edge.session_a || part.session_id == edge.session_b)
      parts_.push_back(std::make_shared<const registration::PartialModel>(std::move(part)));
  display(edge);
}

AlignmentScene::PartPointer AlignmentReview::part(const std::string& session_id)
{
  for (const AlignmentScene::PartPointer& part : parts_)
    if (part->session_id == session_id)
      return part;
  base::JobControl control;
  std::vector<registration::PartialModel> loaded =
      pipeline::loadParts(store_, { session_id }, options_.align.part, control);
  parts_.push_back(std::make_shared<const registration::PartialModel>(std::move(loaded.front())));
  return parts_.back();
}

void AlignmentReview::display(const alignment::AlignmentEdge& edge)
{
  scene_.emplace(part(edge.session_a), part(edge.session_b), edge);
  parts_ = { part(edge.session_a), part(edge.session_b) };  // of others no longer
  clicks_.clear();
  display_.show(*scene_);
}

void AlignmentReview::refreshIfShown(const alignment::AlignmentEdge& edge)
{
  if (scene_ && isOf(edge, *scene_))
    display(edge);
}

void AlignmentReview::accept(const AcceptAlignment::Request& request, AcceptAlignment::Response& response)
{
  const alignment::AlignmentEdge edge =
      pipeline::acceptAlignment(store_, request.session_a, request.session_b, request.candidate);
  response.edge = toMessage(edge);
  refreshIfShown(edge);
}

void AlignmentReview::refuse(const RefuseAlignment::Request& request, RefuseAlignment::Response& response)
{
  const alignment::AlignmentEdge edge = pipeline::refuseAlignment(store_, request.session_a, request.session_b);
  response.edge = toMessage(edge);
  refreshIfShown(edge);
}

void AlignmentReview::forget(const ForgetAlignment::Request& request, ForgetAlignment::Response&)
{
  pipeline::forgetAlignment(store_, request.session_a, request.session_b);
  refreshIfShown(pipeline::knownAlignment(store_, request.session_a, request.session_b));
}

void AlignmentReview::alignByPoints(const AlignByPoints::Request& request, AlignByPoints::Response& response)
{
  const std::vector<alignment::PointPair> pairs = pairsOf(request);
  base::JobControl control;
  parts_.clear();  // what a person measured points in is what the store has now
  const AlignmentScene::PartPointer a = part(request.session_a), b = part(request.session_b);
  const alignment::AlignmentEdge edge = pipeline::acceptByPoints(store_, *a, *b, pairs, options_.align, control);
  response.edge = toMessage(edge);
  display(edge);
}

void AlignmentReview::showPair(const ShowAlignment::Request& request, ShowAlignment::Response& response)
{
  const alignment::AlignmentEdge edge = pipeline::knownAlignment(store_, request.session_a, request.session_b);
  parts_.clear();
  display(edge);
  response.edge = toMessage(edge);
}

void AlignmentReview::onClickedPoint(const geometry_msgs::PointStampedConstPtr& point)
{
  if (point->header.frame_id != display_.frameId())
    return;  // somebody else's
  const base::Status status = ros_bridge::guarded(
      [&]
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!scene_)
          return;
        const Eigen::Vector3d p(point->point.x, point->point.y, point->point.z);
        if (const std::optional<AlignmentScene::Spot> spot = scene_->spotAt(p))
          click(*spot);
        else
          display_.showClicks(*scene_, clicks_,
                              { scene_->noticePosition(), "nothing there: click on one of the two in front",
                                AlignmentScene::Tone::BAD });
      });
  if (!status.ok())
    ROS_WARN("clicked point: %s", status.message.c_str());
}

void AlignmentReview::click(const AlignmentScene::Spot& spot)
{
  if (clickedOn(spot.in_a, clicks_).size() < PAIRS_TO_CLICK)
    clicks_.push_back(spot);
  const std::vector<Eigen::Vector3d> of_a = clickedOn(true, clicks_), of_b = clickedOn(false, clicks_);
  if (of_a.size() < PAIRS_TO_CLICK || of_b.size() < PAIRS_TO_CLICK)
  {
    const std::string notice = scene_->a().session_id + " " + std::to_string(of_a.size()) + " of 3, " +
                               scene_->b().session_id + " " + std::to_string(of_b.size()) + " of 3";
    display_.showClicks(*scene_, clicks_, { scene_->noticePosition(), notice });
    return;
  }
  std::vector<alignment::PointPair> pairs;
  for (std::size_t i = 0; i < of_a.size(); ++i)
    pairs.push_back({ of_a[i], of_b[i] });
  clicks_.clear();
  try
  {
    base::JobControl control;
    display(pipeline::acceptByPoints(store_, scene_->a(), scene_->b(), pairs, options_.align, control));
  }
  catch (const base::Error& error)
  {
    display_.showClicks(*scene_, clicks_, { scene_->noticePosition(), error.what(), AlignmentScene::Tone::BAD });
    throw;
  }
}

}  // namespace object_modelling::nodes
