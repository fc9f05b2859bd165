// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/http_session.h"

#include <chrono>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "viewer/access.h"
#include "viewer/web_socket_session.h"

namespace viewer {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using Answer = http::response<http::span_body<const char>>;

constexpr std::chrono::seconds kPatience{10};
constexpr std::size_t kMaxHeadBytes = 8192;
constexpr std::string_view kTextType = "text/plain; charset=utf-8";
/// The page loads and runs nothing from elsewhere, and is in nobody's frame.
constexpr const char* kContentPolicy =
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

std::string_view text(beast::string_view other) {
  return {other.data(), other.size()};
}

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(boost::asio::ip::tcp::socket&& socket, const ServerContext& context,
              ConnectionSlot slot)
      : stream_(std::move(socket)), context_(context), slot_(std::move(slot)) {
    parser_.header_limit(kMaxHeadBytes);
  }

  void read() {
    stream_.expires_after(kPatience);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](beast::error_code error, std::size_t) {
                       if (!error) self->judge_request();
                     });
  }

 private:
  void judge_request() {
    const auto& request = parser_.get();
    const AccessRequest access_request{text(request.target()), text(request[http::field::host]),
                                       text(request[http::field::origin]),
                                       text(request[http::field::cookie])};
    const Access access = judge(access_request, context_.token);
    if (access == Access::kForeignSite) {
      return refuse(http::status::forbidden,
                    "Only this viewer's own page may look. Use the address it printed.\n");
    }
    if (access == Access::kNoToken) {
      return refuse(http::status::unauthorized, "Open this address with /?token=... behind it.\n");
    }
    if (request.method() != http::verb::get) {
      return refuse(http::status::method_not_allowed, "This viewer is only looked at.\n");
    }
    if (beast::websocket::is_upgrade(request)) return open_messages();
    if (!token_in(access_request.target).empty()) return remember_token();
    show_page(access_request.target);
  }

  void open_messages() {
    if (text(parser_.get().target()) != "/messages") {
      return refuse(http::status::not_found, "Messages are at /messages.\n");
    }
    const auto session =
        std::make_shared<WebSocketSession>(std::move(stream_), context_, std::move(slot_));
    if (context_.admit(session)) session->open(parser_.get());
  }

  /// The token leaves the address bar and comes back as a cookie.
  void remember_token() {
    answer_.result(http::status::see_other);
    answer_.set(http::field::location, "/");
    answer_.set(http::field::set_cookie,
                "ladder_token=" + context_.token + "; Path=/; HttpOnly; SameSite=Strict");
    send(kTextType, "");
  }

  void show_page(std::string_view target) {
    const PageFile* file = context_.page.find(target);
    if (file == nullptr) return refuse(http::status::not_found, "There is no such page.\n");
    send(file->type, file->bytes);
  }

  void refuse(http::status status, std::string_view why) {
    answer_.result(status);
    send(kTextType, why);
  }

  void send(std::string_view type, std::string_view body) {
    answer_.version(parser_.get().version());
    answer_.keep_alive(false);
    answer_.set(http::field::content_type, beast::string_view(type.data(), type.size()));
    answer_.set(http::field::cache_control, "no-cache");
    answer_.set("Content-Security-Policy", kContentPolicy);
    answer_.set("X-Content-Type-Options", "nosniff");
    answer_.set("Referrer-Policy", "no-referrer");
    answer_.body() = {body.data(), body.size()};
    answer_.prepare_payload();
    stream_.expires_after(kPatience);
    http::async_write(
        stream_, answer_, [self = shared_from_this()](beast::error_code, std::size_t) {
          beast::error_code ignored;
          self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
        });
  }

  beast::tcp_stream stream_;
  const ServerContext& context_;
  ConnectionSlot slot_;
  beast::flat_static_buffer<kMaxHeadBytes> buffer_;
  http::request_parser<http::empty_body> parser_;
  Answer answer_;
};

}  // namespace

void serve_http(boost::asio::ip::tcp::socket&& socket, const ServerContext& context,
                ConnectionSlot slot) {
  std::make_shared<HttpSession>(std::move(socket), context, std::move(slot))->read();
}

}  // namespace viewer
