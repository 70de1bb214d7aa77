// Looks for the objects of a database in scenes of BOP: times, and all verified poses.
// benchmark_recognition --help; docs/measurements.md, Recognition.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <random>
#include <sstream>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "benchmark_program.h"
#include "object_modelling/base/statistics.h"
#include "object_modelling/recognition/recogniser.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/source/bop_scene.h"

namespace
{
using namespace object_modelling;
using Clock = std::chrono::steady_clock;

struct Arguments
{
  std::string database, numbers, candidates;
  std::vector<std::string> scenes, ids;
  unsigned light_seed = 0;
  recognition::RecogniserOptions options;
};

double since_s(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Another camera and light: saturation, contrast, gamma, white balance, noise.
void changeLight(std::mt19937& random, cv::Mat* bgr)
{
  const auto between = [&](double low, double high)
  { return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()); };
  cv::Mat image, gray;
  bgr->convertTo(image, CV_32F, 1.0 / 255);
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  cv::cvtColor(gray, gray, cv::COLOR_GRAY2BGR);
  image = gray + between(0.6, 1.5) * (image - gray);
  image = (image - cv::Scalar::all(0.45)) * between(0.8, 1.6) + cv::Scalar::all(0.45);
  image = cv::max(image, 0.0);
  cv::pow(image, between(0.6, 1.7), image);
  const double blue = between(0.75, 1.25), green = between(0.9, 1.1), red = between(0.75, 1.25);
  cv::multiply(image, cv::Scalar(blue, green, red), image);
  cv::Mat noise(image.size(), CV_32FC3);
  cv::RNG(random()).fill(noise, cv::RNG::NORMAL, 0, between(0, 0.04));
  image += noise;
  image.convertTo(*bgr, CV_8U, 255);
}

std::vector<std::shared_ptr<const recognition::ObjectKnowledge>> learn(const Arguments& arguments)
{
  base::JobControl control;
  const database::ObjectDatabase database(arguments.database, false);
  std::vector<std::string> ids = arguments.ids;
  if (ids.empty())
    for (const database::ObjectEntry& entry : database.list())
      ids.push_back(entry.id);
  std::vector<double> seconds;
  std::vector<std::shared_ptr<const recognition::ObjectKnowledge>> objects;
  for (const std::string& id : ids)
  {
    const Clock::time_point start = Clock::now();
    objects.push_back(recognition::learnObject(database, database.entry(id), {}, control));
    seconds.push_back(since_s(start));
  }
  std::cerr << objects.size() << " objects learnt, median " << base::median(&seconds) << " s\n";
  return objects;
}

/// Numbers in the result by id: of a JSON file, or the digits that the id begins with.
std::map<std::string, int> numbersOf(const Arguments& arguments,
                                     const std::vector<std::shared_ptr<const recognition::ObjectKnowledge>>& objects)
{
  nlohmann::json file;
  if (!arguments.numbers.empty())
    std::ifstream(arguments.numbers) >> file;
  std::map<std::string, int> numbers;
  for (const auto& object : objects)
    numbers[object->id] = file.contains(object->id) ? file[object->id].get<int>() : std::atoi(object->id.c_str());
  return numbers;
}

void writePose(std::ostream& out, const Eigen::Isometry3d& T)
{
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      out << "," << T(row, column);
}

void writeCandidates(std::ostream& out, int scene, int image, const std::map<std::string, int>& numbers,
                     const std::vector<std::shared_ptr<const recognition::ObjectKnowledge>>& objects,
                     const std::vector<recognition::Candidate>& candidates)
{
  for (const recognition::Candidate& candidate : candidates)
  {
    const recognition::Verification& v = candidate.verification;
    const auto& object = *objects[static_cast<std::size_t>(candidate.hypothesis.object)];
    out << scene << "," << image << "," << numbers.at(object.id) << "," << candidate.hypothesis.matched_features << ","
        << candidate.confidence << "," << candidate.score << "," << candidate.rival_score << ","
        << v.explainedOfVisible();
    for (const float evidence : recognition::evidenceOf(v, candidate.hypothesis))
      out << "," << evidence;
    writePose(out, candidate.hypothesis.T_camera_model);
    out << "\n";
  }
}

void work(const Arguments& arguments)
{
  const auto objects = learn(arguments);
  const std::map<std::string, int> numbers = numbersOf(arguments, objects);
  const recognition::Recogniser recogniser(objects, arguments.options);
  std::ofstream candidates(arguments.candidates);
  std::vector<double> seconds;
  for (const std::string& folder : arguments.scenes)
  {
    const int scene = std::stoi(folder.substr(folder.find_last_of('/') + 1));
    const std::vector<int> images = source::bopImageNumbers(folder);
    const auto source = source::openBopScene(folder);
    rgbd::FrameBuilder builder;
    for (std::size_t i = 0; std::optional<rgbd::RawFrame> raw = source->next(); ++i)
    {
      if (arguments.light_seed > 0)
      {
        std::mt19937 random(arguments.light_seed * 1000003U + static_cast<unsigned>(scene * 1009 + images[i]));
        changeLight(random, &raw->color);
      }
      const rgbd::Frame frame = builder.build(*raw).value;
      const Clock::time_point start = Clock::now();
      recogniser.recognise(frame);
      seconds.push_back(since_s(start));
      if (!arguments.candidates.empty())
        writeCandidates(candidates, scene, images[i], numbers, objects, recogniser.candidates(frame));
      std::cerr << "\r" << folder << " " << i + 1 << " of " << images.size() << std::flush;
    }
  }
  const auto count = seconds.size();
  std::sort(seconds.begin(), seconds.end());
  std::cout << std::fixed << std::setprecision(2) << "\n"
            << count << " images, median " << base::median(&seconds) << " s, longest " << seconds.back() << " s\n";
}
}  // namespace

int main(int argc, char** argv)
{
  CLI::App app(
      "Looks for objects in scenes: times, and poses for fit_confidence.py (detections: object_modelling recognise)");
  Arguments arguments;
  app.add_option("database", arguments.database, "Folder of the object database")->required();
  app.add_option("scenes", arguments.scenes, "Scene folders of BOP, named by their numbers")->required();
  app.add_option("--id", arguments.ids, "Only these objects");
  app.add_option("--numbers", arguments.numbers, "JSON file: number in the results by object id");
  app.add_option("--candidates", arguments.candidates, "Write all verified poses, with what speaks for them");
  app.add_option("--light-seed", arguments.light_seed, "Change colours as another camera and light do; 0: do not");
  app.add_option("--time-budget", arguments.options.time_budget_s, "s an image")->capture_default_str();
  app.add_option("--objects-per-cluster", arguments.options.objects_per_cluster)->capture_default_str();
  return benchmark_program::run(app, argc, argv, [&] { work(arguments); });
}
