// SPDX-License-Identifier: BSD-3-Clause
// Text that may be shown on a terminal or a page: well-formed UTF-8 without control characters.
#pragma once

#include <string_view>

namespace runtime {

enum class LineBreaks { kRefused, kAllowed };  ///< kAllowed: newline and tab

bool is_printable_utf8(std::string_view text, LineBreaks line_breaks);

}  // namespace runtime
