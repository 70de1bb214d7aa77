#pragma once

#include <vector>

#include "hypothesis.h"
#include "object_modelling/recognition/object_knowledge.h"
#include "scene.h"

namespace object_modelling::recognition
{
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
  float contour = 0;            ///< share of the outline (where nothing hides it) beyond which the scene goes back
  std::vector<int> pixels;      ///< explained ones, as row * width + column of the thinned image
  float visible() const { return explained + violated; }
};

constexpr int VERIFICATION_STEP_PX = 2;  ///< the image is thinned by this

Verification verify(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3d& T_camera_model);

/// Chance that the hypothesis is right, by logistic regression on a verification.
float confidenceOf(const Verification& verification, const PoseHypothesis& hypothesis);

}  // namespace object_modelling::recognition
