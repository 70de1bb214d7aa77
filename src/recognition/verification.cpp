#include "verification.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "lab_color.h"
#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/projection.h"
#include "object_modelling/mesh/mesh_renderer.h"
#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::recognition
{
namespace
{
constexpr double SURFACE_ERROR_M = 0.004;  // of model, pose and distortion
constexpr double EXPLAINED_SIGMAS = 3;
constexpr float NORMAL_COSINE = 0.77F;  // 40 deg
constexpr int OUTLINE_PX = 3;           // beyond the outline
constexpr double MIN_COLOR_STEP = 12;   // in L*a*b*, of an edge
constexpr float BEND_COSINE = 0.82F;    // 35 deg
constexpr double MIN_STEP_M = 0.012;    // by which the scene goes back beyond an outline
constexpr float NEUTRAL_DISTANCE = 15;  // in L*a*b*: of an object whose colours are not known
constexpr int MIN_COLORED_PX = 25;

/// The part of the thinned image that the object's box covers.
struct Crop
{
  geometry::PinholeCamera camera;
  int left = 0, top = 0;
  bool empty = true;
};

Crop cropOf(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3d& T_camera_model)
{
  Crop crop;
  const geometry::PinholeCamera whole = scene.frame.camera.scaled(1.0 / VERIFICATION_STEP_PX);
  Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
  for (int corner = 0; corner < 8; ++corner)
  {
    const Eigen::Vector3d at = Eigen::Vector3d((corner & 1) - 0.5, (corner >> 1 & 1) - 0.5, (corner >> 2) - 0.5)
                                   .cwiseProduct(object.box_model.size_m);
    const Eigen::Vector3d p = T_camera_model * (object.box_model.T_frame_box * at);
    if (!(p.z() > 0.05))
      return crop;
    const Eigen::Array2d pixel = whole.project(p).array();
    low = low.min(pixel);
    high = high.max(pixel);
  }
  constexpr int MARGIN = OUTLINE_PX + 2;
  crop.left = std::max(0, static_cast<int>(low.x()) - MARGIN);
  crop.top = std::max(0, static_cast<int>(low.y()) - MARGIN);
  const int right = std::min(whole.width, static_cast<int>(high.x()) + MARGIN + 1);
  const int bottom = std::min(whole.height, static_cast<int>(high.y()) + MARGIN + 1);
  if (right - crop.left < 4 || bottom - crop.top < 4)
    return crop;
  crop.camera = whole;
  crop.camera.width = right - crop.left;
  crop.camera.height = bottom - crop.top;
  crop.camera.cx -= crop.left;
  crop.camera.cy -= crop.top;
  crop.empty = false;
  return crop;
}

/// CV_32FC3: mean L*a*b* of the points that fall on a pixel and are not hidden; L -1 where there is none.
cv::Mat drawnColors(const ObjectKnowledge& object, const Eigen::Isometry3d& T_camera_model, const Crop& crop,
                    const cv::Mat& depth_m)
{
  constexpr float HIDDEN_M = 0.006F;
  cv::Mat sum(depth_m.size(), CV_32FC4, cv::Scalar::all(0));
  const Eigen::Isometry3f T = T_camera_model.cast<float>();
  for (std::size_t i = 0; i < object.texture.oriented.size(); ++i)
  {
    const Eigen::Vector3f p = T * object.texture.oriented.points[i];
    const auto at = geometry::projectionOf(crop.camera, p);
    if (!at.inside || !(p.z() < depth_m.at<float>(at.row, at.column) + HIDDEN_M))
      continue;
    const Eigen::Vector3f& lab = object.texture.lab[i];
    sum.at<cv::Vec4f>(at.row, at.column) += cv::Vec4f(lab.x(), lab.y(), lab.z(), 1);
  }
  cv::Mat mean(depth_m.size(), CV_32FC3);
  for (int y = 0; y < sum.rows; ++y)
    for (int x = 0; x < sum.cols; ++x)
    {
      const cv::Vec4f& s = sum.at<cv::Vec4f>(y, x);
      mean.at<cv::Vec3f>(y, x) = s[3] > 0 ? cv::Vec3f(s[0] / s[3], s[1] / s[3], s[2] / s[3]) : cv::Vec3f(-1, 0, 0);
    }
  return mean;
}

struct ColorPair
{
  Eigen::Vector3f drawn, seen;
};

void compareColors(const std::vector<ColorPair>& pairs, Verification* result)
{
  result->color_distance = 50;
  if (pairs.size() < MIN_COLORED_PX)
    return;
  Eigen::Vector3f drawn = Eigen::Vector3f::Zero(), seen = drawn;
  for (const ColorPair& pair : pairs)
  {
    drawn += pair.drawn;
    seen += pair.seen;
  }
  drawn /= static_cast<float>(pairs.size());
  seen /= static_cast<float>(pairs.size());
  // Light differs in brightness more than in hue: brightness may be off as it likes, hue by a little.
  Eigen::Vector3f common = seen - drawn;
  common.tail<2>() = common.tail<2>().cwiseMax(-6).cwiseMin(6);
  common.x() = std::clamp(common.x(), -25.F, 25.F);
  std::vector<double> distances;
  double product = 0, square_drawn = 1e-6, square_seen = 1e-6;
  for (const ColorPair& pair : pairs)
  {
    distances.push_back((pair.seen - pair.drawn - common).cwiseProduct(Eigen::Vector3f(0.6F, 1, 1)).norm());
    product += (pair.drawn - drawn).dot(pair.seen - seen);
    square_drawn += (pair.drawn - drawn).squaredNorm();
    square_seen += (pair.seen - seen).squaredNorm();
  }
  result->color_distance = static_cast<float>(base::median(&distances));
  result->contrast = static_cast<float>(std::sqrt(square_drawn / static_cast<double>(pairs.size())));
  result->chroma_drawn = drawn.tail<2>().norm();
  result->chroma_seen = seen.tail<2>().norm();
  result->hue_cosine =
      drawn.tail<2>().dot(seen.tail<2>()) / std::max(1e-3F, result->chroma_drawn * result->chroma_seen);
  // Plain things correlate by noise alone: what varies by less than 4 counts as not correlated.
  const double floor = 16.0 * static_cast<double>(pairs.size());
  result->color_correlation =
      static_cast<float>(product / std::sqrt(std::max(square_drawn, floor) * std::max(square_seen, floor)));
}
/// Counts over the pixels that a drawn object covers.
class PixelCounts
{
public:
  PixelCounts(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3d& T_camera_model,
              const Crop& crop)
      : scene_(scene),
        object_(object),
        R_camera_model_(T_camera_model.linear().cast<float>()),
        crop_(crop),
        drawn_(mesh::renderMesh(object.mesh, crop.camera, T_camera_model, { 0, 0, 0 })),
        lab_(drawnColors(object, T_camera_model, crop, drawn_.depth_m))
  {
    for (int y = 0; y < drawn_.depth_m.rows; ++y)
      for (int x = 0; x < drawn_.depth_m.cols; ++x)
        if (drawn_.depth_m.at<float>(y, x) > 0)
          count(x, y);
  }

  Verification result()
  {
    Verification result;
    result.drawn_px = drawn_px_;
    const auto share = [](int count, int of)
    { return static_cast<float>(count) / static_cast<float>(std::max(1, of)); };
    result.explained = share(explained_, drawn_px_);
    result.occluded = share(occluded_, drawn_px_);
    result.violated = share(violated_, drawn_px_);
    result.unmeasured = share(unmeasured_, drawn_px_);
    result.normals_agree = share(agreeing_, with_normal_);
    result.contour = share(behind_, outline_);
    result.edges = share(edges_, outline_);
    result.pixels = std::move(pixels_);
    if (with_normal_ > 0)
      result.flatness =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f>(normals_ / static_cast<float>(with_normal_)).eigenvalues()[2];
    if (object_.colored)
      compareColors(colors_, &result);
    else
    {
      result.color_distance = NEUTRAL_DISTANCE;
      result.hue_cosine = 1;
    }
    return result;
  }

private:
  float measuredAt_m(int x, int y) const
  {
    const int u = (x + crop_.left) * VERIFICATION_STEP_PX, v = (y + crop_.top) * VERIFICATION_STEP_PX;
    return u >= 0 && v >= 0 && u < scene_.frame.depth_m.cols && v < scene_.frame.depth_m.rows
               ? scene_.frame.depthAt_m(u, v)
               : std::numeric_limits<float>::quiet_NaN();
  }

  void count(int x, int y)
  {
    ++drawn_px_;
    const double z_m = drawn_.depth_m.at<float>(y, x);
    const double tolerance_m = SURFACE_ERROR_M + EXPLAINED_SIGMAS * sigmaAt(scene_, z_m);
    const auto visibility = rgbd::visibilityOf<double>(z_m, static_cast<double>(measuredAt_m(x, y)), tolerance_m);
    if (visibility == rgbd::Visibility::UNKNOWN)
      ++unmeasured_;
    else if (visibility == rgbd::Visibility::BEHIND)
      ++occluded_;
    else if (visibility == rgbd::Visibility::IN_FRONT)
      ++violated_;
    else
      countExplained(x, y);
    if (visibility != rgbd::Visibility::BEHIND)
      countOutline(x, y, z_m, tolerance_m);
  }

  void countExplained(int x, int y)
  {
    ++explained_;
    pixels_.push_back((y + crop_.top) * (scene_.frame.camera.width / VERIFICATION_STEP_PX) + x + crop_.left);
    const int u = (x + crop_.left) * VERIFICATION_STEP_PX, v = (y + crop_.top) * VERIFICATION_STEP_PX;
    const cv::Vec3f &drawn = lab_.at<cv::Vec3f>(y, x), &seen = scene_.lab.at<cv::Vec3f>(v, u);
    if (drawn[0] >= 0)
      colors_.push_back({ { drawn[0], drawn[1], drawn[2] }, { seen[0], seen[1], seen[2] } });
    const Eigen::Vector3f n = scene_.normal(u, v);
    const int triangle = drawn_.triangle_id.at<int>(y, x);
    if (!n.allFinite() || triangle < 0)
      return;
    const auto& corners = object_.mesh.triangles[static_cast<std::size_t>(triangle)];
    const Eigen::Vector3f& p = object_.mesh.vertices[corners[0]];
    const Eigen::Vector3f m = (object_.mesh.vertices[corners[1]] - p).cross(object_.mesh.vertices[corners[2]] - p);
    ++with_normal_;
    normals_ += m.normalized() * m.normalized().transpose();
    if ((R_camera_model_ * m.normalized()).dot(n) > NORMAL_COSINE)
      ++agreeing_;
  }

  /// The surface bends, or the colour changes, from inside the outline to beyond it.
  bool changesAt(int x, int y, int dx, int dy) const
  {
    const auto pixel = [&](int steps)
    {
      return cv::Point((x + crop_.left + steps * dx) * VERIFICATION_STEP_PX,
                       (y + crop_.top + steps * dy) * VERIFICATION_STEP_PX);
    };
    const cv::Point inside = pixel(-1), beyond = pixel(OUTLINE_PX);
    if (!cv::Rect(0, 0, scene_.lab.cols, scene_.lab.rows).contains(inside))
      return false;
    const cv::Vec3f change = scene_.lab.at<cv::Vec3f>(beyond) - scene_.lab.at<cv::Vec3f>(inside);
    if (cv::norm(change) > MIN_COLOR_STEP)
      return true;
    const Eigen::Vector3f n = scene_.normal(inside.x, inside.y), m = scene_.normal(beyond.x, beyond.y);
    return n.allFinite() && m.allFinite() && n.dot(m) < BEND_COSINE;
  }

  /// To the four sides.
  void countOutline(int x, int y, double z_m, double tolerance_m)
  {
    const int dx[] = { -1, 1, 0, 0 }, dy[] = { 0, 0, -1, 1 };
    const cv::Rect image(0, 0, drawn_.depth_m.cols, drawn_.depth_m.rows);
    for (int side = 0; side < 4; ++side)
    {
      const cv::Point next(x + dx[side], y + dy[side]);
      if (image.contains(next) && drawn_.depth_m.at<float>(next) > 0)
        continue;
      const float beyond_m = measuredAt_m(x + OUTLINE_PX * dx[side], y + OUTLINE_PX * dy[side]);
      if (!std::isfinite(beyond_m) || beyond_m < z_m - tolerance_m)
        continue;  // not measured, or hidden by something else
      ++outline_;
      const bool steps = beyond_m > z_m + MIN_STEP_M;
      if (steps)
        ++behind_;
      if (steps || changesAt(x, y, dx[side], dy[side]))
        ++edges_;
    }
  }

  const Scene& scene_;
  const ObjectKnowledge& object_;
  Eigen::Matrix3f R_camera_model_;
  Crop crop_;
  mesh::MeshView drawn_;
  cv::Mat lab_;
  int drawn_px_ = 0, explained_ = 0, occluded_ = 0, violated_ = 0, unmeasured_ = 0;
  int agreeing_ = 0, with_normal_ = 0, outline_ = 0, behind_ = 0, edges_ = 0;
  Eigen::Matrix3f normals_ = Eigen::Matrix3f::Zero();
  std::vector<int> pixels_;
  std::vector<ColorPair> colors_;
};
}  // namespace

Verification verify(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3d& T_camera_model)
{
  const Crop crop = cropOf(scene, object, T_camera_model);
  return crop.empty ? Verification() : PixelCounts(scene, object, T_camera_model, crop).result();
}

}  // namespace object_modelling::recognition
