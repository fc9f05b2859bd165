// SPDX-License-Identifier: BSD-3-Clause
// Strict configuration: TOML files and --set overrides, merged in that order. Every key is read
// exactly once, in its range; a key that nobody reads is an error. All errors name file and line
// and are thrown as ConfigError before any work starts.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace runtime {

/// Wrong configuration: what, where, how to fix. Exit code 2.
struct ConfigError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Both ends included.
template <class T>
struct Range {
  T low = std::numeric_limits<T>::lowest();
  T high = std::numeric_limits<T>::max();
};

/// One named value of an enumeration as it is written in the file.
template <class T>
using Choice = std::pair<std::string_view, T>;

class Config;

/// One table of the configuration, e.g. [gng.growing]. Reading leaves the value alone where the key
/// is absent (the default stays).
class ConfigTable {
 public:
  ConfigTable table(
      std::string_view name) const;  ///< a table inside this one; absent = every default stays

  void read(std::string_view key, bool& value);
  void read(std::string_view key, int& value, Range<int> range = {});
  void read(std::string_view key, std::int64_t& value, Range<std::int64_t> range = {});
  void read(std::string_view key, std::uint64_t& value);
  void read(std::string_view key, float& value, Range<double> range = {});
  void read(std::string_view key, double& value, Range<double> range = {});
  void read(std::string_view key, std::string& value);
  void read(std::string_view key, std::vector<double>& value);

  template <std::size_t kSize>
  void read(std::string_view key, std::array<double, kSize>& value) {
    std::vector<double> values(value.begin(), value.end());
    read(key, values);
    if (values.size() != kSize) fail(key, "needs " + std::to_string(kSize) + " numbers");
    for (std::size_t i = 0; i < kSize; ++i) value[i] = values[i];
  }

  template <class T>
  void read(std::string_view key, T& value, std::initializer_list<Choice<T>> choices) {
    std::string name, names;
    for (const auto& [choice, meaning] : choices) {
      if (meaning == value) name = choice;
      names += (names.empty() ? "" : ", ") + std::string(choice);
    }
    read(key, name);
    for (const auto& [choice, meaning] : choices) {
      if (name == choice) {
        value = meaning;
        return;
      }
    }
    fail(key, "is \"" + name + "\"; it may be one of " + names);
  }

  /// For relations between keys: a non-empty violation is an error of this table.
  void require(const std::string& violation) const;

  /// Throws: "file:line: table.key problem".
  [[noreturn]] void fail(std::string_view key, const std::string& problem) const;

 private:
  friend class Config;
  struct Source;
  ConfigTable(std::shared_ptr<Source> source, std::string path)
      : source_(std::move(source)), path_(std::move(path)) {}
  std::string full(std::string_view key) const;

  std::shared_ptr<Source> source_;
  std::string path_;  ///< dotted, e.g. "gng.growing"
};

class Config {
 public:
  /// Reads files (later ones win) and overrides of the form "table.key=value" (value in TOML
  /// syntax; a bare word is a string).
  static Config load(const std::vector<std::string>& files,
                     const std::vector<std::string>& overrides);

  ConfigTable table(std::string_view name) const { return {source_, std::string(name)}; }

  /// Throws where a key of the given top-level tables was never read, or a top-level table is none
  /// of the known ones.
  void check_all_read(const std::vector<std::string>& own_tables,
                      const std::vector<std::string>& known_tables) const;

  /// Every key that was read with its value, as TOML, in ascending order of names.
  std::string resolved() const;

  /// 64-bit FNV-1a of resolved().
  std::int64_t hash() const;

 private:
  std::shared_ptr<ConfigTable::Source> source_;
};

}  // namespace runtime
