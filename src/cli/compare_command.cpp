#include <iomanip>
#include <map>
#include <memory>
#include <sstream>

#include "command.h"
#include "object_modelling/evaluation/comparison_files.h"

namespace object_modelling::cli
{
namespace
{
struct CompareArguments
{
  std::string model, reference;
  double model_unit_m = 1, reference_unit_m = 1;
  std::string start_file, transform_file, cloud_file, histogram_file;
  bool no_align = false;
  double bin_mm = 0.05, red_from_mm = 2;
};

constexpr std::size_t HISTOGRAM_BINS = 60;

struct Points
{
  std::vector<Eigen::Vector3d> finite;
  std::size_t left_out = 0;
};

Points readPoints(const std::string& path, double unit_m)
{
  Points points;
  for (const Eigen::Vector3f& vertex : evaluation::readGeometry(path, unit_m).vertices)
  {
    if (vertex.allFinite())
      points.finite.push_back(vertex.cast<double>());
    else
      ++points.left_out;
  }
  if (points.finite.empty())
    throw base::Error(base::StatusCode::BAD_INPUT, "'" + path + "' has no points that are finite");
  return points;
}

nlohmann::json rowsOf(const Eigen::Isometry3d& T)
{
  nlohmann::json rows = nlohmann::json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back({ T(row, 0), T(row, 1), T(row, 2), T(row, 3) });
  return rows;
}

CommandOutput describe(const evaluation::Comparison& comparison, const evaluation::Histogram& histogram,
                       std::size_t left_out)
{
  const evaluation::DistanceStatistics& s = comparison.statistics;
  CommandOutput output;
  output.json = { { "reference_from_model", rowsOf(comparison.T_reference_model) },
                  { "converged", comparison.converged },
                  { "point_count", comparison.distances_m.size() },
                  { "points_left_out", left_out },
                  { "model_diagonal_m", comparison.model_diagonal_m },
                  { "reference_diagonal_m", comparison.reference_diagonal_m },
                  { "distance_mm",
                    { { "mean", 1000 * s.mean_m },
                      { "sigma", 1000 * s.sigma_m },
                      { "rms", 1000 * s.rms_m },
                      { "median", 1000 * s.median_m },
                      { "p95", 1000 * s.p95_m },
                      { "max", 1000 * s.max_m } } },
                  { "beyond_5mm_ratio", s.outlier_ratio },
                  { "histogram",
                    { { "bin_width_mm", 1000 * histogram.bin_width_m }, { "counts", histogram.counts } } } };
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  text << "distances of " << comparison.distances_m.size() << " model points to the reference\n"
       << "mean      " << 1000 * s.mean_m << " +- " << 1000 * s.sigma_m << " mm\n"
       << "median    " << 1000 * s.median_m << " mm, 95 % below " << 1000 * s.p95_m << " mm, largest " << 1000 * s.max_m
       << " mm\n"
       << "outliers  " << 100 * s.outlier_ratio << " % beyond 5 mm\n"
       << "reference_from_model\n"
       << std::setprecision(9);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      text << (column == 0 ? "          " : " ") << std::setw(13) << comparison.T_reference_model(row, column)
           << (column == 3 ? "\n" : "");
  if (left_out > 0)
    text << "WARNING   " << left_out << " points of the model are not finite and were left out\n";
  if (!comparison.converged)
    text
        << "WARNING   the alignment did not settle: look at the coloured cloud (--cloud) before trusting the figures\n";
  const double ratio = comparison.model_diagonal_m / comparison.reference_diagonal_m;
  if (ratio > 1.5 || ratio < 1 / 1.5)
    text << "WARNING   the model is " << std::setprecision(3) << ratio
         << " times as large as the reference: is it the same object, in the same unit?\n";
  output.text = text.str();
  return output;
}

CommandOutput run(const CompareArguments& arguments, base::JobControl& control)
{
  evaluation::ComparisonOptions options;
  options.align = !arguments.no_align;
  if (!arguments.start_file.empty())
    options.T_start = evaluation::readTransform(arguments.start_file);
  control.report("read", 0, 2);
  const Points points = readPoints(arguments.model, arguments.model_unit_m);
  control.report("read", 1, 2);
  const mesh::TriangleMesh reference = evaluation::readGeometry(arguments.reference, arguments.reference_unit_m);
  control.report("read", 2, 2);
  std::unique_ptr<mesh::ReferenceSurface> surface;
  try
  {
    surface = std::make_unique<mesh::ReferenceSurface>(reference);
  }
  catch (const base::Error& error)
  {
    throw base::Error(error.code(), "'" + arguments.reference + "': " + error.what());
  }
  const evaluation::Comparison comparison = evaluation::compareToReference(points.finite, *surface, options, control);
  if (!comparison.status.ok())
    throw base::Error(comparison.status.code,
                      "'" + arguments.model + "' against '" + arguments.reference + "': " + comparison.status.message);
  const evaluation::Histogram histogram =
      evaluation::histogramOf(comparison.distances_m, arguments.bin_mm / 1000, HISTOGRAM_BINS);
  if (!arguments.transform_file.empty())
    evaluation::writeTransform(arguments.transform_file, comparison.T_reference_model);
  if (!arguments.cloud_file.empty())
    evaluation::writeColoredCloud(arguments.cloud_file, comparison, arguments.red_from_mm / 1000);
  if (!arguments.histogram_file.empty())
    evaluation::writeHistogram(arguments.histogram_file, histogram, comparison.statistics);
  return describe(comparison, histogram, points.left_out);
}
}  // namespace

void addCompareCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<CompareArguments>();
  const std::map<std::string, double> units{ { "m", 1.0 }, { "cm", 0.01 }, { "mm", 0.001 } };
  const auto add_unit = [&](CLI::App* command, const std::string& name, double* unit_m)
  {
    command
        ->add_option_function<std::string>(
            name, [unit_m, units](const std::string& unit) { *unit_m = units.at(unit); },
            "Unit of the lengths in the file: m (default), cm or mm")
        ->check(CLI::IsMember({ "m", "cm", "mm" }));
  };
  CLI::App* command = app.add_subcommand("compare", "How far the points of a model lie from a reference mesh");
  command->add_option("model", arguments->model, "Mesh or cloud: .ply, .obj or .pcd; its points are measured")
      ->required();
  command->add_option("reference", arguments->reference, "Mesh that is taken for true: .ply or .obj, any frame")
      ->required();
  add_unit(command, "--model-unit", &arguments->model_unit_m);
  add_unit(command, "--reference-unit", &arguments->reference_unit_m);
  command->add_option("--init", arguments->start_file,
                      "Text file with reference_from_model (4x4, row by row, m): the fit starts there");
  command->add_flag("--no-align", arguments->no_align, "Measure as the files, or --init, place the model");
  command->add_option("--transform", arguments->transform_file, "Write reference_from_model as 4x4 text here");
  command->add_option("--cloud", arguments->cloud_file, "Write the placed points here (.ply), coloured by distance");
  command->add_option("--red-from", arguments->red_from_mm, "Distance in mm from which that cloud is red")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  command->add_option("--histogram", arguments->histogram_file, "Draw the distances here (.png)");
  command->add_option("--bin", arguments->bin_mm, "Width in mm of the histogram's 60 bins")
      ->check(CLI::Range(0.0001, 1000.0))
      ->capture_default_str();
  command->footer("Example: object_modelling compare ~/objects/mustard/mesh/mesh.ply scan.ply --histogram mustard.png");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
