// SPDX-License-Identifier: BSD-3-Clause
// The kernel's own cameras for a test: vivid's controls, and the feeding end of a v4l2loopback.
// Plain V4L2 with no code of ours in between.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace hardware {

/// Sets a control of a camera by the name that it lists ("Test Pattern"). Drivers number their own
/// controls differently from kernel to kernel.
inline void set_control(int fd, const std::string& name, int value) {
  v4l2_queryctrl control{};
  control.id = V4L2_CTRL_FLAG_NEXT_CTRL;
  while (ioctl(fd, VIDIOC_QUERYCTRL, &control) == 0) {
    if (name == reinterpret_cast<const char*>(control.name)) {
      v4l2_control setting{control.id, value};
      ASSERT_EQ(ioctl(fd, VIDIOC_S_CTRL, &setting), 0) << name << ": " << std::strerror(errno);
      return;
    }
    control.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  FAIL() << "no control " << name;
}

inline v4l2_format y16_format(v4l2_buf_type type, int width_px, int height_px) {
  v4l2_format format{};
  format.type = type;
  format.fmt.pix.width = static_cast<__u32>(width_px);
  format.fmt.pix.height = static_cast<__u32>(height_px);
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_Y16;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.bytesperline = static_cast<__u32>(2 * width_px);
  format.fmt.pix.sizeimage = static_cast<__u32>(2 * width_px * height_px);
  return format;
}

/// One image by read(2), the simplest way there is.
inline std::vector<std::uint16_t> read_image(const std::string& path, int width_px, int height_px) {
  std::vector<std::uint16_t> counts(static_cast<std::size_t>(width_px * height_px));
  const int fd = open(path.c_str(), O_RDWR | O_CLOEXEC);
  v4l2_format format = y16_format(V4L2_BUF_TYPE_VIDEO_CAPTURE, width_px, height_px);
  EXPECT_EQ(ioctl(fd, VIDIOC_S_FMT, &format), 0) << path << ": " << std::strerror(errno);
  EXPECT_EQ(read(fd, counts.data(), 2 * counts.size()), static_cast<ssize_t>(2 * counts.size()))
      << path << ": " << std::strerror(errno);
  close(fd);
  return counts;
}

/// The end of a v4l2loopback that images are written into.
class LoopbackFeed {
 public:
  LoopbackFeed(const std::string& path, int width_px, int height_px)
      : fd_(open(path.c_str(), O_RDWR | O_CLOEXEC)) {
    v4l2_format format = y16_format(V4L2_BUF_TYPE_VIDEO_OUTPUT, width_px, height_px);
    EXPECT_EQ(ioctl(fd_, VIDIOC_S_FMT, &format), 0) << path << ": " << std::strerror(errno);
  }
  ~LoopbackFeed() { close(fd_); }
  LoopbackFeed(const LoopbackFeed&) = delete;
  LoopbackFeed& operator=(const LoopbackFeed&) = delete;

  void write(const std::vector<std::uint16_t>& counts) const {
    EXPECT_EQ(::write(fd_, counts.data(), 2 * counts.size()),
              static_cast<ssize_t>(2 * counts.size()));
  }

 private:
  int fd_;
};

}  // namespace hardware
