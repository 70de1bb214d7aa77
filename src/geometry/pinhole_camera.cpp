#include "object_modelling/geometry/pinhole_camera.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/base/options.h"

namespace object_modelling::geometry
{
bool PinholeCamera::distorted() const
{
  return std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0; });
}

std::vector<std::string> PinholeCamera::violations() const
{
  base::OptionsCheck check("camera");
  check.inRange("width", width, 1, 1 << 15);
  check.inRange("height", height, 1, 1 << 15);
  check.inRange("fx", fx, 1e-3, 1e6);
  check.inRange("fy", fy, 1e-3, 1e6);
  check.inRange("cx", cx, -1e6, 1e6);
  check.inRange("cy", cy, -1e6, 1e6);
  const std::size_t count = distortion.size();
  check.require("distortion", count == 0 || count == 4 || count == 5 || count == 8,
                "has " + std::to_string(count) + " coefficients; must be k1 k2 p1 p2 [k3 [k4 k5 k6]] or empty");
  check.require("distortion",
                std::all_of(distortion.begin(), distortion.end(), [](double k) { return std::isfinite(k); }),
                "has a coefficient that is not a finite number");
  return check.violations();
}

PinholeCamera PinholeCamera::scaled(double factor) const
{
  PinholeCamera result = *this;
  result.width = static_cast<int>(std::lround(width * factor));
  result.height = static_cast<int>(std::lround(height * factor));
  result.fx = fx * factor;
  result.fy = fy * factor;
  result.cx = (cx + 0.5) * factor - 0.5;
  result.cy = (cy + 0.5) * factor - 0.5;
  return result;
}

bool operator==(const PinholeCamera& a, const PinholeCamera& b)
{
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy &&
         a.distortion == b.distortion;
}

}  // namespace object_modelling::geometry
