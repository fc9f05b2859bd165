// SPDX-License-Identifier: BSD-3-Clause
// The files of the page, read into memory at the start: no request ever names a file of the disk.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace viewer {

struct PageFile {
  std::string type;  ///< "text/html; charset=utf-8"
  std::string bytes;
};

class Page {
 public:
  /// Every file right inside `folder`; throws std::runtime_error where there is no index.html.
  static Page load(const std::string& folder);

  /// "/" is index.html; nullptr for what the page does not have. A query is passed over.
  const PageFile* find(std::string_view target) const;

 private:
  std::map<std::string, PageFile, std::less<>> files_;  ///< by "/name"
};

}  // namespace viewer
