#include "pcd_files.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>

#include "object_modelling/base/status.h"
#include "object_modelling/database/cloud_file.h"

namespace object_modelling::database
{
void damaged(const std::string& path, const std::string& reason)
{
  throw base::Error(base::StatusCode::BAD_INPUT, path + " cannot be read: " + reason + "; build the object again");
}

namespace
{
using base::Error;
using base::StatusCode;

const std::vector<std::string> CLOUD_FIELDS = { "x",        "y",   "z",      "normal_x", "normal_y",
                                                "normal_z", "rgb", "weight", "sigma_m" };
const std::vector<std::string> VIEW_FIELDS = { "x", "y", "z", "rgb" };

/// All our fields are 4-byte floats, packed; PCL keeps a colour in the bits of one.
pcl::PCLPointCloud2 emptyCloud(const std::vector<std::string>& fields, std::size_t width, std::size_t height)
{
  pcl::PCLPointCloud2 cloud;
  for (const std::string& name : fields)
  {
    pcl::PCLPointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(sizeof(float) * cloud.fields.size());
    field.datatype = pcl::PCLPointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  cloud.width = static_cast<std::uint32_t>(width);
  cloud.height = static_cast<std::uint32_t>(height);
  cloud.point_step = static_cast<std::uint32_t>(sizeof(float) * fields.size());
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.data.resize(static_cast<std::size_t>(cloud.row_step) * cloud.height);
  return cloud;
}

float packedColor(std::uint32_t red, std::uint32_t green, std::uint32_t blue)
{
  const std::uint32_t bits = red << 16 | green << 8 | blue;
  float packed = 0;
  std::memcpy(&packed, &bits, sizeof(packed));
  return packed;
}

// Through a stream of our own rather than by PCL's memory mapping, which turns a full disk into a signal.
void write(const std::string& path, const pcl::PCLPointCloud2& cloud)
{
  std::ofstream file(path, std::ios::binary);
  pcl::PCDWriter writer;
  const bool encoded = file && writer.writeBinaryCompressed(file, cloud) == 0;
  file.close();
  if (!encoded || !file)
    throw Error(StatusCode::STORAGE, "cannot write " + path +
                                         ": check that its folder is writable and the disk has "
                                         "space");
}

/// PCL maps the file without checking its sizes, so a truncated one would end the process.
void checkLength(const std::string& path, const pcl::PCLPointCloud2& header, int data_type, std::size_t data_offset)
{
  constexpr int BINARY = 1, BINARY_COMPRESSED = 2;
  const std::size_t points_size = static_cast<std::size_t>(header.width) * header.height * header.point_step;
  const std::size_t file_size = std::filesystem::file_size(path);
  if (data_type == BINARY && file_size < data_offset + points_size)
    damaged(path, "it is shorter than its header says");
  if (data_type != BINARY_COMPRESSED)
    return;
  std::uint32_t sizes[2] = { 0, 0 };  // compressed, uncompressed
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(data_offset));
  file.read(reinterpret_cast<char*>(sizes), sizeof(sizes));
  if (!file || file_size < data_offset + sizeof(sizes) + sizes[0] || sizes[1] != points_size)
    damaged(path, "it is shorter than its header says");
}

std::vector<std::size_t> offsetsOf(const pcl::PCLPointCloud2& cloud, const std::string& path)
{
  std::vector<std::size_t> offsets;
  for (const std::string& name : CLOUD_FIELDS)
  {
    std::size_t i = 0;
    while (i < cloud.fields.size() && cloud.fields[i].name != name)
      ++i;
    if (i == cloud.fields.size() || cloud.fields[i].count != 1 ||
        pcl::getFieldSize(cloud.fields[i].datatype) != static_cast<int>(sizeof(float)))
      damaged(path, "it has no float field " + name);
    offsets.push_back(cloud.fields[i].offset);
  }
  return offsets;
}
pcl::PCLPointCloud2 read(const std::string& path)
{
  pcl::PCLPointCloud2 file;
  try
  {
    pcl::PCDReader reader;
    Eigen::Vector4f origin;
    Eigen::Quaternionf orientation;
    int version = 0, data_type = 0;
    unsigned int data_offset = 0;
    if (reader.readHeader(path, file, origin, orientation, version, data_type, data_offset) != 0)
      damaged(path, "it is no PCD file");
    // PCL reads on after a header without points or fields, and fails badly.
    if (static_cast<std::size_t>(file.width) * file.height == 0)
      damaged(path, "it holds no points");
    offsetsOf(file, path);
    checkLength(path, file, data_type, data_offset);
    if (reader.read(path, file) != 0)
      damaged(path, "it is not a whole PCD file");
  }
  catch (const Error&)
  {
    throw;
  }
  catch (const std::exception& error)  // PCL's own, and std::bad_alloc for sizes of a malformed header
  {
    damaged(path, error.what());
  }
  return file;
}
}  // namespace

void writeCloud(const std::string& path, const fusion::FusedCloud& cloud)
{
  const std::size_t count = cloud.size();
  if (cloud.normals.size() != count || cloud.colors.size() != count || cloud.weights.size() != count ||
      cloud.sigmas_m.size() != count)
    throw Error(StatusCode::INVALID_ARGUMENT,
                "the cloud's points, normals, colours, weights and sigmas differ in "
                "number");
  if (count == 0)
    throw Error(StatusCode::INVALID_ARGUMENT, "the cloud is empty");
  pcl::PCLPointCloud2 file = emptyCloud(CLOUD_FIELDS, count, 1);
  for (std::size_t i = 0; i < count; ++i)
  {
    const Eigen::Vector3f& p = cloud.points[i];
    const Eigen::Vector3f& n = cloud.normals[i];
    const auto& color = cloud.colors[i];
    const float values[] = { p.x(),
                             p.y(),
                             p.z(),
                             n.x(),
                             n.y(),
                             n.z(),
                             packedColor(color.x(), color.y(), color.z()),
                             cloud.weights[i],
                             cloud.sigmas_m[i] };
    std::memcpy(file.data.data() + i * file.point_step, values, sizeof(values));
  }
  write(path, file);
}

fusion::FusedCloud readCloud(const std::string& path)
{
  if (!std::filesystem::is_regular_file(path))
    throw Error(StatusCode::NOT_FOUND, "there is no cloud " + path);
  const pcl::PCLPointCloud2 file = read(path);
  const std::vector<std::size_t> offsets = offsetsOf(file, path);
  const std::size_t count = static_cast<std::size_t>(file.width) * file.height;
  if (file.data.size() != count * file.point_step)
    damaged(path, "it is shorter than its header says");
  fusion::FusedCloud cloud;
  for (std::size_t i = 0; i < count; ++i)
  {
    float values[9];
    for (std::size_t k = 0; k < offsets.size(); ++k)
      std::memcpy(&values[k], file.data.data() + i * file.point_step + offsets[k], sizeof(float));
    std::uint32_t bits = 0;
    std::memcpy(&bits, &values[6], sizeof(bits));
    cloud.points.emplace_back(values[0], values[1], values[2]);
    cloud.normals.emplace_back(values[3], values[4], values[5]);
    cloud.colors.emplace_back(static_cast<std::uint8_t>(bits >> 16), static_cast<std::uint8_t>(bits >> 8),
                              static_cast<std::uint8_t>(bits));
    cloud.weights.push_back(values[7]);
    cloud.sigmas_m.push_back(values[8]);
  }
  return cloud;
}

void writeOrganizedCloud(const std::string& path, const rgbd::Frame& frame)
{
  const cv::Mat& color = frame.color_bgr;
  pcl::PCLPointCloud2 file = emptyCloud(VIEW_FIELDS, color.cols, color.rows);
  file.is_dense = false;
  for (int v = 0; v < color.rows; ++v)
    for (int u = 0; u < color.cols; ++u)
    {
      const Eigen::Vector3f p = frame.point(u, v);
      const bool valid = p.z() > 0;
      const float missing = std::numeric_limits<float>::quiet_NaN();  // one bit pattern, whatever the depth held
      const auto& bgr = color.at<cv::Vec3b>(v, u);
      const float values[] = { valid ? p.x() : missing, valid ? p.y() : missing, valid ? p.z() : missing,
                               packedColor(bgr[2], bgr[1], bgr[0]) };
      std::memcpy(file.data.data() + static_cast<std::size_t>(v) * file.row_step + u * sizeof(values), values,
                  sizeof(values));
    }
  write(path, file);
}

}  // namespace object_modelling::database
