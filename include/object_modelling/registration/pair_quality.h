#pragma once

namespace object_modelling::registration
{
/// How well two parts fit, both ways.
struct PairQuality
{
  double overlap_ratio = 0;    ///< share of the smaller part's surface that the other part has too
  double fsv_ratio = 0;        ///< free-space violation: front / (front + same), points that views look through or see
  double rmse_m = 0;           ///< point to plane, over the overlap
  double contact_gap_m = 0;    ///< how far the lowest points are off the support plane of the other session; the larger
  double foot_m = 0;           ///< how far the parts end above their own support planes; the larger
  double turn_rad = -1;        ///< by how much the object was turned over between the sessions; negative: not known
  double roughness_m = 0;      ///< of the two surfaces by themselves, over some points; both together
  double color_agreement = 0;  ///< [-1, 1] correlation over the overlap; 0 without texture
  double texture = 0;          ///< standard deviation of the colours of the overlap: what the agreement is worth
  double light_variance = 0;   ///< of the differences of colours, as much as light from elsewhere explains
  double edge_agreement = 0;  ///< [-1, 1] correlation of the slopes of the colours: light that is elsewhere leaves them
  double edge_strength = 0;   ///< standard deviation of those slopes, as colour over the distance they are taken over
  double features_upheld = 0;  ///< matches of local features that the pose brings together
  double probability = 0;      ///< of being right, or one that makes the same object (docs/alignment.md)
};

}  // namespace object_modelling::registration
