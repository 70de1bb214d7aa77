#include "object_modelling/source/trajectory_file.h"

#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

#include "object_modelling/base/atomic_file.h"
#include "object_modelling/geometry/transform.h"
#include "text_table.h"

namespace object_modelling::source
{
void writeTrajectory(const std::string& path, const std::vector<StampedPose>& trajectory)
{
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "# timestamp tx ty tz qx qy qz qw (T_map_camera)\n" << std::fixed;
  for (const StampedPose& pose : trajectory)
  {
    const Eigen::Vector3d& t = pose.T_map_camera.translation();
    Eigen::Quaterniond q = Eigen::Quaterniond(pose.T_map_camera.linear()).normalized();
    if (q.w() < 0)
      q.coeffs() = -q.coeffs();
    out << std::setprecision(6) << pose.stamp_s << std::setprecision(9);
    for (const double value : { t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w() })
      out << ' ' << value;
    out << '\n';
  }
  base::writeTextFile(path, out.str());
}

std::vector<StampedPose> readTrajectory(const std::string& path)
{
  std::vector<StampedPose> trajectory;
  for (const TextRow& row : readTextTable(path))
  {
    row.requireWords(8, "stamp tx ty tz qx qy qz qw");
    const Eigen::Vector3d t(row.number(1), row.number(2), row.number(3));
    const Eigen::Quaterniond q(row.number(7), row.number(4), row.number(5), row.number(6));
    // Files are rounded to a few digits; anything further from 1 is no rotation but other columns.
    if (!(std::abs(q.norm() - 1) < 0.01))
      throw badInput(row.where, "quaternion has length " + std::to_string(q.norm()) + ", not 1");
    trajectory.push_back({ row.number(0), geometry::isometryFrom(q, t) });
  }
  return trajectory;
}

}  // namespace object_modelling::source
