// SPDX-License-Identifier: BSD-3-Clause
// Attributes of a device as files with one value each. Nothing throws: a device may vanish between
// any two calls.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sources {

/// The text without the end of line; none when it cannot be read.
std::optional<std::string> read_attribute(const std::string& path);

/// The number; none when it cannot be read or is none.
std::optional<double> read_number(const std::string& path);

/// False when the file is not there or the device refuses the value.
bool write_attribute(const std::string& path, std::string_view value);

/// Names of what is in a folder, in ascending order; none when it cannot be read.
std::vector<std::string> names_in(const std::string& folder);

}  // namespace sources
