#include <cstring>

#include "keyframe_codec.h"
#include "object_modelling/base/status.h"

namespace object_modelling::keyframes
{
namespace
{
constexpr std::size_t HEADER_BYTES = 4;
constexpr std::size_t OBSERVATION_BYTES = 20;

template <typename Unsigned>
void append(Unsigned value, std::string* bytes)
{
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
    bytes->push_back(static_cast<char>((value >> (8 * i)) & 0xff));
}

template <typename Unsigned>
Unsigned read(const char* bytes)
{
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
    value |= static_cast<Unsigned>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  return value;
}

void appendFloat(float value, std::string* bytes)
{
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  append(bits, bytes);
}

float readFloat(const char* bytes)
{
  const auto bits = read<std::uint32_t>(bytes);
  float value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}
}  // namespace

std::string encodeObservations(const std::vector<rgbd::Observation>& observations)
{
  std::string bytes;
  bytes.reserve(HEADER_BYTES + OBSERVATION_BYTES * observations.size());
  append(static_cast<std::uint32_t>(observations.size()), &bytes);
  for (const rgbd::Observation& observation : observations)
  {
    append(observation.landmark_id, &bytes);
    appendFloat(observation.pixel.x(), &bytes);
    appendFloat(observation.pixel.y(), &bytes);
    appendFloat(observation.depth_m, &bytes);
  }
  return bytes;
}

std::vector<rgbd::Observation> decodeObservations(const std::string& bytes, const std::string& what)
{
  const std::size_t count = bytes.size() < HEADER_BYTES ? 0 : read<std::uint32_t>(bytes.data());
  if (bytes.size() != HEADER_BYTES + OBSERVATION_BYTES * count)
    throw base::Error(base::StatusCode::BAD_INPUT, "observations of " + what +
                                                       " are damaged: " + std::to_string(bytes.size()) + " bytes for " +
                                                       std::to_string(count) + " observations");
  std::vector<rgbd::Observation> observations(count);
  const char* position = bytes.data() + HEADER_BYTES;
  for (rgbd::Observation& observation : observations)
  {
    observation.landmark_id = read<std::uint64_t>(position);
    observation.pixel = { readFloat(position + 8), readFloat(position + 12) };
    observation.depth_m = readFloat(position + 16);
    position += OBSERVATION_BYTES;
  }
  return observations;
}

}  // namespace object_modelling::keyframes
