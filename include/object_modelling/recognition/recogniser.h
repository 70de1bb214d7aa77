#pragma once

#include <memory>
#include <string>
#include <vector>

#include "object_modelling/recognition/candidate.h"
#include "object_modelling/recognition/object_knowledge.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::recognition
{
struct RecogniserOptions
{
  double min_confidence_ratio = 0.7;  ///< detections below are not given
  double max_distance_m = 2.5;        ///< of objects from the camera
  double min_visible_ratio = 0.25;    ///< of the object's outline; what shows less is not given
  int max_features = 1500;            ///< of the image
  bool use_texture = true, use_shape = true;
  int reference_points = 40;       ///< of a cluster, that vote
  int max_scene_points = 2000;     ///< of a cluster
  int objects_per_cluster = 6;     ///< that are looked for with all effort; a quick search chooses them
  int hypotheses_per_cluster = 8;  ///< and object, that are aligned
  double time_budget_s = 0;        ///< of an image: the best until then is given, by texture first; 0: no limit
  std::uint64_t seed = 1;
  std::vector<std::string> violations() const;
};

struct Scene;
class Deadline;

/// An object found in an image.
struct Detection
{
  std::string object_id;
  std::string content_hash;                                          ///< of the model that was found
  Eigen::Isometry3d T_camera_model = Eigen::Isometry3d::Identity();  ///< metres; model: the object frame
  /// Of T_camera_model, a small motion on its left (camera frame); m and rad.
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  double confidence_ratio = 0;  ///< chance of being right
  double visible_ratio = 0;     ///< of the object's outline that the camera sees
  int matched_features = 0;     ///< that agree on the pose; 0: found by shape alone
};

/// Finds known objects, each as often as it is there, in one image with depth. Same input and seed, same detections,
/// unless the time runs out.
/// Not for several threads at once.
class Recogniser
{
public:
  Recogniser(std::vector<std::shared_ptr<const ObjectKnowledge>> objects, const RecogniserOptions& options = {});
  ~Recogniser();

  /// Most confident first. An image without depth has none.
  std::vector<Detection> recognise(const rgbd::Frame& frame) const;

  /// All poses that were verified, best score first, right or wrong: to look into failures, and to fit the
  /// confidence.
  std::vector<Candidate> candidates(const rgbd::Frame& frame) const;

private:
  std::vector<Candidate> search(const Scene& scene, const Deadline& deadline) const;

  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace object_modelling::recognition
