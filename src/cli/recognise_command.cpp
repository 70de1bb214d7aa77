#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <memory>
#include <sstream>

#include "bop_results.h"
#include "command.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/statistics.h"
#include "object_modelling/recognition/recogniser.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/ros_bridge/recording.h"
#include "object_modelling/source/bop_scene.h"
#include "report_text.h"

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
  BopImage place;
  base::Status status;  ///< why the image could not be searched
  std::vector<recognition::Detection> detections;
};

struct OpenRecording
{
  std::string path;
  std::unique_ptr<source::FrameSource> frames;
  std::vector<int> image_numbers;  ///< of BOP; empty: images are counted from 0
  int scene = 0;
};

/// What is collected over all images.
struct Results
{
  CommandOutput output{ {}, nlohmann::json::array() };
  std::ostringstream csv;
  std::vector<double> seconds;  ///< of the images that were searched
  std::size_t unusable = 0;
  std::string first_failure;
};

std::vector<std::string> chosenIds(const RecogniseArguments& arguments, const database::ObjectDatabase& database)
{
  std::vector<std::string> ids;
  for (const std::string& id : arguments.ids)
    if (std::find(ids.begin(), ids.end(), id) == ids.end())
      ids.push_back(id);
  if (arguments.ids.empty())
    for (const database::ObjectEntry& entry : database.list())
      ids.push_back(entry.id);
  if (ids.empty())
    throw base::Error(base::StatusCode::NOT_FOUND, "the database '" + arguments.database +
                                                       "' has no objects: make some with 'object_modelling model'");
  return ids;
}

std::vector<std::shared_ptr<const recognition::ObjectKnowledge>> learn(const RecogniseArguments& arguments,
                                                                       base::JobControl& control, std::string* note)
{
  database::ObjectDatabase database(arguments.database, false);
  std::vector<std::shared_ptr<const recognition::ObjectKnowledge>> objects;
  for (const std::string& id : chosenIds(arguments, database))
  {
    const recognition::LearntObject learnt = recognition::recallOrLearn(database, database.entry(id), {}, control);
    if (!learnt.kept.ok())
      *note =
          "What was learnt of the objects is used, but cannot be kept for the next time: " + learnt.kept.message + "\n";
    objects.push_back(learnt.knowledge);
  }
  return objects;
}

/// The last component of a path, with or without a slash at its end.
std::string folderName(const std::string& path)
{
  const fs::path normal = fs::path(path).lexically_normal();
  return (normal.has_filename() ? normal : normal.parent_path()).filename().string();
}

/// Scenes have the numbers of BOP's folders where those differ.
std::vector<OpenRecording> openAll(const std::vector<std::string>& paths)
{
  std::vector<OpenRecording> recordings;
  std::vector<std::string> names;
  for (const std::string& path : paths)
  {
    OpenRecording recording;
    recording.path = path;
    recording.frames = ros_bridge::openRecording(path);
    if (source::isBopScene(path))
      recording.image_numbers = source::bopImageNumbers(path);
    recordings.push_back(std::move(recording));
    names.push_back(folderName(path));
  }
  const std::vector<int> scenes = uniqueNumbers(names);
  for (std::size_t i = 0; i < recordings.size(); ++i)
    recordings[i].scene = scenes[i];
  return recordings;
}

nlohmann::json detectionJson(const recognition::Detection& detection, int number)
{
  nlohmann::json rows = nlohmann::json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back({ detection.T_camera_model(row, 0), detection.T_camera_model(row, 1),
                     detection.T_camera_model(row, 2), detection.T_camera_model(row, 3) });
  return { { "object_id", detection.object_id },         { "number", number },
           { "content_hash", detection.content_hash },   { "confidence_ratio", detection.confidence_ratio },
           { "visible_ratio", detection.visible_ratio }, { "camera_from_model", rows } };
}

std::string imageText(const ImageDetections& image)
{
  if (!image.status.ok())
    return "not usable: " + image.status.message + "\n";
  std::ostringstream text;
  text << std::fixed << (image.detections.empty() ? "nothing known" : "");
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

void add(const ImageDetections& image, const std::string& recording, const std::map<std::string, int>& numbers,
         Results* results)
{
  const std::string name = recording + " image " + std::to_string(image.place.image) + ": ";
  results->output.text += name + imageText(image);
  nlohmann::json detections = nlohmann::json::array();
  for (const recognition::Detection& detection : image.detections)
  {
    const int number = numbers.at(detection.object_id);
    detections.push_back(detectionJson(detection, number));
    writeBopRow(results->csv, image.place, number, detection);
  }
  results->output.json.push_back({ { "recording", recording },
                                   { "scene", image.place.scene },
                                   { "image", image.place.image },
                                   { "status", toJson(image.status) },
                                   { "seconds", image.place.seconds },
                                   { "detections", detections } });
  if (image.status.ok())
    results->seconds.push_back(image.place.seconds);
  else if (++results->unusable == 1)
    results->first_failure = name + image.status.message;
}

/// The next frame of a recording, nothing at its end, or why it cannot be used.
base::Result<std::optional<rgbd::RawFrame>> readNext(source::FrameSource& frames)
{
  base::Result<std::optional<rgbd::RawFrame>> raw;
  try
  {
    raw.value = frames.next();
  }
  catch (const base::Error& error)
  {
    raw.status = error.status();
  }
  return raw;
}

void search(const rgbd::RawFrame& raw, const recognition::Recogniser& recogniser, rgbd::FrameBuilder& builder,
            ImageDetections* image)
{
  const base::Result<rgbd::Frame> frame = builder.build(raw);
  image->status = frame.status;
  if (!frame.ok())
    return;
  const auto start = std::chrono::steady_clock::now();
  image->detections = recogniser.recognise(frame.value);
  image->place.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void searchRecording(const OpenRecording& recording, std::size_t every, const recognition::Recogniser& recogniser,
                     const std::map<std::string, int>& numbers, base::JobControl& control, Results* results)
{
  rgbd::FrameBuilder builder;
  const std::size_t count = recording.frames->size().value_or(0);
  const std::string stage = "recognise in " + recording.path;
  for (std::size_t k = 0;; ++k)
  {
    control.report(stage, std::min(k, count), count);
    const base::Result<std::optional<rgbd::RawFrame>> raw = readNext(*recording.frames);
    if (raw.ok() && !raw.value)
      return;
    if (k % every != 0)
      continue;
    ImageDetections image;
    image.place.scene = recording.scene;
    image.place.image = k < recording.image_numbers.size() ? recording.image_numbers[k] : static_cast<int>(k);
    image.status = raw.status;
    if (raw.ok())
      search(*raw.value, recogniser, builder, &image);
    add(image, recording.path, numbers, results);
  }
}

/// Which number is what, a line for each; empty if all names begin with their numbers.
std::string numberingText(const std::vector<OpenRecording>& recordings, const std::map<std::string, int>& numbers)
{
  std::ostringstream text;
  bool own = true;
  for (const auto& [id, number] : numbers)
  {
    own = own && isOwnNumber(id, number);
    text << "object," << number << "," << id << "\n";
  }
  for (const OpenRecording& recording : recordings)
  {
    own = own && isOwnNumber(folderName(recording.path), recording.scene);
    text << "scene," << recording.scene << "," << recording.path << "\n";
  }
  return own ? "" : text.str();
}

/// Writes the results, and beside them what their numbers mean unless the names tell.
std::string writeResults(const std::string& path, const std::string& rows, const std::string& numbering)
{
  base::writeTextFile(path, rows);
  if (numbering.empty())
    return path + "\n";
  const std::string numbers_path = fs::path(path).replace_extension("numbers.csv").string();
  base::writeTextFile(numbers_path, "kind,number,name\n" + numbering);
  return path + "\nnumbers in it that are not those of ids or folders (" + numbers_path + "):\n" + numbering;
}

std::string summaryText(const Results& results, std::size_t objects)
{
  std::ostringstream summary;
  std::vector<double> seconds = results.seconds;
  summary << std::fixed << std::setprecision(2) << seconds.size() << " images, " << objects << " objects, median "
          << base::median(&seconds) << " s an image";
  if (results.unusable > 0)
    summary << "; " << results.unusable << " images not usable";
  summary << "\n";
  return summary.str();
}

CommandOutput run(const RecogniseArguments& arguments, base::JobControl& control)
{
  if (!arguments.csv.empty())
    requireOutputFolder(arguments.csv);
  const std::vector<OpenRecording> recordings = openAll(arguments.recordings);
  Results results;
  const auto objects = learn(arguments, control, &results.output.text);
  std::vector<std::string> ids;
  for (const auto& object : objects)
    ids.push_back(object->id);
  const std::vector<int> object_numbers = uniqueNumbers(ids);
  std::map<std::string, int> numbers;
  for (std::size_t i = 0; i < ids.size(); ++i)
    numbers[ids[i]] = object_numbers[i];

  const recognition::Recogniser recogniser(objects, arguments.options);
  writeBopHeader(results.csv);
  for (const OpenRecording& recording : recordings)
    searchRecording(recording, static_cast<std::size_t>(arguments.every), recogniser, numbers, control, &results);
  results.output.text += summaryText(results, objects.size());
  if (!arguments.csv.empty())
    results.output.text += writeResults(arguments.csv, results.csv.str(), numberingText(recordings, numbers));
  if (results.unusable > 0)
    results.output.status = { base::StatusCode::BAD_INPUT,
                              std::to_string(results.unusable) + " of " +
                                  std::to_string(results.unusable + results.seconds.size()) +
                                  " images could not be used, the first: " + results.first_failure };
  return std::move(results.output);
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
  command->add_option("--csv", arguments->csv,
                      "Write the results here, as BOP has them; where numbers are not those of ids or folders, a "
                      "file NAME.numbers.csv beside it says which is what");
  command->add_option("--seed", arguments->options.seed, "Seed of all random choices")->capture_default_str();
  command->footer("Example: object_modelling recognise scenes/000001 --database ~/objects --csv results.csv");
  command->callback([arguments, chosen]
                    { *chosen = [arguments](base::JobControl& control) { return run(*arguments, control); }; });
}

}  // namespace object_modelling::cli
