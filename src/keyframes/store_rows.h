#pragma once

#include <string>
#include <vector>

#include "keyframe_codec.h"
#include "object_modelling/keyframes/session.h"
#include "object_modelling/keyframes/session_store.h"
#include "sql_dialect.h"

/// The statements of the store. All run within a transaction of the caller's and throw soci::soci_error, or base::Error
/// (NOT_FOUND, FAILED_PRECONDITION) naming the session and keyframe.
namespace object_modelling::keyframes
{
void insertSession(soci::session& sql, const Session& session);
std::vector<Session> selectSessions(soci::session& sql);
Session selectSession(soci::session& sql, const std::string& session_id);
/// Of the session alone: its poses and masks are the keyframes'.
void updateSessionRow(soci::session& sql, const std::string& session_id, const SessionChange& change);
void deleteSessionRows(soci::session& sql, const std::string& session_id);

void insertKeyframe(soci::session& sql, const SqlDialect& dialect, const std::string& session_id,
                    const EncodedKeyframe& row);
std::vector<int> selectKeyframeIds(soci::session& sql, const std::string& session_id);
EncodedKeyframe selectKeyframe(soci::session& sql, const SqlDialect& dialect, const std::string& session_id,
                               int keyframe_id);
void updatePose(soci::session& sql, const std::string& session_id, const PoseUpdate& update);
void updateMask(soci::session& sql, const SqlDialect& dialect, const std::string& session_id, const MaskUpdate& update);

std::vector<AlignmentRecord> selectAlignments(soci::session& sql);
/// Of that pair, in either order; one without findings is only taken away.
void replaceAlignment(soci::session& sql, const AlignmentRecord& record);

}  // namespace object_modelling::keyframes
