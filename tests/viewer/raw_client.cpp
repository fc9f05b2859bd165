// SPDX-License-Identifier: BSD-3-Clause
#include "tests/viewer/raw_client.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace viewer_test {

RawClient::RawClient(std::uint16_t port, int receive_buffer_bytes) {
  socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (receive_buffer_bytes > 0) {
    setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes, sizeof(receive_buffer_bytes));
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
    close(socket_);
    socket_ = -1;
  }
}

RawClient::~RawClient() {
  if (socket_ >= 0) close(socket_);
}

bool RawClient::send(const std::string& bytes) {
  return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(bytes.size());
}

bool RawClient::fill(std::size_t num_bytes, int timeout_ms) {
  while (received_.size() < num_bytes) {
    pollfd readable{socket_, POLLIN, 0};
    if (poll(&readable, 1, timeout_ms) <= 0) return false;
    char buffer[65536];
    const ssize_t got = recv(socket_, buffer, sizeof(buffer), 0);
    if (got <= 0) return false;
    received_.append(buffer, static_cast<std::size_t>(got));
  }
  return true;
}

std::string RawClient::read_all(int timeout_ms) {
  fill(SIZE_MAX, timeout_ms);
  return received_;
}

bool RawClient::is_closed(int timeout_ms) {
  pollfd readable{socket_, POLLIN, 0};
  char buffer[65536];
  while (poll(&readable, 1, timeout_ms) > 0) {
    if (recv(socket_, buffer, sizeof(buffer), 0) <= 0) return true;
  }
  return false;
}

bool RawClient::open_messages(const std::string& head) {
  send(
      "GET /messages HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n" +
      head + "\r\n");
  std::size_t end = std::string::npos;
  while ((end = received_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill(received_.size() + 1, 3000)) return false;
  }
  const bool is_open = received_.starts_with("HTTP/1.1 101");
  received_.erase(0, end + 4);
  return is_open;
}

std::optional<Frame> RawClient::read_frame(int timeout_ms) {
  if (!fill(2, timeout_ms)) return std::nullopt;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(received_[i]); };
  const int opcode = byte(0) & 15;
  std::size_t length = byte(1), head = 2;
  const std::size_t more = length == 127 ? 8 : length == 126 ? 2 : 0;
  if (more > 0) {
    if (!fill(head + more, timeout_ms)) return std::nullopt;
    length = 0;
    for (std::size_t i = 0; i < more; ++i) length = length << 8 | byte(head + i);
    head += more;
  }
  if (!fill(head + length, timeout_ms)) return std::nullopt;
  Frame frame{opcode, received_.substr(head, length)};
  received_.erase(0, head + length);
  return frame;
}

std::optional<Frame> RawClient::read_message(int timeout_ms) {
  while (auto frame = read_frame(timeout_ms)) {
    if (frame->opcode == 2) return frame;
  }
  return std::nullopt;
}

std::string client_frame(int opcode, const std::string& payload) {
  std::string frame{static_cast<char>(0x80 | opcode)};
  if (payload.size() < 126) {
    frame += static_cast<char>(0x80 | payload.size());
  } else {
    frame += static_cast<char>(0x80 | 126);
    frame += static_cast<char>(payload.size() >> 8);
    frame += static_cast<char>(payload.size() & 255);
  }
  return frame + std::string(4, '\0') + payload;
}

}  // namespace viewer_test
