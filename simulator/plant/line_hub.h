// SPDX-License-Identifier: BSD-3-Clause
// The digital lines for other processes, without a kernel's GPIO: a SOCK_SEQPACKET server at a
// path.
//
// Protocol. Each packet is one record of two bytes: {line, level}.
//   line   0 TOUCH_FL, 1 TOUCH_FR, 2 TOUCH_RL, 3 TOUCH_RR, 4 ESTOP_N  (lines.h)
//   level  0 low, 1 high
// Server to client: five records on connection, in order of lines, then one for each change.
// A lost connection is a broken wire: the reader must take every line as low (ESTOP_N low = stop).
// Client to server, a tester's hand: {line, 0 or 1} forces the wire, {line, 2} lets it go again.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <poll.h>

#include "simulator/plant/lines.h"
#include "simulator/plant/packet_server.h"

namespace simulator {

class LineHub {
 public:
  /// "" = no listening socket, clients by add_client(). Throws DoorError.
  explicit LineHub(const std::string& path);

  void add_client(int descriptor);
  void add_to_poll(std::vector<pollfd>& descriptors) const { server_.add_to_poll(descriptors); }

  /// What testers did since the last call.
  struct Hand {
    Line line{};
    WireFault fault{};
  };
  std::vector<Hand> receive();
  /// Sends what changed.
  void publish(const LineLevels& levels);

 private:
  void greet(int client);

  PacketServer server_;
  LineLevels levels_{};  ///< low until first published
};

/// The same lines on gpio-sim's simulated chip, through its sysfs folder (".../gpiochipN", which
/// holds sim_gpio0/pull and so on). The driver's pull is the level that a reader sees.
class SimulatedChip {
 public:
  /// `offsets` of the five lines on the chip. Throws DoorError where a pull file cannot be written.
  SimulatedChip(const std::string& folder, const std::array<int, kNumLines>& offsets);

  ~SimulatedChip();
  SimulatedChip(const SimulatedChip&) = delete;
  SimulatedChip& operator=(const SimulatedChip&) = delete;

  /// Writes what changed, and one line more each time: a reader that asks for a bias sets the pull,
  /// which a real switch would not let happen. False when a file could not be written.
  bool publish(const LineLevels& levels);

 private:
  bool write(std::size_t line, bool level) const;

  std::array<int, kNumLines> pulls_ = {-1, -1, -1, -1, -1};  ///< descriptors
  std::size_t refreshed_ = 0;
  std::optional<LineLevels> levels_;
};

}  // namespace simulator
