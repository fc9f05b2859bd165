// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/access.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>

namespace viewer {
namespace {

constexpr std::size_t kMinTokenCharacters = 16;

/// Takes as long for a wrong token as for the right one.
bool is_same(std::string_view given, std::string_view wanted) {
  if (given.size() != wanted.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < given.size(); ++i) {
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(wanted[i]);
  }
  return difference == 0;
}

/// The value behind "name=" up to one of `ends`, where it begins the text or follows one of
/// `starts`.
std::string_view value_of(std::string_view text, std::string_view name, const char* starts,
                          const char* ends) {
  for (std::size_t at = text.find(name); at != std::string_view::npos;
       at = text.find(name, at + 1)) {
    const bool begins = at == 0 || std::string_view(starts).find(text[at - 1]) != std::string::npos;
    if (!begins) continue;
    const std::string_view value = text.substr(at + name.size());
    return value.substr(0, value.find_first_of(ends));
  }
  return "";
}

bool is_local_name(std::string_view host) {
  constexpr std::array<std::string_view, 3> kNames = {"localhost", "127.0.0.1", "[::1]"};
  return std::any_of(kNames.begin(), kNames.end(), [&](std::string_view name) {
    return host == name || (host.starts_with(name) && host[name.size()] == ':');
  });
}

bool is_own_page(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return origin.empty() || (origin.starts_with(kScheme) && origin.substr(kScheme.size()) == host);
}

}  // namespace

std::string_view token_in(std::string_view target) {
  const std::size_t query = target.find('?');
  if (query == std::string_view::npos) return "";
  return value_of(target.substr(query + 1), "token=", "&", "&#");
}

Admission judge(const Visitor& visitor, std::string_view token) {
  if (!is_own_page(visitor.origin, visitor.host)) return Admission::kForeignSite;
  if (token.empty()) {
    return is_local_name(visitor.host) ? Admission::kGranted : Admission::kForeignSite;
  }
  const bool has_token = is_same(token_in(visitor.target), token) ||
                         is_same(value_of(visitor.cookie, "token=", " ;", ";"), token);
  return has_token ? Admission::kGranted : Admission::kNoToken;
}

std::string read_token(const std::string& path) {
  std::string token;
  std::ifstream stream(path);
  std::getline(stream, token);
  const bool is_sound =
      token.size() >= kMinTokenCharacters && std::all_of(token.begin(), token.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
               c == '_' || c == '-';
      });
  if (!is_sound) {
    throw std::runtime_error(path +
                             ": the token must be one line of at least 16 letters and digits; make "
                             "one: head -c 24 /dev/urandom | base64 | tr +/ -_ > " +
                             path);
  }
  return token;
}

}  // namespace viewer
