// SPDX-License-Identifier: BSD-3-Clause
// Which video node is meant, and what a node offers. A camera may come back under another number,
// and one camera has several nodes (colour, metadata): card and bus name it for good.
#pragma once

#include <cstdint>
#include <string>

#include "sources/params.h"
#include "sources/video_calls.h"

namespace sources {

/// The kernel's code of a format.
std::uint32_t fourcc_of(PixelFormat format);

/// "Z16", "YUYV" ... of the kernel's code.
std::string fourcc_text(std::uint32_t fourcc);

/// Opens the node that `device` means: a path, "name:CARD" or "bus:BUS_INFO"; of several nodes of
/// a camera the first that offers the format. The file descriptor, or -errno (-ENODEV: none fits).
int open_node(VideoCalls& calls, const std::string& device, PixelFormat format);

/// "CARD offers YUYV 640x480, Z16 480x270", for a person whose wish was refused.
std::string offers_of(VideoCalls& calls, int fd);

}  // namespace sources
