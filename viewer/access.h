// SPDX-License-Identifier: BSD-3-Clause
// Who may look. On the loopback address everybody on this computer may, but no page of another site
// in his browser; on any other address whoever has the token.
#pragma once

#include <string_view>

namespace viewer {

/// What a request says of itself; "" where a header is absent.
struct AccessRequest {
  std::string_view target;  ///< "/path?token=..."
  std::string_view host = {};
  std::string_view origin = {};  ///< browsers send it with a WebSocket: the page that opens it
  std::string_view cookie = {};
};

enum class Access { kGranted, kNoToken, kForeignSite };

/// `token`: "" = none is asked for, and only names of this computer may be addressed (another name
/// that leads here is a trick of a foreign site).
Access judge(const AccessRequest& access_request, std::string_view token);

/// The value of token=... in a request's target, "" where absent.
std::string_view token_in(std::string_view target);

}  // namespace viewer
