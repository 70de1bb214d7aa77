#include "link_tracks.h"

#include <map>
#include <utility>

namespace object_modelling::bundle_adjustment
{
namespace
{
/// A feature of a keyframe.
using Node = std::pair<int, int>;

class TrackBuilder
{
public:
  int node(const Node& key, const Sight& sight)
  {
    const auto [found, is_new] = index_.try_emplace(key, static_cast<int>(tracks_.size()));
    if (is_new)
    {
      parent_.push_back(found->second);
      tracks_.push_back({ { sight.keyframe, sight } });
    }
    return found->second;
  }

  void join(int a, int b)
  {
    a = root(a);
    b = root(b);
    if (a == b || contradict(tracks_[a], tracks_[b]))
      return;
    parent_[b] = a;
    tracks_[a].merge(tracks_[b]);
  }

  std::vector<SightGroup> groups() const
  {
    std::vector<SightGroup> result;
    for (std::size_t i = 0; i < tracks_.size(); ++i)
    {
      if (parent_[i] != static_cast<int>(i) || tracks_[i].size() < 2)
        continue;
      SightGroup group;
      for (const auto& [keyframe, sight] : tracks_[i])
        group.sights.push_back(sight);
      result.push_back(std::move(group));
    }
    return result;
  }

private:
  using Track = std::map<int, Sight>;  // by keyframe

  int root(int node)
  {
    while (parent_[node] != node)
    {
      parent_[node] = parent_[parent_[node]];
      node = parent_[node];
    }
    return node;
  }
  static bool contradict(const Track& a, const Track& b)
  {
    for (const auto& [keyframe, sight] : b)
      if (a.count(keyframe) > 0)
        return true;
    return false;
  }

  std::map<Node, int> index_;
  std::vector<int> parent_;
  std::vector<Track> tracks_;
};

Sight makeSight(int keyframe, const Eigen::Vector2d& pixel, double depth_m, double sigma_px)
{
  Sight sight;
  sight.keyframe = keyframe;
  sight.pixel = pixel;
  sight.depth_m = depth_m;
  sight.sigma_px = sigma_px;
  return sight;
}

}  // namespace

std::vector<SightGroup> linkedSights(const std::vector<VerifiedLink>& links, const std::vector<bool>& active)
{
  TrackBuilder tracks;
  for (std::size_t i = 0; i < links.size(); ++i)
  {
    if (!active[i])
      continue;
    for (const LinkedPoint& point : links[i].points)
    {
      const int a = tracks.node({ links[i].a, point.feature_a },
                                makeSight(links[i].a, point.pixel_a, point.depth_a_m, point.sigma_a_px));
      const int b = tracks.node({ links[i].b, point.feature_b },
                                makeSight(links[i].b, point.pixel_b, point.depth_b_m, point.sigma_b_px));
      tracks.join(a, b);
    }
  }
  return tracks.groups();
}

}  // namespace object_modelling::bundle_adjustment
