// SPDX-License-Identifier: BSD-3-Clause
// For cross checks with decoders that this project did not write:
//   frame_tool encode N SEED   N random process data frames as candump -L lines, each with the
//   values
//                              that went in behind a '|': "181#... | status_word=1575 position=..."
//   frame_tool decode          candump -L lines from stdin -> "181 status_word=1575 position=..."
//   frame_tool run             the candump log of a whole bring-up, motion, quick stop and a fault
#include <iostream>
#include <sstream>
#include <string>

#include "bus_rig.h"
#include "can/cia402.h"
#include "can/flight_recorder.h"
#include "random_messages.h"

namespace can {
namespace {

std::string values_of(const cia402::Rpdo1& pdo) {
  std::ostringstream text;
  text << "control_word=" << pdo.control_word << " target_position=" << pdo.target_counts
       << " max_torque=" << pdo.max_torque_permille.value_or(0);
  return text.str();
}

std::string values_of(const cia402::Tpdo1& pdo) {
  std::ostringstream text;
  text << "status_word=" << pdo.status_word << " position=" << pdo.position_counts
       << " torque=" << pdo.torque_permille.value_or(0);
  return text.str();
}

std::string values_of(const cia402::Rpdo2& pdo) {
  std::ostringstream text;
  text << "velocity_offset=" << pdo.velocity_offset_counts_s
       << " torque_offset=" << pdo.torque_offset_permille << " mode=" << int{pdo.mode};
  return text.str();
}

std::string values_of(const cia402::Tpdo2& pdo) {
  std::ostringstream text;
  text << "error_code=" << pdo.error_code << " mode_display=" << int{pdo.mode}
       << " digital_inputs=" << pdo.digital_inputs;
  return text.str();
}

std::string values_of(const cia402::GripperTpdo& pdo) {
  std::ostringstream text;
  text << "touch=" << int{pdo.touch_bits} << " force_0=" << pdo.force_dN[0]
       << " force_1=" << pdo.force_dN[1];
  return text.str();
}

std::string values_of(const cia402::Emergency& emergency) {
  std::uint64_t vendor = 0;
  for (std::size_t i = 5; i > 0; --i) vendor = vendor << 8 | emergency.vendor[i - 1];
  std::ostringstream text;
  text << "error_code=" << emergency.error_code
       << " error_register=" << int{emergency.error_register} << " vendor=" << vendor;
  return text.str();
}

std::string values_of(const cia402::Heartbeat& heartbeat) {
  return "nmt_state=" + std::to_string(static_cast<int>(heartbeat.state));
}

std::string values_of(const cia402::Nmt& nmt) {
  return "nmt_command=" + std::to_string(static_cast<int>(nmt.command)) +
         " nmt_node=" + std::to_string(nmt.node);
}

/// What a frame says; "" if nothing.
std::string values_of(const CanFrame& frame) {
  const std::uint8_t node = cia402::node_of(frame.id);
  if (node >= 0x21 && node <= 0x24) {
    if (const auto pdo = cia402::decode_gripper_tpdo(frame)) return values_of(*pdo);
  }
  if (const auto pdo = cia402::decode_rpdo1(frame)) return values_of(*pdo);
  if (const auto pdo = cia402::decode_tpdo1(frame)) return values_of(*pdo);
  if (const auto pdo = cia402::decode_rpdo2(frame)) return values_of(*pdo);
  if (const auto pdo = cia402::decode_tpdo2(frame)) return values_of(*pdo);
  if (const auto emergency = cia402::decode_emergency(frame)) return values_of(*emergency);
  if (const auto heartbeat = cia402::decode_heartbeat(frame)) return values_of(*heartbeat);
  if (const auto nmt = cia402::decode_nmt(frame)) return values_of(*nmt);
  return "";
}

template <class Message>
void print_encoded(int index, const Message& message) {
  std::cout << candump_line(1'700'000'000'000'000 + index * 1000, "can0", encode(message)) << " | "
            << values_of(message) << '\n';
}

void print_random(int index, base::Rng& rng) {
  const std::uint8_t node = any_node(rng, 16);
  switch (index % 8) {
    case 0: {
      cia402::Rpdo1 pdo = random_rpdo1(rng, true);
      pdo.node = node;
      return print_encoded(index, pdo);
    }
    case 1: {
      cia402::Tpdo1 pdo = random_tpdo1(rng, true);
      pdo.node = node;
      return print_encoded(index, pdo);
    }
    case 2:
      return print_encoded(index, cia402::Rpdo2{node, any<std::int32_t>(rng),
                                                any<std::int16_t>(rng), any<std::int8_t>(rng)});
    case 3:
      return print_encoded(index, cia402::Tpdo2{node, any<std::uint16_t>(rng),
                                                any<std::int8_t>(rng), any<std::uint32_t>(rng)});
    case 4:
      return print_encoded(index,
                           cia402::GripperTpdo{static_cast<std::uint8_t>(0x21 + rng.below(4)),
                                               any<std::uint8_t>(rng),
                                               {any<std::int16_t>(rng), any<std::int16_t>(rng)}});
    case 5: {
      cia402::Emergency emergency{node, any<std::uint16_t>(rng), any<std::uint8_t>(rng), {}};
      for (std::uint8_t& byte : emergency.vendor) byte = any<std::uint8_t>(rng);
      return print_encoded(index, emergency);
    }
    case 6: {
      constexpr cia402::NmtState kStates[] = {cia402::NmtState::kBootUp, cia402::NmtState::kStopped,
                                              cia402::NmtState::kOperational,
                                              cia402::NmtState::kPreOperational};
      return print_encoded(index, cia402::Heartbeat{node, kStates[rng.below(4)]});
    }
    default: {
      constexpr cia402::NmtCommand kCommands[] = {
          cia402::NmtCommand::kStart, cia402::NmtCommand::kStop,
          cia402::NmtCommand::kEnterPreOperational, cia402::NmtCommand::kResetNode,
          cia402::NmtCommand::kResetCommunication};
      return print_encoded(index, cia402::Nmt{kCommands[rng.below(5)], node});
    }
  }
}

void decode_lines() {
  std::string line;
  while (std::getline(std::cin, line)) {
    const std::string text = line.substr(line.rfind(' ') + 1);
    const CanFrame frame = from_hex(text);
    std::cout << text.substr(0, text.find('#')) << ' ' << values_of(frame) << '\n';
  }
}

int print_run() {
  BusRig rig(16);
  rig.time_us = 1'700'000'000'000'000;
  if (!rig.bring_to_enabled()) return 1;
  rig.run_ms(200);
  for (AxisTarget& target : rig.targets) target.position_rad += 0.1;
  rig.run_ms(100);
  rig.line.put(from_hex("083#1186210000000000"));
  rig.run_ms(50);
  rig.bus->stop(StopKind::kQuickStop);
  rig.run_ms(100);
  rig.recorder.write_candump(std::cout, "can0");
  return 0;
}

}  // namespace
}  // namespace can

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if (mode == "encode" && argc == 4) {
    base::Rng rng(std::stoull(argv[3]));
    for (int i = 0; i < std::stoi(argv[2]); ++i) can::print_random(i, rng);
    return 0;
  }
  if (mode == "decode") {
    can::decode_lines();
    return 0;
  }
  if (mode == "run") return can::print_run();
  std::cerr << "usage: frame_tool encode N SEED | decode | run\n";
  return 2;
}
