#include "model_match.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <optional>
#include <sstream>
#include <utility>

#include <glog/logging.h>

#include "object_modelling/alignment/session_part.h"
#include "object_modelling/base/statistics.h"
#include "object_modelling/database/cloud_file.h"
#include "object_modelling/database/view_files.h"
#include "object_modelling/geometry/point_index.h"

namespace object_modelling::pipeline
{
namespace
{
constexpr double MAX_DIAMETER_RATIO = 1.15;  // of two models of one object: what one did not see makes it smaller
constexpr double MAX_BOX_EDGE_RATIO = 1.25, MAX_BOX_EDGE_M = 0.01;  // of their boxes; either
// Deviation of the colours of a surface without texture to speak of; correlation of colours or of their slopes on one
// object, whatever the light: right poses have 0.8 and more, other prints of a shape up to 0.2.
constexpr double PLAIN_SURFACE = 0.05, MIN_TEXTURE_AGREEMENT = 0.4;
constexpr double MAX_SPACING_M = 0.02;
constexpr std::size_t MOST_COMPARED = 6;  // of a database of things that are all alike in size

// What is short of the limit does not look like it.
double roundedDown(double probability)
{
  return std::floor(100 * probability) / 100;
}

std::string figuresOf(const registration::PairQuality& quality)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "probability " << roundedDown(quality.probability)
       << std::setprecision(0) << ", " << 100 * quality.overlap_ratio << " % of the surface in common, "
       << 100 * quality.fsv_ratio << " % where the other was seen to have nothing, surfaces " << std::setprecision(1)
       << 1000 * quality.rmse_m << " mm apart" << (texturesDiffer(quality) ? ", but the textures differ" : "");
  return text.str();
}
std::string uncertain(const ModelMatch& match)
{
  std::ostringstream text;
  text << "the stored one (" << match.figures << "; a probability of at least "
       << alignment::PairAlignmentOptions().min_probability << " is needed)";
  return text.str();
}

Eigen::Vector3d sorted(Eigen::Vector3d size_m)
{
  std::sort(size_m.data(), size_m.data() + 3);
  return size_m;
}

/// Ratio of the larger diameter to the smaller; none where two objects are too different in size to be one.
std::optional<double> sizeRatio(const database::ObjectEntry& entry, const Eigen::Vector3d& size_m, double diameter_m)
{
  const double ratio = std::max(entry.diameter_m, diameter_m) / std::min(entry.diameter_m, diameter_m);
  if (!(ratio <= MAX_DIAMETER_RATIO))
    return std::nullopt;
  const Eigen::Vector3d a = sorted(entry.size_m), b = sorted(size_m);
  for (int i = 0; i < 3; ++i)
    if (std::abs(a[i] - b[i]) > MAX_BOX_EDGE_M && std::max(a[i], b[i]) > MAX_BOX_EDGE_RATIO * std::min(a[i], b[i]))
      return std::nullopt;
  return ratio;
}

std::vector<database::ObjectEntry> ofSimilarSize(const database::ObjectDatabase& database, const std::string& object_id,
                                                 const Eigen::Vector3d& size_m, double diameter_m)
{
  std::vector<std::pair<double, database::ObjectEntry>> found;
  for (database::ObjectEntry& entry : database.list())
    if (const std::optional<double> ratio = sizeRatio(entry, size_m, diameter_m); ratio && entry.id != object_id)
      found.emplace_back(*ratio, std::move(entry));
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<database::ObjectEntry> entries;
  for (std::size_t i = 0; i < std::min(found.size(), MOST_COMPARED); ++i)
    entries.push_back(std::move(found[i].second));
  return entries;
}

/// As for a session, or as wide as the cloud is: closer points would have no neighbours that slopes of colours are of.
alignment::PartialModelOptions partOptions(const fusion::FusedCloud& cloud)
{
  constexpr std::size_t SAMPLES = 500, NEIGHBORS = 4;  // itself, and those that are next to it on a grid
  alignment::PartialModelOptions options;
  if (cloud.size() < NEIGHBORS)
    return options;
  const geometry::PointIndex index(cloud.points);
  std::vector<float> squared_m2;
  std::vector<geometry::PointIndex::Neighbor> nearest;
  for (std::size_t i = 0; i < cloud.size(); i += 1 + cloud.size() / SAMPLES)
  {
    index.nearest(cloud.points[i], NEIGHBORS, &nearest);
    squared_m2.push_back(nearest.back().squared_distance);
  }
  options.spacing_m =
      std::clamp(std::sqrt(static_cast<double>(base::median(&squared_m2))), options.spacing_m, MAX_SPACING_M);
  return options;
}
}  // namespace

registration::PartialModel partOfModel(const std::string& id, const fusion::FusedCloud& cloud,
                                       const std::vector<rgbd::View>& views)
{
  return alignment::partOf(id, cloud, views, partOptions(cloud));
}

registration::PartialModel partOfStored(const database::ObjectDatabase& database, const database::ObjectEntry& entry)
{
  const std::string folder = database.root() + "/" + entry.id;
  const fusion::FusedCloud cloud = database::readCloud(folder + "/cloud.pcd");
  const alignment::PartialModelOptions options = partOptions(cloud);
  return alignment::partOf(entry.id, cloud, database::readViews(folder, static_cast<std::size_t>(options.max_views)),
                           options);
}

bool texturesDiffer(const registration::PairQuality& quality)
{
  return quality.texture > PLAIN_SURFACE &&
         std::max(quality.color_agreement, quality.edge_agreement) < MIN_TEXTURE_AGREEMENT;
}

ModelMatch matchModels(const registration::PartialModel& stored, const registration::PartialModel& model,
                       base::JobControl& control)
{
  const alignment::PairAlignment aligned = alignment::alignPair(stored, model, {}, control);
  ModelMatch match;
  if (aligned.candidates.empty())
  {
    match.figures = "probability 0: no pose brings the two together";
    return match;
  }
  const alignment::PairCandidate& best = aligned.candidates.front();
  match.accepted = aligned.accepted && !texturesDiffer(best.quality);
  match.probability = best.quality.probability;
  match.T_stored_model = best.T_a_b;
  match.figures = figuresOf(best.quality);
  return match;
}

ModelMatch matchExisting(const database::ObjectDatabase& database, const database::ObjectEntry& existing,
                         const fusion::FusedCloud& cloud, const std::vector<rgbd::View>& views,
                         base::JobControl& control)
{
  try
  {
    return matchModels(partOfStored(database, existing), partOfModel(existing.id, cloud, views), control);
  }
  catch (const base::Cancelled&)
  {
    throw;
  }
  catch (const base::Error& error)
  {
    ModelMatch none;
    none.figures = error.what();
    return none;
  }
}

std::string frameWouldChange(const std::string& object_id, const ModelMatch& match)
{
  return "object '" + object_id +
         "' exists and was built from other sessions, and it is not certain how the new model lies to " +
         uncertain(match) +
         ": its frame, and with it the grasps annotated in it, would change. The stored object stays as it is. Record "
         "again so that more of what the stored model shows is seen, or build from its old sessions and the new ones "
         "together; if this is another object, choose another id; or build with replace, which begins a new frame";
}

std::string frameHasChanged(const std::string& object_id, int frame_version, const ModelMatch& match)
{
  return "NEW FRAME: object '" + object_id + "' is replaced, though it is not certain how the new model lies to " +
         uncertain(match) + ": its frame is now version " + std::to_string(frame_version) +
         ", and grasps annotated in an older one do not hold any more; annotate them anew, or check that this is the "
         "same object";
}

SimilarObjects similarObjects(const database::ObjectDatabase& database, const database::ObjectModel& model,
                              const fusion::FusedCloud& cloud_model, base::JobControl& control)
{
  SimilarObjects similar;
  const std::vector<database::ObjectEntry> entries =
      ofSimilarSize(database, model.id, model.box_model.size_m, model.diameter_m);
  if (entries.empty())
    return similar;
  similar.compared_count = entries.size();
  control.report("compare with '" + entries.front().id + "'", 0, entries.size());
  const registration::PartialModel part = partOfModel(model.id, cloud_model, model.views);
  for (std::size_t i = 0; i < entries.size(); ++i)
  {
    control.report("compare with '" + entries[i].id + "'", i, entries.size());
    try
    {
      const ModelMatch match = matchModels(partOfStored(database, entries[i]), part, control);
      if (match.accepted)
        similar.found.push_back({ entries[i].id, match.probability });
    }
    catch (const base::Cancelled&)
    {
      throw;
    }
    catch (const base::Error& error)
    {
      LOG(WARNING) << "not compared with object '" << entries[i].id << "': " << error.what();
    }
    control.report("compare with '" + entries[i].id + "'", i + 1, entries.size());
  }
  std::stable_sort(similar.found.begin(), similar.found.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  return similar;
}

std::string looksLikeText(const std::vector<report::SimilarObject>& similar, const std::string& object_id,
                          const std::string& database_root)
{
  if (similar.empty())
    return {};
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "'" << object_id << "' looks like";
  for (const report::SimilarObject& other : similar)
    text << (&other == &similar.front() ? " '" : ", '") << other.object_id << "' (probability "
         << roundedDown(other.probability) << ")";
  text << ": if they are one object, 'object_modelling merge " << database_root << " " << similar.front().object_id
       << " " << object_id << "' makes one of both";
  return text.str();
}

}  // namespace object_modelling::pipeline
