// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/token.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace runtime {
namespace {

constexpr std::size_t kMinCharacters = 16;

bool is_allowed(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
         c == '-';
}

}  // namespace

std::string read_token(const std::string& path) {
  std::string token;
  std::ifstream stream(path);
  std::getline(stream, token);
  const bool is_sound =
      token.size() >= kMinCharacters && std::all_of(token.begin(), token.end(), is_allowed);
  if (!is_sound) {
    throw std::runtime_error(path +
                             ": the token must be one line of at least 16 letters and digits; make "
                             "one: head -c 24 /dev/urandom | base64 | tr +/ -_ > " +
                             path);
  }
  return token;
}

bool is_same_token(std::string_view given, std::string_view wanted) {
  if (given.size() != wanted.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < given.size(); ++i) {
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(wanted[i]);
  }
  return difference == 0;
}

}  // namespace runtime
