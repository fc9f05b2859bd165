// SPDX-License-Identifier: BSD-3-Clause
// One depth camera of the kernel: opened, agreed with on format and size, streaming from mapped
// buffers. Knows nothing of heads; when and whether to open again is the source's business.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sources/params.h"
#include "sources/video_calls.h"

namespace sources {

/// What the kernel says of a frame besides its pixels.
struct FrameStamp {
  std::optional<std::int64_t> monotonic_us;  ///< none when the driver uses another clock
  std::uint32_t sequence = 0;                ///< +1 per frame of the device; a gap is a loss
};

enum class TakeResult { kNothing, kFrame, kLost };

class V4l2Camera {
 public:
  V4l2Camera(VideoCalls& calls, const V4l2Params& params, int frames_per_s);
  ~V4l2Camera();
  V4l2Camera(const V4l2Camera&) = delete;
  V4l2Camera& operator=(const V4l2Camera&) = delete;

  /// "" and it streams, or why not, with what was offered instead.
  std::string open(const std::string& device);
  void close();
  bool is_open() const { return fd_ >= 0; }
  int fd() const { return fd_; }

  /// The newest waiting frame as millimetres, older ones are passed over. depth_mm has width x
  /// height elements. kLost: the device is gone, see problem().
  TakeResult take(std::span<std::int16_t> depth_mm, FrameStamp& stamp);

  const std::string& problem() const { return problem_; }
  std::int64_t num_damaged() const { return num_damaged_; }

 private:
  struct Buffer {
    void* address = nullptr;
    std::size_t num_bytes = 0;
  };

  std::string agree_on_format();
  void ask_for_rate();
  std::string start_streaming();
  bool map_buffer(std::uint32_t index);
  TakeResult lost(const std::string& problem);

  VideoCalls& calls_;
  V4l2Params params_;
  int frames_per_s_;
  int fd_ = -1;
  int stride_bytes_ = 0;
  std::vector<Buffer> buffers_;
  std::string problem_;
  std::int64_t num_damaged_ = 0;  ///< frames marked so by the driver, or too short
};

}  // namespace sources
