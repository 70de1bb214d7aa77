#include <chrono>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <memory>
#include <sstream>

#include "command.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/statistics.h"
#include "object_modelling/recognition/recogniser.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/ros_bridge/recording.h"
#include "object_modelling/source/bop_scene.h"

namespace object_modelling::cli
{
namespace
{
namespace fs = std::filesystem;

struct RecogniseArguments
{
  std::vector<std::string> recordings, ids;
  std::string database, csv;
  int every = 1;
  recognition::RecogniserOptions options;
};

/// The detections of one image.
struct ImageDetections
{
  int number = 0;
  double seconds = 0;
  std::vector<recognition::Detection> detections;
};

std::vector<std::shared_ptr<const recognition::ObjectKnowledge>> learn(const RecogniseArguments& arguments,
                                                                       base::JobControl& control)
{
  const database::ObjectDatabase database(arguments.database, false);
  std::vector<std::shared_ptr<const recognition::ObjectKnowledge>> objects;
  if (arguments.ids.empty())
    for (const database::ObjectEntry& entry : database.list())
      objects.push_back(recognition::learnObject(database, entry, {}, control));
  for (const std::string& id : arguments.ids)
    objects.push_back(recognition::learnObject(database, database.entry(id), {}, control));
  if (objects.empty())
    throw base::Error(base::StatusCode::NOT_FOUND, "the database '" + arguments.database +
                                                       "' has no objects: make some with 'object_modelling model'");
  return objects;
}

/// Number of an object in a CSV file of BOP: the digits that its id begins with, else its place in the database.
int numberOf(const std::string& object_id, int place)
{
  std::size_t digits = 0;
  while (digits < object_id.size() && digits < 9 && std::isdigit(static_cast<unsigned char>(object_id[digits])) != 0)
    ++digits;
  return digits > 0 ? std::stoi(object_id.substr(0, digits)) : place;
}

void writeCsv(std::ostream& out, int scene, const ImageDetections& image, const std::map<std::string, int>& numbers)
{
  for (const recognition::Detection& detection : image.detections)
  {
    out << scene << "," << image.number << "," << numbers.at(detection.object_id) << "," << detection.confidence_ratio
        << ",";
    for (int i = 0; i < 9; ++i)
      out << (i > 0 ? " " : "") << detection.T_camera_model.linear()(i / 3, i % 3);
    const Eigen::Vector3d t_mm = 1000 * detection.T_camera_model.translation();
    out << "," << t_mm.x() << " " << t_mm.y() << " " << t_mm.z() << "," << image.seconds << "\n";
  }
}

nlohmann::json toJson(const std::string& recording, const ImageDetections& image)
{
  nlohmann::json detections = nlohmann::json::array();
  for (const recognition::Detection& detection : image.detections)
  {
    nlohmann::json rows = nlohmann::json::array();
    for (int row = 0; row < 4; ++row)
      rows.push_back({ detection.T_camera_model(row, 0), detection.T_camera_model(row, 1),
                       detection.T_camera_model(row, 2), detection.T_camera_model(row, 3) });
    detections.push_back({ { "object_id", detection.object_id },
                           { "content_hash", detection.content_hash },
                           { "confidence_ratio", detection.confidence_ratio },
                           { "visible_ratio", detection.visible_ratio },
                           { "camera_from_model", rows } });
  }
  return {
    { "recording", recording }, { "image", image.number }, { "seconds", image.seconds }, { "detections", detections }
  };
}

std::string toText(const std::string& recording, const ImageDetections& image)
{
  std::ostringstream text;
  text << std::fixed << recording << " image " << image.number << ": ";
  if (image.detections.empty())
    text << "nothing known";
  for (std::size_t i = 0; i < image.detections.size(); ++i)
  {
    const recognition::Detection& detection = image.detections[i];
    const Eigen::Vector3d t = detection.T_camera_model.translation();
    text << (i > 0 ? ", " : "") << detection.object_id << " " << std::setprecision(2) << detection.confidence_ratio
         << " at (" << std::setprecision(3) << t.x() << ", " << t.y() << ", " << t.z() << ") m";
  }
  text << "\n";
  return text.str();
}

/// Scene number of a BOP folder, else the place among the recordings.
int sceneNumber(const std::string& recording, int place)
{
  const std::string name = fs::path(recording).lexically_normal().filename().string();
  return numberOf(name, place);
}

CommandOutput run(const RecogniseArguments& arguments, base::JobControl& control)
{
  if (!arguments.csv.empty())
    requireOutputFolder(arguments.csv);
  std::vector<std::unique_ptr<source::FrameSource>> sources;
  for (const std::string& recording : arguments.recordings)
    sources.push_back(ros_bridge::openRecording(recording));
  const auto objects = learn(arguments, control);
  std::map<std::string, int> numbers;
  for (const auto& object : objects)
    numbers.emplace(object->id, numberOf(object->id, static_cast<int>(numbers.size()) + 1));
  const recognition::Recogniser recogniser(objects, arguments.options);
  CommandOutput output;
  output.json = nlohmann::json::array();
  std::ostringstream csv;
  csv << "scene_id,im_id,obj_id,score,R,t,time\n";
  std::vector<double> seconds;
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    const std::string& recording = arguments.recordings[i];
    const bool bop = source::isBopScene(recording);
    const std::vector<int> image_numbers = bop ? source::bopImageNumbers(recording) : std::vector<int>();
    rgbd::FrameBuilder builder;
    const std::size_t count = sources[i]->size().value_or(0);
    for (std::size_t k = 0; std::optional<rgbd::RawFrame> raw = sources[i]->next(); ++k)
    {
      control.report("recognise in " + recording, k, count);
      if (k % static_cast<std::size_t>(arguments.every) != 0)
        continue;
      const base::Result<rgbd::Frame> frame = builder.build(*raw);
      if (!frame.status.ok())
        throw base::Error(frame.status.code, recording + " image " + std::to_string(k) + ": " + frame.status.message);
      ImageDetections image;
      image.number = bop ? image_numbers[k] : static_cast<int>(k);
      const auto start = std::chrono::steady_clock::now();
      image.detections = recogniser.recognise(frame.value);
      image.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      seconds.push_back(image.seconds);
      output.text += toText(recording, image);
      output.json.push_back(toJson(recording, image));
      writeCsv(csv, sceneNumber(recording, static_cast<int>(i) + 1), image, numbers);
    }
  }
  std::ostringstream summary;
  summary << std::fixed << std::setprecision(2) << seconds.size() << " images, " << objects.size()
          << " objects, median " << base::median(&seconds) << " s an image\n";
  output.text += summary.str();
  if (!arguments.csv.empty())
  {
    base::writeTextFile(arguments.csv, csv.str());
    output.text += arguments.csv + "\n";
  }
  return output;
}
}  // namespace

void addRecogniseCommand(CLI::App& app, Command* chosen)
{
  auto arguments = std::make_shared<RecogniseArguments>();
  CLI::App* command = app.add_subcommand("recognise", "Known objects, with their poses, in single images with depth");
  command->add_option("recordings", arguments->recordings, "Scene folders of BOP, TUM-style folders or ROS bags")
      ->required();
  command->add_option("--database", arguments->database, "Folder of the object database")->required();
  command->add_option("--id", arguments->ids, "Only these objects of the database");
  command->add_option("--every", arguments->every, "Every n-th image of a recording")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--min-confidence", arguments->options.min_confidence_ratio, "Detections below are left out")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--csv", arguments->csv, "Write the results here, as BOP has them");
  command->add_option("--seed", arguments->options.seed, "Seed of all random choices")->capture_default_str();
  command->footer("Example: object_modelling recognise scenes/000001 --database ~/objects --csv results.csv");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
