// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/line_reader.h"

#include <array>
#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

namespace simulator {
namespace {

constexpr std::size_t kMaxLine_bytes = 4096;

}  // namespace

LineReader::LineReader(int descriptor) : descriptor_(descriptor) {
  const int flags = ::fcntl(descriptor_, F_GETFL);
  if (flags < 0 || ::fcntl(descriptor_, F_SETFL, flags | O_NONBLOCK) < 0) descriptor_ = -1;
}

std::vector<std::string> LineReader::take() {
  std::array<char, 512> bytes;
  while (descriptor_ >= 0) {
    const ssize_t got = ::read(descriptor_, bytes.data(), bytes.size());
    if (got > 0) {
      unfinished_.append(bytes.data(), static_cast<std::size_t>(got));
    } else if (got < 0 && errno == EINTR) {
      continue;
    } else {
      if (got == 0 || errno != EAGAIN) descriptor_ = -1;
      break;
    }
  }
  std::vector<std::string> lines;
  for (std::size_t end = 0; (end = unfinished_.find('\n')) != std::string::npos;) {
    lines.push_back(unfinished_.substr(0, end));
    unfinished_.erase(0, end + 1);
  }
  if (unfinished_.size() > kMaxLine_bytes) unfinished_.clear();
  return lines;
}

}  // namespace simulator
