// SPDX-License-Identifier: BSD-3-Clause
// A MaixSense A010 at the other end of a pseudo terminal, byte for byte as Sipeed describes it:
// answers AT commands, sends images. Shares no code with the driver.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sources {

/// The packet of one image; side is 100, 50 or 25.
std::vector<std::uint8_t> a010_packet(const std::vector<std::uint8_t>& counts, int side,
                                      int number);

class FakeA010 {
 public:
  /// `link`, when given, is a symbolic link to the line, as udev makes them.
  explicit FakeA010(const std::string& link = "");
  ~FakeA010();
  FakeA010(const FakeA010&) = delete;
  FakeA010& operator=(const FakeA010&) = delete;

  const std::string& path() const { return path_; }

  /// Reads what has come and answers it.
  void work();
  /// As a stream without pause.
  void send(const std::vector<std::uint8_t>& bytes);
  void send_text(const std::string& text) { send({text.begin(), text.end()}); }
  void send_image(std::uint8_t count);

  /// AT commands so far, without the end of line.
  const std::vector<std::string>& commands() const { return commands_; }
  /// "BINN" -> 1 and so on, as last set.
  int setting(const std::string& name) const;
  bool is_sending() const { return setting("DISP") == 2 || setting("DISP") == 4; }

  bool is_mute = false;  ///< answers nothing
  int number = 0;        ///< of the next image

 private:
  void answer(const std::string& command);

  int master_ = -1;
  std::string path_;
  std::string link_;
  std::string received_;
  std::vector<std::string> commands_;
  std::map<std::string, int> settings_{
      {"BINN", 1}, {"UNIT", 0}, {"FPS", 15}, {"ISP", 1}, {"DISP", 1}};
};

}  // namespace sources
