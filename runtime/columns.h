// SPDX-License-Identifier: BSD-3-Clause
// Messages hold parallel arrays (one column per member), libraries hold vectors of structs: one
// line per column.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

namespace runtime {

/// column[i] = member(rows[i]), converted to the column's type.
template <class Value, class Row, class Member>
void fill_column(std::vector<Value>& column, const std::vector<Row>& rows, Member member) {
  column.clear();
  std::transform(rows.begin(), rows.end(), std::back_inserter(column),
                 [&](const Row& row) { return static_cast<Value>(member(row)); });
}

/// The count field that belongs to columns filled from rows.
template <class Row>
std::int32_t count(const std::vector<Row>& rows) {
  return static_cast<std::int32_t>(rows.size());
}

}  // namespace runtime
