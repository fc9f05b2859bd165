// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/config.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include <toml++/toml.h>

namespace runtime {

struct ConfigTable::Source {
  toml::table root;
  std::map<std::string, std::string> read;  ///< full key -> value as TOML
  std::map<std::string, std::string>
      places;  ///< full key -> "file:line" (toml++ forgets it when nodes are merged)

  std::string place(const std::string& key) const {
    const auto found = places.find(key);
    return found == places.end() ? "" : found->second + ": ";
  }
};

namespace {

/// Later wins; tables are merged, values replaced.
void merge(toml::table& into, const toml::table& from) {
  for (const auto& [key, node] : from) {
    toml::table* old_table = into[key].as_table();
    if (old_table != nullptr && node.is_table()) {
      merge(*old_table, *node.as_table());
    } else {
      into.insert_or_assign(key, node);
    }
  }
}

void note_places(const toml::table& table, const std::string& prefix, const std::string& file,
                 std::map<std::string, std::string>& places) {
  for (const auto& [key, node] : table) {
    const std::string full = prefix + std::string(key.str());
    places[full] = file == "--set" ? file : file + ":" + std::to_string(node.source().begin.line);
    if (node.is_table()) note_places(*node.as_table(), full + ".", file, places);
  }
}

toml::table parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ConfigError("--set " + text + ": write it as table.key=value");
  }
  try {
    return toml::parse(text);
  } catch (const toml::parse_error&) {
    try {  // a bare word is meant as a string
      return toml::parse(text.substr(0, equals) + "=\"" + text.substr(equals + 1) + "\"");
    } catch (const toml::parse_error& error) {
      throw ConfigError("--set " + text + ": " + std::string(error.description()));
    }
  }
}

std::string quoted(const std::string& value) {
  std::ostringstream out;
  out << toml::array{value};  // an array of one prints its value in TOML syntax: "[ value ]"
  const std::string text = out.str();
  return text.substr(2, text.size() - 4);
}

/// Shortest text that reads back to the same value.
template <class Real>
std::string number_text(Real value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.begin(), text.end(), value).ptr;
  std::string result(text.begin(), end);
  if (result.find_first_of(".e") == std::string::npos) result += ".0";
  return result;
}

void collect_unread(const toml::table& table, const std::string& path,
                    const std::map<std::string, std::string>& read,
                    std::vector<std::string>& unread) {
  for (const auto& [key, node] : table) {
    const std::string full = path + "." + std::string(key.str());
    if (node.is_table()) {
      collect_unread(*node.as_table(), full, read, unread);
    } else if (!read.contains(full)) {
      unread.push_back(full);
    }
  }
}

template <class T>
std::string outside(const T& value, T low, T high) {
  std::ostringstream out;
  out << "= " << value << " is outside " << low << " .. " << high;
  return out.str();
}

}  // namespace

std::string ConfigTable::full(std::string_view key) const {
  return path_ + "." + std::string(key);
}

ConfigTable ConfigTable::table(std::string_view name) const {
  const toml::node_view<toml::node> node = source_->root.at_path(full(name));
  if (node && !node.is_table()) fail(name, "must be a table");
  return {source_, full(name)};
}

void ConfigTable::require(const std::string& violation) const {
  if (violation.empty()) return;
  // Name the place of the first key that the violation speaks of and that a file or --set gave.
  std::string word;
  for (const char c : violation + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.') {
      word += c;
      continue;
    }
    if (source_->places.contains(full(word))) fail(word, "is wrong: " + violation);
    word.clear();
  }
  throw ConfigError("[" + path_ + "]: " + violation);
}

void ConfigTable::fail(std::string_view key, const std::string& problem) const {
  throw ConfigError(source_->place(full(key)) + full(key) + " " + problem);
}

void ConfigTable::read(std::string_view key, bool& value) {
  if (const auto node = source_->root.at_path(full(key))) {
    if (!node.is_boolean()) fail(key, "must be true or false");
    value = node.as_boolean()->get();
  }
  source_->read[full(key)] = value ? "true" : "false";
}

void ConfigTable::read(std::string_view key, std::int64_t& value, Range<std::int64_t> range) {
  if (const auto node = source_->root.at_path(full(key))) {
    if (!node.is_integer()) fail(key, "must be a whole number");
    value = node.as_integer()->get();
  }
  if (!(value >= range.low && value <= range.high))
    fail(key, outside(value, range.low, range.high));
  source_->read[full(key)] = std::to_string(value);
}

void ConfigTable::read(std::string_view key, int& value, Range<int> range) {
  std::int64_t wide = value;
  read(key, wide, {range.low, range.high});
  value = static_cast<int>(wide);
}

void ConfigTable::read(std::string_view key, std::uint64_t& value) {
  auto wide = static_cast<std::int64_t>(value);
  read(key, wide, {0, std::numeric_limits<std::int64_t>::max()});
  value = static_cast<std::uint64_t>(wide);
}

void ConfigTable::read(std::string_view key, double& value, Range<double> range) {
  if (const auto node = source_->root.at_path(full(key))) {
    if (!node.is_number()) fail(key, "must be a number");
    value = *node.value<double>();
  }
  if (!std::isfinite(value)) fail(key, "must be finite");
  if (!(value >= range.low && value <= range.high))
    fail(key, outside(value, range.low, range.high));
  source_->read[full(key)] = number_text(value);
}

void ConfigTable::read(std::string_view key, float& value, Range<double> range) {
  double wide = std::stod(number_text(value));  // the default 0.1F is meant as 0.1
  read(key, wide, range);
  value = static_cast<float>(wide);
}

void ConfigTable::read(std::string_view key, std::string& value) {
  if (const auto node = source_->root.at_path(full(key))) {
    if (!node.is_string()) fail(key, "must be a string");
    value = node.as_string()->get();
  }
  source_->read[full(key)] = quoted(value);
}

void ConfigTable::read(std::string_view key, std::vector<double>& value) {
  if (const auto node = source_->root.at_path(full(key))) {
    const toml::array* array = node.as_array();
    if (array == nullptr) fail(key, "must be an array of numbers");
    value.clear();
    for (const toml::node& element : *array) {
      if (!element.is_number() || !std::isfinite(*element.value<double>()))
        fail(key, "must be an array of numbers");
      value.push_back(*element.value<double>());
    }
  }
  std::string text;
  for (const double number : value) text += (text.empty() ? "" : ", ") + number_text(number);
  source_->read[full(key)] = "[" + text + "]";
}

Config Config::load(const std::vector<std::string>& files,
                    const std::vector<std::string>& overrides) {
  Config config;
  config.source_ = std::make_shared<ConfigTable::Source>();
  for (const std::string& file : files) {
    std::ifstream stream(file);
    if (!stream)
      throw ConfigError(file + ": cannot be opened; give an existing file with --config");
    try {
      const toml::table table = toml::parse(stream, file);
      merge(config.source_->root, table);
      note_places(table, "", file, config.source_->places);
    } catch (const toml::parse_error& error) {
      throw ConfigError(file + ":" + std::to_string(error.source().begin.line) + ": " +
                        std::string(error.description()));
    }
  }
  for (const std::string& text : overrides) {
    const toml::table table = parse_override(text);
    merge(config.source_->root, table);
    note_places(table, "", "--set", config.source_->places);
  }
  return config;
}

void Config::check_all_read(const std::vector<std::string>& own_tables,
                            const std::vector<std::string>& known_tables) const {
  std::vector<std::string> unread;
  for (const auto& [key, node] : source_->root) {
    const std::string name(key.str());
    if (std::find(known_tables.begin(), known_tables.end(), name) == known_tables.end()) {
      throw ConfigError(source_->place(name) + "unknown table [" + name + "]");
    }
    if (!node.is_table()) throw ConfigError(source_->place(name) + name + " must be a table");
    if (std::find(own_tables.begin(), own_tables.end(), name) != own_tables.end()) {
      collect_unread(*node.as_table(), name, source_->read, unread);
    }
  }
  if (unread.empty()) return;
  const std::string& key = unread.front();
  const std::string table = key.substr(0, key.rfind('.') + 1);
  std::string known;
  for (const auto& entry : source_->read) {
    if (entry.first.starts_with(table) &&
        entry.first.find('.', table.size()) == std::string::npos) {
      known += (known.empty() ? "" : ", ") + entry.first.substr(table.size());
    }
  }
  throw ConfigError(source_->place(key) + "unknown key " + key +
                    (known.empty() ? "" : "; known there: " + known));
}

std::string Config::resolved() const {
  std::string text;
  for (const auto& [key, value] : source_->read)
    text.append(key).append(" = ").append(value).append("\n");
  return text;
}

std::int64_t Config::hash() const {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : resolved()) hash = (hash ^ static_cast<std::uint8_t>(c)) * 1099511628211ULL;
  return static_cast<std::int64_t>(hash);
}

}  // namespace runtime
