// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/page.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace viewer {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kTypes{{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".svg", "image/svg+xml"},
}};

}  // namespace

Page Page::load(const std::string& folder) {
  Page page;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    for (const auto& [extension, type] : kTypes) {
      if (entry.path().extension() != extension) continue;
      std::ifstream stream(entry.path(), std::ios::binary);
      std::string bytes{std::istreambuf_iterator<char>(stream), {}};
      page.files_['/' + entry.path().filename().string()] = {std::string(type), std::move(bytes)};
    }
  }
  if (page.find("/") == nullptr) {
    throw std::runtime_error(folder + " holds no page; build it: viewer/web/build " + folder);
  }
  return page;
}

const PageFile* Page::find(std::string_view target) const {
  const std::string_view path = target.substr(0, target.find('?'));
  const auto found = files_.find(path == "/" ? "/index.html" : path);
  return found == files_.end() ? nullptr : &found->second;
}

}  // namespace viewer
