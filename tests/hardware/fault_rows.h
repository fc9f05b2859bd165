// SPDX-License-Identifier: BSD-3-Clause
// What ladder_fault_rows finds about one row of the fault table, and those rows that need the
// programs and LCM.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hardware {

/// For an emulated machine, on top of a bound.
inline constexpr int kAllowed_ms = 50;

struct RowTitle {
  int number;
  const char* what;
  int bound_ms;
};

struct RowResult {
  std::vector<double> times_ms;  ///< of the reactions that came
  int missed = 0;                ///< none, a wrong one, or a late one
  std::int64_t violations = 0;   ///< seen by the monitor of bus, lines and truth
  std::vector<std::string> complaints;

  void miss(const std::string& why) {
    ++missed;
    complaints.push_back(why);
  }
  /// Late is missed.
  void add(double time_ms, int bound_ms) {
    times_ms.push_back(time_ms);
    if (time_ms > bound_ms + kAllowed_ms) miss("late: " + std::to_string(time_ms) + " ms");
  }
};

/// Rows 26 (a second program), 28 and 31 on climb_controller itself: `bin` holds the programs.
std::vector<RowTitle> process_rows();
RowResult run_process_row(int number, int repetitions, const std::string& bin,
                          const std::string& chip_folder);

}  // namespace hardware
