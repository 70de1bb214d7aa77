#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "object_modelling/geometry/transform.h"

namespace object_modelling::recognition
{
/// An object at a pose, before anything is known of how well it fits.
struct PoseHypothesis
{
  int object = -1;  ///< index of the known object
  Eigen::Isometry3d T_camera_model = Eigen::Isometry3d::Identity();
  int matched_features = 0;  ///< that agree on it
  float votes = 0;           ///< of pair features
};

/// How a hypothesis fits what was measured, by drawing it. Shares are of the pixels it covers, or as said.
struct Verification
{
  int drawn_px = 0;             ///< pixels of the verification's image that the object covers
  float explained = 0;          ///< the measured surface is there
  float occluded = 0;           ///< something is in front
  float violated = 0;           ///< the camera sees through it
  float unmeasured = 0;         ///< no depth
  float normals_agree = 0;      ///< of the explained pixels with normals
  float color_distance = 0;     ///< median difference in L*a*b* of explained pixels, common light taken off
  float color_correlation = 0;  ///< of L*a*b* over the explained pixels, with the drawn one's
  float contrast = 0;           ///< of the drawn colours over the explained pixels, standard deviation in L*a*b*
  float chroma_drawn = 0, chroma_seen = 0;  ///< of the mean colours
  float hue_cosine = 0;                     ///< between the mean colours' (a*, b*)
  float edges = 0;          ///< share of that outline at which depth steps, the surface bends, or the colour changes
  float flatness = 0;       ///< largest share of one direction in the drawn normals' squares, 1/3 to 1
  float contour = 0;        ///< share of the outline (where nothing hides it) beyond which the scene goes back
  std::vector<int> pixels;  ///< explained ones, as row * width + column of the thinned image

  float visible() const { return explained + violated; }
  float explainedOfVisible() const;
  float texture() const;    ///< from 0 (plain) to 1 (textured), by the contrast
  float agreement() const;  ///< of the colours: their correlation, as far as there is texture
};

/// A hypothesis that was aligned with the scene, and how well it then fits.
struct Candidate
{
  PoseHypothesis hypothesis;
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  ///< of its pose
  Verification verification;
  float score = 0;        ///< logarithm of the odds that it is right, by itself
  float rival_score = 0;  ///< of the best other one at its place
  float confidence = 0;   ///< chance that it is right, beside the others at its place
};

/// What speaks for and against a candidate, as its confidence weighs it.
constexpr int EVIDENCE_COUNT = 14;
using Evidence = std::array<float, EVIDENCE_COUNT>;
Evidence evidenceOf(const Verification& verification, const PoseHypothesis& hypothesis);

}  // namespace object_modelling::recognition
