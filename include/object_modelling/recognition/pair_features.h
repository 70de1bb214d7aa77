#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

// Point pair features: Drost, Ulrich, Navab, Ilic, Model Globally, Match Locally (CVPR 2010), with the spreading of
// Vidal, Lin, Llado, Marti, A Method for 6D Pose Estimation of Free-Form Rigid Objects Using Point Pair Features on
// Range Data (Sensors 2018).
namespace object_modelling::recognition
{
/// Points of a surface with unit normals, metres.
struct OrientedPoints
{
  std::vector<Eigen::Vector3f> points, normals;

  std::size_t size() const { return points.size(); }
};

/// A thinned copy: one mean per cube of edge `spacing_m` and direction of the normal (cubes are split where normals
/// differ by more than 30 deg).
OrientedPoints thinned(const OrientedPoints& surface, double spacing_m);

struct PairFeatureOptions
{
  double spacing_ratio = 0.05;   ///< of the diameter: spacing of the points and step of the distances
  double max_spacing_m = 0.006;  ///< thin things vanish at wider ones
  int angle_bins = 15;           ///< over 180 deg
  int turn_bins = 30;            ///< over 360 deg, of the votes
  std::size_t max_points = 700;  ///< of the model; the spacing grows until they are fewer
};

/// A pose with its votes.
struct VotedPose
{
  Eigen::Isometry3f T_scene_model = Eigen::Isometry3f::Identity();
  float votes = 0;
};

/// Pairs of a model's points by their feature: distance, and the three angles between normals and connection.
class PairTable
{
public:
  PairTable() = default;
  PairTable(const OrientedPoints& surface, double diameter_m, const PairFeatureOptions& options = {});

  double spacing_m() const { return spacing_m_; }
  const OrientedPoints& points() const { return points_; }

  /// Poses that the pairs of a reference point of the scene with the other points vote for: the peaks of at least 0.9
  /// of the best one, at most three. `scene` has the spacing of the table.
  void vote(const OrientedPoints& scene, std::size_t reference, std::vector<float>* accumulator,
            std::vector<VotedPose>* poses) const;

private:
  /// Reads or writes all of a table (knowledge_file.cpp).
  template <class Archive>
  friend void archivePairs(Archive& archive, PairTable& table);

  struct Entry
  {
    std::uint32_t reference = 0;
    float turn_rad = 0;  ///< of the pair's other point about the reference's normal
  };
  /// Adds the poses of the largest entries; spoils the accumulator.
  void peaks(const Eigen::Isometry3f& T_scene_reference, std::vector<float>* accumulator,
             std::vector<VotedPose>* poses) const;
  std::size_t keyOf(int distance, int a, int b, int c) const;

  double spacing_m_ = 0, diameter_m_ = 0;
  int angle_bins_ = 15, turn_bins_ = 30, distance_bins_ = 0;
  OrientedPoints points_;
  std::vector<Eigen::Isometry3f> T_reference_model_;
  std::vector<std::uint32_t> starts_;  ///< per key, and one more
  std::vector<Entry> entries_;
};

/// Poses joined where they differ by less than `distance_m` and `angle_rad`, their votes added up; most votes first.
std::vector<VotedPose> clustered(std::vector<VotedPose> poses, const Eigen::Vector3f& center_model, float distance_m,
                                 float angle_rad);

}  // namespace object_modelling::recognition
