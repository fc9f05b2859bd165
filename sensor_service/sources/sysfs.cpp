// SPDX-License-Identifier: BSD-3-Clause
#include "sources/sysfs.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

namespace sources {

std::optional<std::string> read_attribute(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return std::nullopt;
  std::array<char, 4096> text{};  // sysfs gives no more than a page
  const ssize_t size = read(fd, text.data(), text.size());
  close(fd);
  if (size < 0) return std::nullopt;
  std::string value(text.data(), static_cast<std::size_t>(size));
  while (!value.empty() && (value.back() == '\n' || value.back() == ' ')) value.pop_back();
  return value;
}

std::optional<double> read_number(const std::string& path) {
  const std::optional<std::string> text = read_attribute(path);
  if (!text) return std::nullopt;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc() || end != text->data() + text->size()) return std::nullopt;
  return value;
}

bool write_attribute(const std::string& path, std::string_view value) {
  const int fd = open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
  if (fd < 0) return false;
  const ssize_t written = write(fd, value.data(), value.size());
  close(fd);
  return written == static_cast<ssize_t>(value.size());
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  DIR* stream = opendir(folder.c_str());
  if (stream == nullptr) return names;
  while (const dirent* entry = readdir(stream)) {
    const std::string name = entry->d_name;
    if (name != "." && name != "..") names.push_back(name);
  }
  closedir(stream);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace sources
