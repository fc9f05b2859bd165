// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/drill_report.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace robot_in_a_box {
namespace {

constexpr int kNumRows = 32;

double ms(std::int64_t time_us) {
  return time_us < 0 ? -1.0 : 1e-3 * static_cast<double>(time_us);
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') out += '\\';
    if (static_cast<unsigned char>(letter) >= 0x20) out += letter;
  }
  return out + "\"";
}

std::string hex(std::uint64_t number) {
  char text[20];
  std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(number));
  return text;
}

std::int64_t num_bad_seeds(const DrillReport& report) {
  return std::count_if(report.seeds.begin(), report.seeds.end(),
                       [](const SeedResult& seed) { return seed.num_violations > 0; });
}

void print_row(const RowScore& row) {
  const std::string id = std::to_string(row.row->number) + row.row->part;
  std::printf("%-4s %-31.31s %-37.37s %6d %6d %6d %8.0f %8.1f\n", id.c_str(), row.row->fault,
              row.row->injected, row.cases, row.missed, row.unseen, ms(row.row->bound_us),
              ms(row.worst_us));
  for (const std::string& miss : row.misses) std::printf("       %s\n", miss.c_str());
}

void write_row(const RowScore& row, std::ostream& out) {
  out << "    {\"row\": " << row.row->number << ", \"part\": " << quoted(row.row->part)
      << ", \"fault\": " << quoted(row.row->fault)
      << ", \"injected\": " << quoted(row.row->injected)
      << ", \"reaction\": " << quoted(row.row->reaction) << ", \"cases\": " << row.cases
      << ", \"missed\": " << row.missed << ", \"unseen\": " << row.unseen
      << ", \"bound_ms\": " << ms(row.row->bound_us) << ", \"worst_ms\": " << ms(row.worst_us)
      << ", \"misses\": [";
  for (std::size_t i = 0; i < row.misses.size(); ++i) {
    out << (i == 0 ? "" : ", ") << quoted(row.misses[i]);
  }
  out << "]}";
}

}  // namespace

std::vector<int> rows_not_run(const DrillReport& report) {
  std::vector<int> missing;
  for (int number = 1; number <= kNumRows; ++number) {
    const bool ran = std::any_of(
        report.table.rows.begin(), report.table.rows.end(),
        [number](const RowScore& row) { return row.row->number == number && row.cases > 0; });
    if (!ran && report.not_asked_for.count(number) == 0) missing.push_back(number);
  }
  return missing;
}

int num_missed(const DrillReport& report) {
  int num = report.kills.missed + static_cast<int>(num_bad_seeds(report));
  for (const RowScore& row : report.table.rows) num += row.missed;
  return num;
}

void print(const DrillReport& report) {
  std::printf("%-4s %-31s %-37s %6s %6s %6s %8s %8s\n", "row", "fault", "injected", "cases",
              "missed", "unseen", "bound ms", "worst ms");
  for (const RowScore& row : report.table.rows) {
    if (report.not_asked_for.count(row.row->number) == 0) print_row(row);
  }
  for (const int number : rows_not_run(report)) {
    std::printf("%-4d not run: no situation in which it applies was reached\n", number);
  }
  std::printf("%d situations\n", report.table.num_situations);
  if (report.kills.kills > 0) {
    std::printf("kill -9: %d, missed %d, quick stop begun after %.0f ms at most\n",
                report.kills.kills, report.kills.missed, ms(report.kills.worst_us));
    for (const std::string& miss : report.kills.misses) std::printf("       %s\n", miss.c_str());
  }
  for (const SeedResult& seed : report.seeds) {
    const bool alone = report.seeds.size() == 1;
    if (seed.num_violations == 0 && !alone) continue;
    std::printf("seed %llu (%s), frames %s: %s\n", static_cast<unsigned long long>(seed.seed),
                seed.situation.c_str(), hex(seed.frame_hash).c_str(),
                seed.num_violations == 0 ? "no violation" : seed.first_violation.c_str());
  }
  if (!report.seeds.empty()) {
    std::int64_t num_targets = 0;
    for (const SeedResult& seed : report.seeds) num_targets += seed.num_targets;
    std::printf("random: %zu seeds, %lld with a violated invariant, %lld targets checked\n",
                report.seeds.size(), static_cast<long long>(num_bad_seeds(report)),
                static_cast<long long>(num_targets));
  }
  std::printf("%d missed\n", num_missed(report));
}

bool write_json(const DrillReport& report, const std::string& path) {
  std::ostringstream out;
  out << "{\n  \"situations\": " << report.table.num_situations
      << ",\n  \"missed\": " << num_missed(report) << ",\n  \"not_run\": [";
  const std::vector<int> missing = rows_not_run(report);
  for (std::size_t i = 0; i < missing.size(); ++i) out << (i == 0 ? "" : ", ") << missing[i];
  out << "],\n  \"rows\": [\n";
  bool first = true;
  for (const RowScore& row : report.table.rows) {
    if (report.not_asked_for.count(row.row->number) > 0) continue;
    if (!first) out << ",\n";
    first = false;
    write_row(row, out);
  }
  out << "\n  ],\n  \"kills\": {\"cases\": " << report.kills.kills
      << ", \"missed\": " << report.kills.missed << ", \"worst_ms\": " << ms(report.kills.worst_us)
      << "},\n  \"random\": {\"seeds\": " << report.seeds.size()
      << ", \"violated\": " << num_bad_seeds(report) << ", \"failures\": [";
  first = true;
  for (const SeedResult& seed : report.seeds) {
    if (seed.num_violations == 0) continue;
    out << (first ? "" : ", ") << "{\"seed\": " << seed.seed << ", \"frames\": \""
        << hex(seed.frame_hash) << "\", \"first\": " << quoted(seed.first_violation) << "}";
    first = false;
  }
  out << "]}\n}\n";
  std::ofstream file(path);
  file << out.str();
  return static_cast<bool>(file.flush());
}

}  // namespace robot_in_a_box
