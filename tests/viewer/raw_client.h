// SPDX-License-Identifier: BSD-3-Clause
// A client that sends any bytes it likes, and reads WebSocket frames without a library.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace viewer_test {

struct Frame {
  int opcode = 0;  ///< 1 text, 2 binary, 8 close, 9 ping
  std::string payload;
};

class RawClient {
 public:
  /// Connected to 127.0.0.1; `receive_buffer_bytes` > 0 makes a small one.
  explicit RawClient(std::uint16_t port, int receive_buffer_bytes = 0);
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  /// False when the server has closed already.
  bool send(const std::string& bytes);
  /// Everything until the server closes, or what came within the time.
  std::string read_all(int timeout_ms = 3000);
  /// True when the server closes within the time.
  bool is_closed(int timeout_ms = 3000);

  /// Opens the messages; false when it is refused. `head` = additional header lines.
  bool open_messages(const std::string& head = "");
  /// The next frame from the server, or nothing within the time.
  std::optional<Frame> read_frame(int timeout_ms = 3000);
  /// The next binary frame.
  std::optional<Frame> read_message(int timeout_ms = 3000);

 private:
  bool fill(std::size_t num_bytes, int timeout_ms);

  int socket_ = -1;
  std::string received_;
};

/// As a browser masks it: key 0.
std::string client_frame(int opcode, const std::string& payload);

}  // namespace viewer_test
