#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "plane_moments.h"
#include "working_image.h"

namespace object_modelling::segmentation
{
struct PlaneGrowingOptions
{
  double angle_rad = 0.17453293;
  double distance_sigmas = 3.0;
  double distortion_ratio = 0.003;  ///< of depth: what smooth distortion bends a plane by, as a standard deviation
  int min_pixels = 200;             ///< of the working image
};

struct GrownPlane
{
  geometry::Plane plane;  ///< normal towards the camera
  PlaneMoments moments;
  double noise_scale = 1;  ///< at least 1: ratio of the plane's measured noise to the noise model's
};

struct GrownPlanes
{
  std::vector<GrownPlane> planes;  ///< most pixels first
  cv::Mat labels;                  ///< CV_16SC1 of the working image: index into planes, -1 none
};

/// Region growing from the flattest 8x8 cells, in order of their flatness, with refits at every doubling; regions
/// of one plane (a table behind objects) are then joined, and extended over pixels that lie in the plane but have rough
/// normals, as sensors with correlated noise give. Linear in the number of pixels.
GrownPlanes growPlanes(const WorkingImage& image, const PlaneGrowingOptions& options);

}  // namespace object_modelling::segmentation
