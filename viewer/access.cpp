// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/access.h"

#include <algorithm>
#include <array>

#include "runtime/token.h"

namespace viewer {
namespace {

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

Access judge(const AccessRequest& access_request, std::string_view token) {
  if (!is_own_page(access_request.origin, access_request.host)) return Access::kForeignSite;
  if (token.empty()) {
    return is_local_name(access_request.host) ? Access::kGranted : Access::kForeignSite;
  }
  const bool has_token =
      runtime::is_same_token(token_in(access_request.target), token) ||
      runtime::is_same_token(value_of(access_request.cookie, "ladder_token=", " ;", ";"), token);
  return has_token ? Access::kGranted : Access::kNoToken;
}

}  // namespace viewer
