#pragma once

#include <vector>

#include "plane_growing.h"

namespace object_modelling::segmentation
{
/// Planes that may be the support, best first. There is no gravity: a support is large, lies below what is at the
/// view's centre, and its normal does not point down in the image (a wall's does, in a camera that looks down at a
/// table).
std::vector<int> rankSupports(const WorkingImage& image, const GrownPlanes& planes, double max_height_m);

/// Whether plane `upper` lies above `lower` and about parallel to it, as a turntable or a tray does on a table.
bool liesAbove(const GrownPlane& upper, const GrownPlane& lower);

}  // namespace object_modelling::segmentation
