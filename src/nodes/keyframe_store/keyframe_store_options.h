#pragma once

#include <string>
#include <vector>

#include "session_preview.h"

namespace object_modelling::nodes
{
struct KeyframeStoreOptions
{
  std::string store_path;                    ///< SQLite file, see dataPath("keyframes.sqlite"), or "postgresql://..."
  std::string session_frame_id = "session";  ///< frame of the previews
  double preview_rate_hz = 2;                ///< previews are published at most this often
  SessionPreviewOptions preview;
  std::vector<std::string> violations() const;
};

template <typename Reader>
void read(Reader& reader, KeyframeStoreOptions* options)
{
  reader.read("store_path", options->store_path);
  reader.read("session_frame_id", options->session_frame_id);
  reader.read("preview_rate_hz", options->preview_rate_hz);
  reader.read("preview/voxel_size_m", options->preview.voxel_size_m);
  reader.read("preview/max_depth_m", options->preview.max_depth_m);
  reader.read("preview/max_points", options->preview.max_points);
  reader.read("preview/max_keyframes", options->preview.max_keyframes);
}

}  // namespace object_modelling::nodes
