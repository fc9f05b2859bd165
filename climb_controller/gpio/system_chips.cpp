// SPDX-License-Identifier: BSD-3-Clause
// What both versions of libgpiod have in common: where chips are, and edges, which are read from
// the kernel directly because nobody wants to know them.
#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "gpio/gpiod_chip.h"

namespace gpio {

std::vector<std::string> SystemChips::paths() const {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", error)) {
    const bool is_chip = entry.path().filename().string().starts_with("gpiochip");
    if (is_chip && entry.is_character_file(error) && !entry.is_symlink(error)) {
      paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

void make_non_blocking(int fd) {
  ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
}

void discard_edges(int fd) {
  constexpr int kMaxReads = 8;  // the kernel keeps at most 16 edges per line
  std::array<char, 1024> edges{};
  for (int i = 0; i<kMaxReads&& ::read(fd, edges.data(), edges.size())> 0; ++i) {
  }
}

}  // namespace gpio
