#include "store_schema.h"

#include <algorithm>
#include <string>

namespace object_modelling::keyframes
{
namespace
{
using base::Error;
using base::StatusCode;

// Images, masks and poses are apart because a row is always rewritten whole: an update of a hundred poses must not
// rewrite a hundred images.
void createTables(soci::session& sql, const SqlDialect& dialect)
{
  const std::string blob = dialect.blobType() + " NOT NULL";
  const std::string key = "session_id TEXT NOT NULL, keyframe_id INTEGER NOT NULL, ";
  const std::string belongs_to_keyframe =
      "PRIMARY KEY (session_id, keyframe_id), FOREIGN KEY (session_id, keyframe_id) "
      "REFERENCES keyframes (session_id, keyframe_id) ON DELETE CASCADE)";
  sql << "CREATE TABLE sessions (session_id TEXT PRIMARY KEY NOT NULL, object_id TEXT NOT NULL, "
         "camera_frame_id TEXT NOT NULL, started_s DOUBLE PRECISION NOT NULL, reference_is_object INTEGER NOT NULL, "
         "closed INTEGER NOT NULL, "
         "support_plane_session TEXT, model_from_session TEXT)";
  sql << "CREATE TABLE keyframes (" << key
      << "stamp_s DOUBLE PRECISION NOT NULL, width_px INTEGER NOT NULL, height_px INTEGER NOT NULL, "
         "fx_px DOUBLE PRECISION NOT NULL, fy_px DOUBLE PRECISION NOT NULL, cx_px DOUBLE PRECISION NOT NULL, "
         "cy_px DOUBLE PRECISION NOT NULL, distortion TEXT NOT NULL, session_from_camera TEXT NOT NULL, "
         "covariance TEXT NOT NULL, PRIMARY KEY (session_id, keyframe_id), "
         "FOREIGN KEY (session_id) REFERENCES sessions (session_id) ON DELETE CASCADE)";
  sql << "CREATE TABLE keyframe_images (" << key << "color_png " << blob << ", depth_png " << blob
      << ", depth_unit_m DOUBLE PRECISION NOT NULL, observations " << blob << ", " << belongs_to_keyframe;
  sql << "CREATE TABLE keyframe_masks (" << key << "mask_png " << blob << ", " << belongs_to_keyframe;
}

void addCalibrationAndReport(soci::session& sql, const SqlDialect&)
{
  sql << "ALTER TABLE sessions ADD COLUMN calibration TEXT";
  sql << "ALTER TABLE sessions ADD COLUMN refinement_report TEXT NOT NULL DEFAULT ''";
}

void createAlignments(soci::session& sql, const SqlDialect&)
{
  const std::string of_session = " TEXT NOT NULL REFERENCES sessions (session_id) ON DELETE CASCADE, ";
  sql << "CREATE TABLE session_alignments (session_a" << of_session << "session_b" << of_session
      << "findings TEXT NOT NULL, PRIMARY KEY (session_a, session_b))";
}

void addStageMarks(soci::session& sql, const SqlDialect&)
{
  for (const char* column : { "refined_by", "refined_options", "segmented_by", "segmented_options" })
    sql << "ALTER TABLE sessions ADD COLUMN " << column << " TEXT NOT NULL DEFAULT ''";
  // Before this version only a stage's by-products show that it was done; how is not known.
  sql << "UPDATE sessions SET refined_by = 'unknown' WHERE refinement_report <> ''";
  sql << "UPDATE sessions SET segmented_by = 'unknown' WHERE support_plane_session IS NOT NULL";
}

// Beside the images, as a measurement of the tracker: written once, whatever becomes of the object's mask.
void addMovingMasks(soci::session& sql, const SqlDialect& dialect)
{
  sql << "ALTER TABLE keyframe_images ADD COLUMN moving_mask_png " << dialect.blobType();
}

int readVersion(soci::session& sql, const SqlDialect& dialect)
{
  const std::vector<std::string> tables = dialect.tables(sql);
  if (std::find(tables.begin(), tables.end(), "store_schema") != tables.end())
  {
    int version = 0;
    sql << "SELECT version FROM store_schema", soci::into(version);
    return version;
  }
  if (tables.empty())
    return 0;
  throw Error(StatusCode::BAD_INPUT, dialect.storeName() + " is a database, but no keyframe store (it holds a table '" +
                                         tables.front() + "'); give the keyframe store a file or database of its own");
}
}  // namespace

const std::vector<Migration>& storeMigrations()
{
  static const std::vector<Migration> MIGRATIONS = { createTables, addCalibrationAndReport, createAlignments,
                                                     addStageMarks, addMovingMasks };
  return MIGRATIONS;
}

void migrate(SqlConnection& connection, const std::vector<Migration>& migrations)
{
  const SqlDialect& dialect = connection.dialect();
  const int current = static_cast<int>(migrations.size());
  int version = 0;
  connection.read("reading the schema version", [&](soci::session& sql) { version = readVersion(sql, dialect); });
  if (version > current)
    throw Error(StatusCode::STORAGE, dialect.storeName() + " has schema version " + std::to_string(version) +
                                         ", this program knows versions up to " + std::to_string(current) +
                                         "; update object_modelling, or give it another store");
  if (version == current)
    return;
  connection.write("bringing the schema to version " + std::to_string(current),
                   [&](soci::session& sql)
                   {
                     dialect.lockSchema(sql);
                     const int start = readVersion(sql, dialect);  // another process may just have done it
                     if (start >= current)
                       return;
                     for (int step = start; step < current; ++step)
                       migrations[step](sql, dialect);
                     sql << "CREATE TABLE IF NOT EXISTS store_schema (version INTEGER NOT NULL)";
                     sql << "DELETE FROM store_schema";
                     sql << "INSERT INTO store_schema (version) VALUES (:version)", soci::use(current);
                   });
}

}  // namespace object_modelling::keyframes
