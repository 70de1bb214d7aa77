#include <soci/soci.h>

#include "number_text.h"
#include "object_modelling/base/status.h"
#include "store_rows.h"

namespace object_modelling::keyframes
{
namespace
{
using base::Error;
using base::StatusCode;

[[noreturn]] void notFound(const std::string& session_id, int keyframe_id)
{
  throw Error(StatusCode::NOT_FOUND, "keyframe " + std::to_string(keyframe_id) + " is not in session '" + session_id +
                                         "'; list the session's keyframes to see which are");
}

bool exists(soci::session& sql, const std::string& session_id, int keyframe_id)
{
  int count = 0;
  sql << "SELECT COUNT(*) FROM keyframes WHERE session_id = :session_id AND keyframe_id = :keyframe_id",
      soci::into(count), soci::use(session_id), soci::use(keyframe_id);
  return count > 0;
}

void insertMask(soci::session& sql, const SqlDialect& dialect, const std::string& session_id, int keyframe_id,
                const std::string& mask_png)
{
  const std::string mask = dialect.encodeBlob(mask_png);
  sql << "INSERT INTO keyframe_masks (session_id, keyframe_id, mask_png) VALUES (:session_id, :keyframe_id, "
      << dialect.blobValue(":mask") << ")",
      soci::use(session_id), soci::use(keyframe_id), soci::use(mask);
}

void insertImages(soci::session& sql, const SqlDialect& dialect, const std::string& session_id,
                  const EncodedKeyframe& row)
{
  const std::string color = dialect.encodeBlob(row.color_png);
  const std::string depth = dialect.encodeBlob(row.depth_png);
  const std::string observations = dialect.encodeBlob(row.observations);
  const std::string moving_mask = dialect.encodeBlob(row.moving_mask_png);
  soci::indicator has_moving_mask = row.moving_mask_png.empty() ? soci::i_null : soci::i_ok;
  sql << "INSERT INTO keyframe_images (session_id, keyframe_id, color_png, depth_png, depth_unit_m, observations, "
         "moving_mask_png) VALUES (:session_id, :keyframe_id, "
      << dialect.blobValue(":color") << ", " << dialect.blobValue(":depth") << ", :depth_unit_m, "
      << dialect.blobValue(":observations") << ", " << dialect.blobValue(":moving_mask") << ")",
      soci::use(session_id), soci::use(row.id), soci::use(color), soci::use(depth), soci::use(row.depth_unit_m),
      soci::use(observations), soci::use(moving_mask, has_moving_mask);
}
}  // namespace

void insertKeyframe(soci::session& sql, const SqlDialect& dialect, const std::string& session_id,
                    const EncodedKeyframe& row)
{
  const Session session = selectSession(sql, session_id);
  if (exists(sql, session_id, row.id))
    throw Error(StatusCode::FAILED_PRECONDITION, "session '" + session_id + "' has a keyframe " +
                                                     std::to_string(row.id) +
                                                     " already; keyframe ids count up within their session");
  if (session.keyframe_count == 0 && session.started_s == 0)
    sql << "UPDATE sessions SET started_s = :stamp_s WHERE session_id = :session_id", soci::use(row.stamp_s),
        soci::use(session_id);
  const geometry::PinholeCamera& camera = row.camera;
  const std::string distortion = textFromNumbers(camera.distortion.data(), camera.distortion.size());
  sql << "INSERT INTO keyframes (session_id, keyframe_id, stamp_s, width_px, height_px, fx_px, fy_px, cx_px, cy_px, "
         "distortion, session_from_camera, covariance) VALUES (:session_id, :keyframe_id, :stamp_s, :width_px, "
         ":height_px, :fx_px, :fy_px, :cx_px, :cy_px, :distortion, :session_from_camera, :covariance)",
      soci::use(session_id), soci::use(row.id), soci::use(row.stamp_s), soci::use(camera.width),
      soci::use(camera.height), soci::use(camera.fx), soci::use(camera.fy), soci::use(camera.cx), soci::use(camera.cy),
      soci::use(distortion), soci::use(row.session_from_camera), soci::use(row.covariance);
  insertImages(sql, dialect, session_id, row);
  if (!row.mask_png.empty())
    insertMask(sql, dialect, session_id, row.id, row.mask_png);
}

std::vector<int> selectKeyframeIds(soci::session& sql, const std::string& session_id)
{
  selectSession(sql, session_id);
  soci::rowset<int> ids =
      (sql.prepare << "SELECT keyframe_id FROM keyframes WHERE session_id = :session_id ORDER BY keyframe_id",
       soci::use(session_id));
  return { ids.begin(), ids.end() };
}

EncodedKeyframe selectKeyframe(soci::session& sql, const SqlDialect& dialect, const std::string& session_id,
                               int keyframe_id)
{
  EncodedKeyframe row;
  row.id = keyframe_id;
  std::string distortion;
  soci::indicator has_mask = soci::i_null, has_moving_mask = soci::i_null;
  sql << "SELECT stamp_s, width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion, session_from_camera, "
         "covariance, color_png, depth_png, depth_unit_m, observations, moving_mask_png, mask_png FROM "
         "keyframes "
         "JOIN keyframe_images ON keyframe_images.session_id = keyframes.session_id "
         "AND keyframe_images.keyframe_id = keyframes.keyframe_id "
         "LEFT JOIN keyframe_masks ON keyframe_masks.session_id = keyframes.session_id "
         "AND keyframe_masks.keyframe_id = keyframes.keyframe_id "
         "WHERE keyframes.session_id = :session_id AND keyframes.keyframe_id = :keyframe_id",
      soci::into(row.stamp_s), soci::into(row.camera.width), soci::into(row.camera.height), soci::into(row.camera.fx),
      soci::into(row.camera.fy), soci::into(row.camera.cx), soci::into(row.camera.cy), soci::into(distortion),
      soci::into(row.session_from_camera), soci::into(row.covariance), soci::into(row.color_png),
      soci::into(row.depth_png), soci::into(row.depth_unit_m), soci::into(row.observations),
      soci::into(row.moving_mask_png, has_moving_mask), soci::into(row.mask_png, has_mask), soci::use(session_id),
      soci::use(keyframe_id);
  if (!sql.got_data())
  {
    selectSession(sql, session_id);
    notFound(session_id, keyframe_id);
  }
  row.camera.distortion = numbersFromText(distortion, "distortion of keyframe " + std::to_string(keyframe_id));
  row.color_png = dialect.decodeBlob(row.color_png);
  row.depth_png = dialect.decodeBlob(row.depth_png);
  row.observations = dialect.decodeBlob(row.observations);
  row.mask_png = has_mask == soci::i_ok ? dialect.decodeBlob(row.mask_png) : "";
  row.moving_mask_png = has_moving_mask == soci::i_ok ? dialect.decodeBlob(row.moving_mask_png) : "";
  return row;
}

void updatePose(soci::session& sql, const std::string& session_id, const PoseUpdate& update)
{
  if (!exists(sql, session_id, update.keyframe_id))
    notFound(session_id, update.keyframe_id);
  const std::string session_from_camera = textFromTransform(update.T_session_camera);
  const std::string covariance = textFromCovariance(update.covariance);
  sql << "UPDATE keyframes SET session_from_camera = :session_from_camera, covariance = :covariance "
         "WHERE session_id = :session_id AND keyframe_id = :keyframe_id",
      soci::use(session_from_camera), soci::use(covariance), soci::use(session_id), soci::use(update.keyframe_id);
}

void updateMask(soci::session& sql, const SqlDialect& dialect, const std::string& session_id, const MaskUpdate& update)
{
  int width = 0, height = 0;
  sql << "SELECT width_px, height_px FROM keyframes WHERE session_id = :session_id AND keyframe_id = :keyframe_id",
      soci::into(width), soci::into(height), soci::use(session_id), soci::use(update.keyframe_id);
  if (!sql.got_data())
    notFound(session_id, update.keyframe_id);
  const std::string mask_png = encodeMask(update.object_mask, width, height);
  sql << "DELETE FROM keyframe_masks WHERE session_id = :session_id AND keyframe_id = :keyframe_id",
      soci::use(session_id), soci::use(update.keyframe_id);
  if (!mask_png.empty())
    insertMask(sql, dialect, session_id, update.keyframe_id, mask_png);
}

}  // namespace object_modelling::keyframes
