#include <soci/soci.h>

#include "store_rows.h"

namespace object_modelling::keyframes
{
std::vector<AlignmentRecord> selectAlignments(soci::session& sql)
{
  AlignmentRecord row;
  soci::statement statement = (sql.prepare << "SELECT session_a, session_b, findings FROM session_alignments "
                                              "ORDER BY session_a, session_b",
                               soci::into(row.session_a), soci::into(row.session_b), soci::into(row.findings));
  std::vector<AlignmentRecord> records;
  for (bool more = statement.execute(true); more; more = statement.fetch())
    records.push_back(row);
  return records;
}

void replaceAlignment(soci::session& sql, const AlignmentRecord& record)
{
  selectSession(sql, record.session_a);
  selectSession(sql, record.session_b);
  sql << "DELETE FROM session_alignments WHERE (session_a = :a AND session_b = :b) OR (session_a = :c AND session_b = "
         ":d)",
      soci::use(record.session_a, "a"), soci::use(record.session_b, "b"), soci::use(record.session_b, "c"),
      soci::use(record.session_a, "d");
  if (!record.findings.empty())
    sql << "INSERT INTO session_alignments (session_a, session_b, findings) VALUES (:a, :b, :findings)",
        soci::use(record.session_a, "a"), soci::use(record.session_b, "b"), soci::use(record.findings, "findings");
}

}  // namespace object_modelling::keyframes
