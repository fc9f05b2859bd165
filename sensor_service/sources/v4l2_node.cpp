// SPDX-License-Identifier: BSD-3-Clause
#include "sources/v4l2_node.h"

#include <cerrno>
#include <string_view>

#include <linux/videodev2.h>

namespace sources {
namespace {

constexpr std::uint32_t kMaxListed = 64;  // a driver that never ends its list

/// A text of fixed length in a kernel structure.
template <std::size_t kSize>
std::string text_of(const __u8 (&bytes)[kSize]) {
  std::string text;
  for (const __u8 byte : bytes) {
    if (byte == 0) break;
    text.push_back(static_cast<char>(byte));
  }
  return text;
}

v4l2_capability capability_of(VideoCalls& calls, int fd) {
  v4l2_capability capability{};
  calls.control(fd, VIDIOC_QUERYCAP, &capability);
  return capability;
}

/// Calls visit(fourcc) for every capture format until it returns false.
template <class Visit>
void for_each_format(VideoCalls& calls, int fd, Visit visit) {
  for (std::uint32_t index = 0; index < kMaxListed; ++index) {
    v4l2_fmtdesc format{};
    format.index = index;
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (calls.control(fd, VIDIOC_ENUM_FMT, &format) != 0) return;
    if (!visit(format.pixelformat)) return;
  }
}

bool offers(VideoCalls& calls, int fd, std::uint32_t fourcc) {
  bool is_found = false;
  for_each_format(calls, fd, [&](std::uint32_t offered) {
    is_found = offered == fourcc;
    return !is_found;
  });
  return is_found;
}

std::string side_text(std::uint32_t width, std::uint32_t height) {
  std::string text = std::to_string(width);
  return text.append("x").append(std::to_string(height));
}

std::string sizes_of(VideoCalls& calls, int fd, std::uint32_t fourcc) {
  std::string text;
  for (std::uint32_t index = 0; index < kMaxListed; ++index) {
    v4l2_frmsizeenum size{};
    size.index = index;
    size.pixel_format = fourcc;
    if (calls.control(fd, VIDIOC_ENUM_FRAMESIZES, &size) != 0) break;
    text.append(" ");
    if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      text.append(side_text(size.discrete.width, size.discrete.height));
      continue;
    }
    const v4l2_frmsize_stepwise& range = size.stepwise;
    return text.append(side_text(range.min_width, range.min_height))
        .append(" to ")
        .append(side_text(range.max_width, range.max_height));
  }
  return text;
}

}  // namespace

std::uint32_t fourcc_of(PixelFormat format) {
  return format == PixelFormat::kZ16 ? V4L2_PIX_FMT_Z16 : V4L2_PIX_FMT_Y16;
}

std::string fourcc_text(std::uint32_t fourcc) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const auto letter = static_cast<char>((fourcc >> shift) & 0x7FU);
    if (letter != ' ') text.push_back(letter);
  }
  return text;
}

int open_node(VideoCalls& calls, const std::string& device, PixelFormat format) {
  constexpr std::string_view kByName = "name:";
  constexpr std::string_view kByBus = "bus:";
  const bool is_name = device.starts_with(kByName);
  if (!is_name && !device.starts_with(kByBus)) return calls.open(device);
  const std::string wanted = device.substr(is_name ? kByName.size() : kByBus.size());
  for (const std::string& path : calls.nodes()) {
    const int fd = calls.open(path);
    if (fd < 0) continue;
    const v4l2_capability capability = capability_of(calls, fd);
    const std::string own = is_name ? text_of(capability.card) : text_of(capability.bus_info);
    if (own == wanted && (capability.device_caps & V4L2_CAP_VIDEO_CAPTURE) != 0 &&
        offers(calls, fd, fourcc_of(format)))
      return fd;
    calls.close(fd);
  }
  return -ENODEV;
}

std::string offers_of(VideoCalls& calls, int fd) {
  std::string text = text_of(capability_of(calls, fd).card) + " offers";
  bool is_first = true;
  for_each_format(calls, fd, [&](std::uint32_t fourcc) {
    text.append(is_first ? " " : ", ")
        .append(fourcc_text(fourcc))
        .append(sizes_of(calls, fd, fourcc));
    is_first = false;
    return true;
  });
  return is_first ? text + " no capture format" : text;
}

}  // namespace sources
