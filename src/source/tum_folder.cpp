#include "object_modelling/source/tum_folder.h"

#include <algorithm>
#include <filesystem>
#include <future>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "camera_file.h"
#include "image_file.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/options.h"
#include "recording_list.h"
#include "text_table.h"

namespace object_modelling::source
{
namespace
{
namespace fs = std::filesystem;

/// Decodes one frame ahead in the background; that costs nothing while the caller works on the frame before.
class TumFolder : public FrameSource
{
public:
  TumFolder(std::string folder, const TumFolderOptions& options)
      : folder_(std::move(folder)),
        camera_(readCameraFile((fs::path(folder_) / "camera.yaml").string())),
        frames_(readRecordingList(folder_, options.max_stamp_difference_s)),
        has_instances_(fs::exists(fs::path(folder_) / "objects.yaml")),
        launch_(options.decode_ahead ? std::launch::async : std::launch::deferred)
  {
    if (options.use_masks)
      addMasks(folder_, &frames_);
  }

  std::optional<rgbd::RawFrame> next() override
  {
    if (!ahead_.valid())
      decodeAhead();
    if (!ahead_.valid())
      return std::nullopt;
    std::future<rgbd::RawFrame> current = std::move(ahead_);
    rgbd::RawFrame frame = current.get();
    decodeAhead();
    return frame;
  }
  std::optional<std::size_t> size() const override { return frames_.size(); }
  std::string frameId() const override { return camera_.frame_id; }
  std::string name() const override { return folder_; }

private:
  void decodeAhead()
  {
    if (next_index_ < frames_.size())
      ahead_ = std::async(launch_, [this, index = next_index_++] { return decode(frames_[index]); });
  }

  rgbd::RawFrame decode(const RecordedFrame& listed) const
  {
    rgbd::RawFrame frame;
    frame.stamp_s = listed.stamp_s;
    frame.depth_stamp_s = listed.depth_stamp_s;
    frame.color = readImage(listed.color_path, cv::IMREAD_COLOR);
    frame.depth = readImage(listed.depth_path, cv::IMREAD_ANYDEPTH);
    frame.depth_unit_m = camera_.depth_unit_m;
    frame.camera = camera_.camera;
    if (!listed.mask_path.empty())
    {
      const cv::Mat instances = readImage(listed.mask_path, cv::IMREAD_GRAYSCALE);
      frame.object_mask = has_instances_ ? instances == 1 : instances > 0;
    }
    return frame;
  }

  std::string folder_;
  CameraFile camera_;
  std::vector<RecordedFrame> frames_;
  bool has_instances_;
  std::launch launch_;
  std::size_t next_index_ = 0;
  std::future<rgbd::RawFrame> ahead_;  // last: its destructor waits for the decoder, which uses the others
};

}  // namespace

std::vector<std::string> TumFolderOptions::violations() const
{
  base::OptionsCheck check("tum_folder");
  check.inRange("max_stamp_difference_s", max_stamp_difference_s, 0.0, 10.0);
  return check.violations();
}

std::unique_ptr<FrameSource> openTumFolder(const std::string& folder, const TumFolderOptions& options)
{
  base::checked(options);
  if (!fs::is_directory(folder))
    throw base::Error(base::StatusCode::NOT_FOUND, "there is no folder " + folder);
  return std::make_unique<TumFolder>(folder, options);
}

}  // namespace object_modelling::source
