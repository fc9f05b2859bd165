// SPDX-License-Identifier: BSD-3-Clause
#include "sources/v4l2_camera.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <linux/videodev2.h>

#include "sources/depth_counts.h"
#include "sources/v4l2_node.h"

namespace sources {
namespace {

constexpr std::uint32_t kNumBuffers = 4;  // a frame in work and a late step: 200 ms at 15 Hz

std::string reason(const std::string& call, int result) {
  return call + ": " + std::strerror(-result);
}

v4l2_buffer capture_buffer(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

FrameStamp stamp_of(const v4l2_buffer& buffer) {
  FrameStamp stamp;
  stamp.sequence = buffer.sequence;
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
    stamp.monotonic_us =
        static_cast<std::int64_t>(buffer.timestamp.tv_sec) * 1'000'000 + buffer.timestamp.tv_usec;
  }
  return stamp;
}

}  // namespace

V4l2Camera::V4l2Camera(VideoCalls& calls, const V4l2Params& params, int frames_per_s)
    : calls_(calls), params_(params), frames_per_s_(frames_per_s) {
  buffers_.reserve(kNumBuffers);
}

V4l2Camera::~V4l2Camera() {
  close();
}

std::string V4l2Camera::open(const std::string& device) {
  close();
  const int result = open_node(calls_, device, params_.format);
  if (result < 0) return reason("cannot be opened", result);
  fd_ = result;
  std::string problem = agree_on_format();
  if (problem.empty()) problem = start_streaming();
  if (!problem.empty()) close();
  return problem;
}

void V4l2Camera::close() {
  if (fd_ < 0) return;
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  calls_.control(fd_, VIDIOC_STREAMOFF, &type);
  for (const Buffer& buffer : buffers_) calls_.unmap(buffer.address, buffer.num_bytes);
  buffers_.clear();
  calls_.close(fd_);
  fd_ = -1;
}

std::string V4l2Camera::agree_on_format() {
  v4l2_capability capability{};
  if (const int result = calls_.control(fd_, VIDIOC_QUERYCAP, &capability); result != 0)
    return reason("is no video device", result);
  constexpr std::uint32_t kNeeded = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  if ((capability.device_caps & kNeeded) != kNeeded) return "captures no video by streaming";

  const std::uint32_t fourcc = fourcc_of(params_.format);
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<std::uint32_t>(params_.width_px);
  format.fmt.pix.height = static_cast<std::uint32_t>(params_.height_px);
  format.fmt.pix.pixelformat = fourcc;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  const int result = calls_.control(fd_, VIDIOC_S_FMT, &format);
  if (result == -EBUSY) return reason("is used by somebody else", result);
  const v4l2_pix_format& agreed = format.fmt.pix;  // what the driver made of the wish
  const std::string wish = fourcc_text(fourcc) + " " + std::to_string(params_.width_px) + "x" +
                           std::to_string(params_.height_px);
  if (result != 0 || agreed.pixelformat != fourcc ||
      agreed.width != static_cast<std::uint32_t>(params_.width_px) ||
      agreed.height != static_cast<std::uint32_t>(params_.height_px)) {
    return "does not deliver " + wish + ": " + offers_of(calls_, fd_);
  }
  if (agreed.field != V4L2_FIELD_NONE && agreed.field != V4L2_FIELD_ANY)
    return "delivers " + wish + " interlaced only";
  const std::uint32_t row_bytes = 2 * agreed.width;
  stride_bytes_ = static_cast<int>(std::max(agreed.bytesperline, row_bytes));
  ask_for_rate();
  return "";
}

/// A driver that cannot be asked keeps its own rate; the service measures it anyway.
void V4l2Camera::ask_for_rate() {
  v4l2_streamparm rate{};
  rate.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  rate.parm.capture.timeperframe = {1, static_cast<std::uint32_t>(frames_per_s_)};
  calls_.control(fd_, VIDIOC_S_PARM, &rate);
}

std::string V4l2Camera::start_streaming() {
  v4l2_requestbuffers request{};
  request.count = kNumBuffers;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (const int result = calls_.control(fd_, VIDIOC_REQBUFS, &request); result != 0)
    return reason("gives no buffers", result);
  if (request.count < 2) return "gives fewer than two buffers";
  for (std::uint32_t index = 0; index < request.count; ++index) {
    if (!map_buffer(index)) return "its buffers cannot be mapped";
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  const int result = calls_.control(fd_, VIDIOC_STREAMON, &type);
  return result == 0 ? "" : reason("does not stream", result);
}

bool V4l2Camera::map_buffer(std::uint32_t index) {
  v4l2_buffer buffer = capture_buffer(index);
  if (calls_.control(fd_, VIDIOC_QUERYBUF, &buffer) != 0) return false;
  void* address = calls_.map(fd_, buffer.length, buffer.m.offset);
  if (address == nullptr) return false;
  buffers_.push_back({address, buffer.length});
  return calls_.control(fd_, VIDIOC_QBUF, &buffer) == 0;
}

TakeResult V4l2Camera::take(std::span<std::int16_t> depth_mm, FrameStamp& stamp) {
  if (fd_ < 0) return TakeResult::kNothing;
  TakeResult taken = TakeResult::kNothing;
  // As many as there are buffers: a device that is faster than this loop must not hold it.
  for (std::size_t i = 0; i < buffers_.size(); ++i) {
    v4l2_buffer buffer = capture_buffer(0);
    const int result = calls_.control(fd_, VIDIOC_DQBUF, &buffer);
    if (result == -EAGAIN) {
      // Broken and nothing to take: it will never deliver again (unplugged, or queue in error).
      const bool is_broken = i == 0 && calls_.is_broken(fd_);
      return is_broken ? lost("reports an error (POLLERR)") : taken;
    }
    if (result != 0) return lost(reason("gives no frame", result));
    if (buffer.index >= buffers_.size()) return lost("names a buffer that does not exist");
    const Buffer& mapped = buffers_[buffer.index];
    const std::size_t num_used = std::min<std::size_t>(buffer.bytesused, mapped.num_bytes);
    const CountImage image{.bytes = {static_cast<const std::uint8_t*>(mapped.address), num_used},
                           .width_px = params_.width_px,
                           .height_px = params_.height_px,
                           .stride_bytes = stride_bytes_};
    if ((buffer.flags & V4L2_BUF_FLAG_ERROR) == 0 &&
        to_depth_mm(image, {params_.depth_unit_um, params_.no_return}, depth_mm)) {
      stamp = stamp_of(buffer);
      taken = TakeResult::kFrame;
    } else {
      ++num_damaged_;
    }
    if (const int queued = calls_.control(fd_, VIDIOC_QBUF, &buffer); queued != 0)
      return lost(reason("takes no buffer back", queued));
  }
  return taken;
}

TakeResult V4l2Camera::lost(const std::string& problem) {
  problem_ = problem;
  close();
  return TakeResult::kLost;
}

}  // namespace sources
