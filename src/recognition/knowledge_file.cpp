#include "knowledge_file.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <boost/crc.hpp>
#include <cereal/archives/binary.hpp>
#include <cereal/types/string.hpp>
#include <opencv2/core/version.hpp>

#include "object_modelling/base/atomic_file.h"

namespace object_modelling::recognition
{
namespace
{
// Counts the changes of the file and of what is learnt.
constexpr char FORMAT[] = "object_modelling recognition 1";
constexpr std::size_t CHECKSUM_SIZE = sizeof(std::uint32_t);

/// The bytes of a vector's elements, which hold nothing but numbers.
template <class Archive, class T>
void numbers(Archive& archive, std::vector<T>& values)
{
  cereal::size_type count = values.size();
  archive(cereal::make_size_tag(count));
  values.resize(static_cast<std::size_t>(count));
  archive(cereal::binary_data(values.data(), values.size() * sizeof(T)));
}

template <class Archive>
void matrix(Archive& archive, cv::Mat& values)
{
  int rows = values.rows, columns = values.cols, type = values.type();
  archive(rows, columns, type);
  values.create(rows, columns, type);
  archive(cereal::binary_data(values.data, values.total() * values.elemSize()));
}

template <class Archive>
void surface(Archive& archive, ColoredSurface& surface)
{
  numbers(archive, surface.oriented.points);
  numbers(archive, surface.oriented.normals);
  numbers(archive, surface.lab);
}

std::uint32_t checksumOf(const char* bytes, std::size_t size)
{
  boost::crc_32_type crc;
  crc.process_bytes(bytes, size);
  return crc.checksum();
}
}  // namespace

template <class Archive>
void archivePairs(Archive& archive, PairTable& table)
{
  archive(table.spacing_m_, table.diameter_m_, table.angle_bins_, table.turn_bins_, table.distance_bins_);
  numbers(archive, table.points_.points);
  numbers(archive, table.points_.normals);
  numbers(archive, table.T_reference_model_);
  numbers(archive, table.starts_);
  numbers(archive, table.entries_);
}

namespace
{
template <class Archive>
void knowledge(Archive& archive, ObjectKnowledge& object)
{
  numbers(archive, object.mesh.vertices);
  numbers(archive, object.mesh.normals);
  numbers(archive, object.mesh.colors);
  numbers(archive, object.mesh.seen);
  numbers(archive, object.mesh.triangles);
  surface(archive, object.surface);
  surface(archive, object.texture);
  archive(object.colored);
  archivePairs(archive, object.pairs);
  numbers(archive, object.feature_points);
  matrix(archive, object.descriptors);
  archive(object.norm);
}
}  // namespace

std::string knowledgeKey(const std::string& content_hash, const LearningOptions& options)
{
  std::ostringstream key;
  key.precision(17);
  key << FORMAT << " OpenCV " << CV_VERSION << " " << content_hash;
  for (const double value :
       { static_cast<double>(options.max_views), static_cast<double>(options.max_features_per_view),
         static_cast<double>(options.max_triangles), options.max_mesh_error_m,
         static_cast<double>(options.surface_points), static_cast<double>(options.texture_points),
         options.pairs.spacing_ratio, options.pairs.max_spacing_m, static_cast<double>(options.pairs.angle_bins),
         static_cast<double>(options.pairs.turn_bins), static_cast<double>(options.pairs.max_points) })
    key << " " << value;
  return key.str();
}

bool readKnowledge(const std::string& path, const std::string& key, ObjectKnowledge* object)
{
  try
  {
    std::string bytes = base::readTextFile(path);
    if (bytes.size() < CHECKSUM_SIZE)
      return false;
    std::uint32_t checksum = 0;
    std::copy_n(bytes.data(), CHECKSUM_SIZE, reinterpret_cast<char*>(&checksum));
    if (checksumOf(bytes.data() + CHECKSUM_SIZE, bytes.size() - CHECKSUM_SIZE) != checksum)
      return false;
    std::istringstream stream(std::move(bytes));
    stream.ignore(CHECKSUM_SIZE);
    cereal::BinaryInputArchive archive(stream);
    std::string found_key;
    archive(found_key);
    if (found_key != key)
      return false;
    ObjectKnowledge read = *object;
    knowledge(archive, read);
    *object = std::move(read);
    return true;
  }
  catch (const std::exception&)
  {
    return false;  // not there, or its numbers are in another order than this machine's
  }
}

void writeKnowledge(const std::string& path, const std::string& key, const ObjectKnowledge& object)
{
  std::ostringstream stream;
  {
    cereal::BinaryOutputArchive archive(stream);
    archive(key);
    knowledge(archive, const_cast<ObjectKnowledge&>(object));  // one function reads and writes
  }
  const std::string bytes = stream.str();
  const std::uint32_t checksum = checksumOf(bytes.data(), bytes.size());
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(&checksum), CHECKSUM_SIZE);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file)
    throw base::Error(base::StatusCode::STORAGE, "cannot write " + path + ": is the disk full?");
}

}  // namespace object_modelling::recognition
