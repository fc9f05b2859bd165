// SPDX-License-Identifier: BSD-3-Clause
// Cameras that answer the V4L2 calls as a uvcvideo depth camera does (its answers to QUERYCAP,
// ENUM_FMT and S_FMT are those of a recorded session), for a format that no virtual driver of the
// kernel offers. Every call is written down.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include <linux/videodev2.h>

#include "sources/video_calls.h"

namespace sources {

struct OfferedFormat {
  std::uint32_t fourcc = 0;
  std::vector<std::array<std::uint32_t, 2>> sizes;  ///< width, height
};

/// A frame that waits in the driver.
struct RecordedFrame {
  std::vector<std::uint16_t> counts;  ///< width x height
  std::int64_t monotonic_us = 0;
  std::uint32_t sequence = 0;
  std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  int missing_bytes = 0;  ///< the transfer broke off
};

struct RecordedCamera {
  std::string card = "Depth Camera 435";
  std::string bus = "usb-0000:00:14.0-2";
  std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<OfferedFormat> formats{{V4L2_PIX_FMT_Z16, {{480, 270}, {8, 6}}},
                                     {V4L2_PIX_FMT_YUYV, {{640, 480}}}};
  std::uint32_t padding_bytes = 0;        ///< behind every row
  std::uint32_t num_buffers = 8;          ///< most it gives
  std::map<unsigned long, int> failures;  ///< request -> errno
  bool is_plugged_in = true;
  bool is_broken = false;  ///< POLLERR
  bool keeps_calls = true;
  std::deque<RecordedFrame> waiting;

  // State of the driver.
  int fd = -1;
  std::uint32_t width = 0, height = 0;
  bool is_streaming = false;
  std::vector<std::vector<std::uint8_t>> buffers;
  std::vector<std::uint32_t> queued;  ///< the oldest first
  std::vector<std::string> calls;
};

class RecordedCameras final : public VideoCalls {
 public:
  RecordedCameras();
  ~RecordedCameras() override;

  /// The camera behind a node, e.g. "/dev/video2"; made by the first call.
  RecordedCamera& at(const std::string& path) { return cameras_[path]; }
  /// The same camera under another number.
  void move(const std::string& from, const std::string& to);

  std::vector<std::string> nodes() override;
  int open(const std::string& path) override;
  void close(int fd) override;
  int control(int fd, unsigned long request, void* argument) override;
  void* map(int fd, std::size_t num_bytes, std::int64_t offset) override;
  void unmap(void* address, std::size_t num_bytes) override;
  bool is_broken(int fd) override;

  int num_open() const { return num_open_; }
  int num_mapped() const { return num_mapped_; }

 private:
  RecordedCamera* find(int fd);

  std::map<std::string, RecordedCamera> cameras_;
  int num_open_ = 0;
  int num_mapped_ = 0;
};

}  // namespace sources
