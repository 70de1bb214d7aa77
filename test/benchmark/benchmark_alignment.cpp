// Aligns the sessions of simulated sequences pair by pair, and prints what was found against the truth.
// benchmark_alignment --help; docs/alignment.md.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <sstream>

#include <CLI/CLI.hpp>

#include "alignment_growth.h"
#include "alignment_report.h"
#include "alignment_sessions.h"
#include "alignment_together.h"
#include "benchmark_program.h"
#include "object_modelling/alignment/alignment_by_points.h"
#include "object_modelling/alignment/pair_evidence.h"
#include "object_modelling/alignment/session_part.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/evaluation/comparison_files.h"
#include "object_modelling/rgbd/noise_model_file.h"

namespace
{
using namespace object_modelling;
using namespace object_modelling::benchmark_alignment;

struct Arguments
{
  std::vector<std::string> folders;
  std::string cache, json, parts;
  bool gray = false, cross = false, growth = false;
  std::size_t together = 0;  ///< sessions of an object that are aligned together, at least; 0: pair by pair
  int arcs = 0;              ///< parts of each session, of a run of its keyframes each; 0: one of all
  std::uint64_t seed = 1;
  std::size_t max_cross = 0;  ///< 0: all
  rgbd::SensorNoiseModel noise_model;
  alignment::PartialModelOptions part;
  alignment::PairAlignmentOptions pair;
};

double secondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The true surfaces of the objects, each made once.
class Surfaces
{
public:
  const mesh::ReferenceSurface& of(const SessionTruth& truth)
  {
    std::unique_ptr<mesh::ReferenceSurface>& surface = surfaces_[truth.object];
    if (!surface)
      surface = std::make_unique<mesh::ReferenceSurface>(evaluation::readGeometry(truth.mesh));
    return *surface;
  }

private:
  std::map<std::string, std::unique_ptr<mesh::ReferenceSurface>> surfaces_;
};

/// Leaves a run of a third of the keyframes to all of them, as if the walk round the object had been shorter.
void keepArc(std::uint64_t seed, const std::string& id, std::vector<rgbd::Keyframe>* keyframes)
{
  std::seed_seq seeds(id.begin(), id.end());
  std::vector<std::uint32_t> from_id(1);
  seeds.generate(from_id.begin(), from_id.end());
  std::mt19937_64 random(seed + from_id[0]);
  const auto all = static_cast<double>(keyframes->size());
  const double length = all * std::uniform_real_distribution<>(1.0 / 3, 1)(random);
  const double begin = std::uniform_real_distribution<>(0, all - length)(random);
  std::vector<rgbd::Keyframe> kept(keyframes->begin() + std::lround(begin),
                                   keyframes->begin() + std::lround(begin + length));
  keyframes->swap(kept);
}

/// Points, normals and colours as a PLY file, for looking at what was aligned.
void writePart(const std::string& folder, const registration::PartialModel& part)
{
  std::string name = part.session_id;
  std::replace(name.begin(), name.end(), '/', '_');
  std::ostringstream out;
  out << "ply\nformat ascii 1.0\nelement vertex " << part.points.size();
  for (const char* property : { "float x", "float y", "float z", "float nx", "float ny", "float nz", "uchar red",
                                "uchar green", "uchar blue" })
    out << "\nproperty " << property;
  out << "\nend_header\n";
  const Eigen::IOFormat row(6, Eigen::DontAlignCols, " ", " ");
  for (std::size_t i = 0; i < part.points.size(); ++i)
    out << part.points[i].transpose().format(row) << " " << part.normals[i].transpose().format(row) << " "
        << part.colors_rgb[i].cast<int>().transpose().format(row) << "\n";
  base::writeTextFile(folder + "/" + name + ".ply", out.str());
}

/// One that fails is left out with the reason, so that hours of work on the others are not lost.
SessionRow prepareSession(const std::string& folder, int arc, const Arguments& arguments, Surfaces* surfaces)
{
  SessionRow row;
  row.id = sessionIdOf(folder);
  row.session = row.id;
  row.folder = folder;
  if (arguments.arcs > 0)
    row.id += "/" + std::to_string(arc);
  try
  {
    StoredSession stored = storedSession(folder, arguments.cache, arguments.noise_model);
    row.made_s = stored.made_s;
    row.truth = sessionTruth(folder, objectFolderOf(folder), stored.keyframes);
    if (arguments.arcs > 0)
      keepArc(arguments.seed, row.id, &stored.keyframes);
    row.keyframes = stored.keyframes.size();
    stored.session.id = row.id;
    base::JobControl control;
    const auto start = std::chrono::steady_clock::now();
    row.part = alignment::makePartialModel(stored.session, stored.keyframes, arguments.part, control);
    row.part_s = secondsSince(start);
    if (!arguments.parts.empty())
      writePart(arguments.parts, row.part);
    row.mesh_distance_mm =
        meshDistance_mm(row.part.points, row.truth.T_session_object.inverse(), surfaces->of(row.truth));
  }
  catch (const base::Error& error)
  {
    row.problem = error.what();
  }
  std::cerr << std::fixed << std::setprecision(2) << row.id << ": ";
  if (!row.problem.empty())
    std::cerr << "left out: " << row.problem << std::endl;
  else
    std::cerr << row.keyframes << " keyframes "
              << (row.made_s > 0 ? "made in " + std::to_string(static_cast<int>(row.made_s)) + " s" : "read") << ", "
              << row.part.points.size() << " points in " << row.part_s << " s, truth fits to "
              << row.truth.camera_rmse_mm << " mm" << std::endl;
  return row;
}

/// Tells what the search missed from what the measure did not recognise.
void refineTruth(const SessionRow& a, const SessionRow& b, const Arguments& arguments, Surfaces* surfaces, PairRow* row)
{
  const Eigen::Vector3d center = b.part.center().cast<double>();
  std::vector<alignment::PointPair> same;
  for (const Eigen::Vector3d& off :
       { Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.1, 0, 0), Eigen::Vector3d(0, 0.1, 0) })
    same.push_back({ row->T_a_b_true * (center + off), center + off });
  base::JobControl control;
  row->from_truth = alignment::alignByPoints(a.part, b.part, same, arguments.pair, control);
  row->from_truth_errors = errorsOf(row->from_truth->T_a_b, b.part, a.truth, b.truth, surfaces->of(a.truth));
}

/// Features to which the probability that a rival makes the same object is fitted.
std::vector<std::optional<alignment::DifferenceFeatures>> differencesFromFirst(
    const registration::PartialModel& part_a, const registration::PartialModel& part_b,
    const std::vector<alignment::PairCandidate>& candidates, const alignment::PairAlignmentOptions& options)
{
  const registration::MatchedSurface a(part_a, options.threads), b(part_b, options.threads);
  std::vector<std::optional<alignment::DifferenceFeatures>> result(candidates.size());
  const auto log_odds = [&](std::size_t i)
  { return alignment::logOdds(candidates[i].quality, options.same_pose_probability); };
  if (candidates.empty())
    return result;
  const alignment::PoseComparison comparison(a, b, candidates[0].T_a_b.cast<float>());
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (const double gap = log_odds(0) - log_odds(i); gap < alignment::MAX_RIVALRY)
      result[i] = alignment::featuresOf(comparison.differenceOf(candidates[i].T_a_b.cast<float>()), gap);
  return result;
}

PairRow alignPairOf(const SessionRow& a, const SessionRow& b, const Arguments& arguments, Surfaces* surfaces)
{
  PairRow row;
  row.a = a.id;
  row.b = b.id;
  row.same_pose_probability = arguments.pair.same_pose_probability;
  row.same_object = a.truth.object == b.truth.object;
  base::JobControl control;
  const auto start = std::chrono::steady_clock::now();
  row.result = alignment::alignPair(a.part, b.part, arguments.pair, control);
  row.seconds = secondsSince(start);
  row.right.assign(row.result.candidates.size(), false);
  if (!row.same_object)
    return row;
  row.T_a_b_true = a.truth.T_session_object * b.truth.T_session_object.inverse();
  row.true_overlap = trueOverlap(a.part, b.part, row.T_a_b_true);
  row.true_turn_rad = trueTurn_rad(a.part, b.part, row.T_a_b_true);
  for (std::size_t i = 0; i < row.result.candidates.size(); ++i)
  {
    row.errors.push_back(errorsOf(row.result.candidates[i].T_a_b, b.part, a.truth, b.truth, surfaces->of(a.truth)));
    row.right[i] = isRight(row.errors.back(), arguments.gray);
  }
  refineTruth(a, b, arguments, surfaces, &row);
  row.differences = differencesFromFirst(a.part, b.part, row.result.candidates, arguments.pair);
  return row;
}

/// First those of the same object, then, if asked for, the others. Parts of one session are no pair.
std::vector<std::pair<std::size_t, std::size_t>> pairsOf(const std::vector<SessionRow>& sessions,
                                                         const Arguments& arguments)
{
  std::vector<std::pair<std::size_t, std::size_t>> pairs, others;
  for (std::size_t i = 0; i < sessions.size(); ++i)
    for (std::size_t k = i + 1; k < sessions.size(); ++k)
      if (sessions[i].problem.empty() && sessions[k].problem.empty() && sessions[i].session != sessions[k].session)
        (sessions[i].truth.object == sessions[k].truth.object ? pairs : others).emplace_back(i, k);
  std::mt19937_64 random(arguments.seed);
  if (arguments.max_cross > 0)
    std::shuffle(others.begin(), others.end(), random);
  if (arguments.max_cross > 0 && others.size() > arguments.max_cross)
    others.resize(arguments.max_cross);
  if (arguments.cross)
    pairs.insert(pairs.end(), others.begin(), others.end());
  return pairs;
}

void run(const Arguments& arguments)
{
  std::set<std::string> ids;
  for (const std::string& folder : arguments.folders)
    if (!ids.insert(sessionIdOf(folder)).second)
      throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                        "'" + folder + "': another folder makes the session '" + sessionIdOf(folder) + "' too");
  Surfaces surfaces;
  std::vector<SessionRow> sessions;
  for (const std::string& folder : arguments.folders)
    for (int arc = 0; arc < std::max(1, arguments.arcs); ++arc)
      sessions.push_back(prepareSession(folder, arc, arguments, &surfaces));
  std::cout << sessionTable(sessions) << "\n" << std::flush;
  if (arguments.growth)
  {
    std::vector<registration::PartialModel> parts;
    for (const SessionRow& session : sessions)
      if (session.problem.empty())
        parts.push_back(session.part);
    const std::vector<GrowthRow> rows = measureGrowth(parts, arguments.pair);
    std::cout << toTable(rows) << std::flush;
    benchmark_program::writeJson(arguments.json, toJson(rows));
    return;
  }
  if (arguments.together > 0)
  {
    const std::vector<ObjectRow> objects = alignTogether(sessions, arguments.together, arguments.pair);
    std::cout << toTable(objects) << std::flush;
    nlohmann::json json = toJson(sessions, {});
    json["objects"] = toJson(objects);
    json["options"] = { { "grey", arguments.gray } };
    benchmark_program::writeJson(arguments.json, json);
    return;
  }
  std::cout << pairTableHeader() << std::flush;
  std::vector<PairRow> pairs;
  for (const auto& [i, k] : pairsOf(sessions, arguments))
  {
    pairs.push_back(alignPairOf(sessions[i], sessions[k], arguments, &surfaces));
    std::cout << toTableRow(pairs.back()) << std::flush;
  }
  std::cout << "\n" << summaryText(sessions, pairs) << std::flush;
  nlohmann::json json = toJson(sessions, pairs);
  json["options"] = {
    { "grey", arguments.gray }, { "cross", arguments.cross },          { "arcs", arguments.arcs },
    { "seed", arguments.seed }, { "threads", arguments.pair.threads }, { "spacing_m", arguments.part.spacing_m }
  };
  benchmark_program::writeJson(arguments.json, json);
}
}  // namespace

int main(int argc, char** argv)
{
  CLI::App app("Alignment of sessions, pair by pair, against the truth of simulated sequences.");
  app.footer(
      "Right is an alignment within 1.5 deg and 1.5 mm; with --grey also one that puts the surface within 1.5 mm of\n"
      "the true one, for shape alone does not tell symmetric poses apart. Exit codes: 1 failed, 2 wrong usage.");
  Arguments arguments;
  std::string noise_model;
  double spacing_mm = 1e3 * arguments.part.spacing_m;
  app.add_option("folders", arguments.folders, "TUM-style folders with groundtruth.txt and objects.yaml")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_option("--cache", arguments.cache,
                 "Folder that keeps the refined, segmented sessions; those that are there already are not made again")
      ->required();
  app.add_option("--noise-model", noise_model,
                 "YAML of the sensor, as calibrate_camera writes it; for sessions that are not in the cache")
      ->check(CLI::ExistingFile);
  app.add_flag("--grey", arguments.gray, "Without colour and features, by shape alone");
  app.add_flag("--cross", arguments.cross, "Also pairs of different objects, which should be refused");
  app.add_option("--arcs", arguments.arcs,
                 "So many parts of each session, each of a random run of its keyframes: many pairs of few recordings")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--max-cross", arguments.max_cross, "So many pairs of different objects, chosen at random; 0: all");
  app.add_option("--seed", arguments.seed, "Of --arcs and --max-cross")->capture_default_str();
  app.add_flag("--growth", arguments.growth, "Instead: time by the number of sessions, which are of one object");
  app.add_option("--together", arguments.together,
                 "Instead: all sessions of each object that has at least so many, aligned together");
  app.add_option("--json", arguments.json, "Also write all figures, of all candidates, to this file");
  app.add_option("--parts", arguments.parts, "Also write what is aligned, a PLY file of points for each session")
      ->check(CLI::ExistingDirectory);
  app.add_option("--same-pose-probability", arguments.pair.same_pose_probability)->capture_default_str();
  app.add_option("--threads", arguments.pair.threads)->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--spacing-mm", spacing_mm, "Of the points of a part")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  return benchmark_program::run(app, argc, argv,
                                [&]
                                {
                                  arguments.part.use_color = !arguments.gray;
                                  arguments.part.spacing_m = 1e-3 * spacing_mm;
                                  if (!noise_model.empty())
                                    arguments.noise_model = rgbd::loadNoiseModel(noise_model);
                                  run(arguments);
                                });
}
