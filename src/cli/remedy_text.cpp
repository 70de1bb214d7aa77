#include "remedy_text.h"

#include "object_modelling/pipeline/partial_object.h"

namespace object_modelling::cli
{
std::string remedyFor(const alignment::AlignmentResult& aligned, const ObjectPlace& place)
{
  const alignment::AlignmentEdge* pair = pipeline::joiningPair(aligned);
  if (pair == nullptr)
    return "no pose brought them together: record sessions that see more of the object in common";
  const std::string store = place.store.empty() ? "FILE" : place.store;
  const std::string database = place.database.empty() ? "DATABASE" : place.database;
  const std::string kept = place.store.empty() ? "to keep the sessions run again with '--store FILE'; then, " : "";
  return kept + "if a candidate of the pair is right, accept it ('object_modelling align " + place.object_id +
         " --store " + store + " --accept " + pair->session_a + " " + pair->session_b +
         "', with --candidate for another one than the best) and build again ('object_modelling model " +
         place.object_id + " --store " + store + " --database " + database + "')";
}

}  // namespace object_modelling::cli
