// SPDX-License-Identifier: BSD-3-Clause
// A CiA 402 drive for tests, written from the standard byte by byte: it shares nothing with the
// codec under test. It stands where it is told, at once; a test makes it misbehave.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "can/can_frame.h"

namespace can {

class ScriptedDrive {
 public:
  explicit ScriptedDrive(std::uint8_t node) : node_(node) { objects_[key(0x1000, 0)] = 0x00020192; }

  // --- what a test may change
  // ----------------------------------------------------------------------
  bool is_silent = false;        ///< neither hears nor speaks
  bool is_mute_on_sync = false;  ///< no TPDO1
  bool has_heartbeat = true;
  bool ignores_control_word = false;
  bool is_stuck = false;  ///< enabled, but stands
  /// As the standard has it: a command waits for SYNC, whose answer is the state before it.
  bool latches_on_sync = false;
  int sdo_delay_ms = 0;  ///< one request after the other, each takes so long
  std::int32_t position = 1000;
  std::map<std::uint32_t, std::uint32_t> aborts;      ///< object -> abort code, read and write
  std::map<std::uint32_t, std::uint32_t> reads_back;  ///< object -> another value than written
  std::set<std::uint32_t> dead_objects;               ///< no answer at all
  std::set<std::uint32_t> read_only;                  ///< keep the value of set_object()
  std::set<std::uint16_t> unmappable;                 ///< exist, but in no PDO

  static std::uint32_t key(std::uint16_t index, std::uint8_t subindex) {
    return static_cast<std::uint32_t>(index) << 8 | subindex;
  }
  void lack(std::uint16_t index, std::uint8_t subindex = 0) {
    aborts[key(index, subindex)] = subindex == 0 ? 0x06020000 : 0x06090011;
  }
  void set_object(std::uint16_t index, std::uint8_t subindex, std::uint32_t value) {
    objects_[key(index, subindex)] = value;
  }
  std::uint32_t object(std::uint16_t index, std::uint8_t subindex) const {
    const auto found = objects_.find(key(index, subindex));
    return found == objects_.end() ? 0xDEADBEEF : found->second;
  }

  std::uint16_t status_word() const { return status_; }
  void set_status_word(std::uint16_t status) { status_ = status; }
  std::uint16_t control_word() const { return control_; }
  std::int32_t target() const { return target_; }
  std::uint16_t max_torque() const { return max_torque_; }
  int num_fault_resets() const { return num_fault_resets_; }
  std::int32_t first_enabled_target() const { return first_enabled_target_; }
  int num_wrong_lengths() const { return num_wrong_lengths_; }

  /// As a master before this one left it: running, and in this state.
  void run_with(std::uint16_t status) {
    network_ = 0x05;
    status_ = status;
  }
  void fail() { status_ = 0x0218; }

  CanFrame boot_up() {
    network_ = 0x7F;
    status_ = 0x0240;
    objects_ = {{key(0x1000, 0), 0x00020192}};
    return make(0x700U + node_, {0});
  }

  /// What it answers to one frame of the master.
  std::vector<CanFrame> hear(const CanFrame& frame) {
    if (is_silent) return {};
    if (frame.id == 0x000 && (frame.data[1] == 0 || frame.data[1] == node_)) {
      if (frame.data[0] == 0x01) network_ = 0x05;
      if (frame.data[0] == 0x80) network_ = 0x7F;
      return heartbeat_frames();
    }
    if (frame.id == 0x600U + node_) {
      if (sdo_delay_ms == 0) return answer_sdo(frame);
      requests_.push_back(frame);
      return {};
    }
    if (frame.id == 0x200U + node_ && network_ == 0x05) {
      if (!latches_on_sync) return take_command(frame);
      latched_ = {frame};
    }
    if (frame.id == 0x080 && network_ == 0x05) return answer_sync();
    return {};
  }

  /// What it sends by itself at this millisecond.
  std::vector<CanFrame> tick(std::int64_t time_ms) {
    if (is_silent) return {};
    if (!requests_.empty() && ++request_age_ms_ >= sdo_delay_ms) {
      const CanFrame request = requests_.front();
      requests_.erase(requests_.begin());
      request_age_ms_ = 0;
      return answer_sdo(request);
    }
    if (time_ms % 100 != node_ % 100) return {};
    return heartbeat_frames();
  }

 private:
  std::vector<CanFrame> answer_sync() {
    std::vector<CanFrame> answers;
    if (!is_mute_on_sync) answers.push_back(state_frame());
    for (const CanFrame& command : std::exchange(latched_, {})) take_command(command);
    return answers;
  }

  static CanFrame make(std::uint32_t id, const std::vector<int>& bytes) {
    CanFrame frame;
    frame.id = id;
    for (const int byte : bytes) frame.data[frame.dlc++] = static_cast<std::uint8_t>(byte);
    return frame;
  }

  std::vector<CanFrame> heartbeat_frames() const {
    if (!has_heartbeat) return {};
    return {make(0x700U + node_, {network_})};
  }

  CanFrame state_frame() const {
    const auto bits = static_cast<std::uint32_t>(position);
    std::vector<int> bytes = {status_ & 0xFF,
                              status_ >> 8,
                              static_cast<int>(bits & 0xFF),
                              static_cast<int>(bits >> 8 & 0xFF),
                              static_cast<int>(bits >> 16 & 0xFF),
                              static_cast<int>(bits >> 24)};
    bytes.push_back(0x64);  // 100 permille
    bytes.push_back(0x00);
    bytes.resize(std::min(bytes.size(), mapped_bytes(0x1A00)));
    return make(0x180U + node_, bytes);
  }

  /// What a PDO carries by its mapping; 8 as delivered.
  std::size_t mapped_bytes(std::uint16_t mapping) const {
    const auto count = objects_.find(key(mapping, 0));
    if (count == objects_.end()) return 8;
    std::uint32_t num_bits = 0;
    for (std::uint32_t i = 1; i <= count->second; ++i) {
      num_bits += object(mapping, static_cast<std::uint8_t>(i)) & 0xFF;
    }
    return num_bits / 8;
  }

  /// The object that this entry of a mapping names exists and may be in a PDO.
  std::uint32_t mapping_abort(std::uint32_t entry) const {
    if (unmappable.count(static_cast<std::uint16_t>(entry >> 16)) != 0) return 0x06040041;
    const auto missing = aborts.find(key(static_cast<std::uint16_t>(entry >> 16), 0));
    return missing == aborts.end() ? 0 : missing->second;
  }

  std::vector<CanFrame> answer_sdo(const CanFrame& frame) {
    const int index = frame.data[1] | frame.data[2] << 8;
    const int sub = frame.data[3];
    const std::uint32_t object = static_cast<std::uint32_t>(index) << 8 | frame.data[3];
    if (dead_objects.count(object) != 0 || frame.data[0] == 0x80) return {};
    const std::vector<int> head = {frame.data[1], frame.data[2], sub};
    const auto reply = [&](int command, std::uint32_t value) {
      std::vector<int> bytes = {command};
      bytes.insert(bytes.end(), head.begin(), head.end());
      for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<int>(value >> 8 * i & 0xFF));
      return std::vector<CanFrame>{make(0x580U + node_, bytes)};
    };
    if (const auto abort = aborts.find(object); abort != aborts.end()) {
      return reply(0x80, abort->second);
    }
    if (frame.data[0] == 0x40) {
      if (const auto other = reads_back.find(object); other != reads_back.end()) {
        return reply(0x43, other->second);
      }
      const auto found = objects_.find(object);
      if (found == objects_.end() && index != 0x6077) return reply(0x80, 0x06020000);
      return reply(0x43, found == objects_.end() ? 0 : found->second);
    }
    const int num_bytes = 4 - (frame.data[0] >> 2 & 3);
    std::uint32_t value = 0;
    for (int i = 0; i < num_bytes; ++i) {
      value |= static_cast<std::uint32_t>(frame.data[static_cast<std::size_t>(4 + i)]) << 8 * i;
    }
    if (read_only.count(object) != 0) return reply(0x80, 0x06010002);
    const bool is_mapping = (index & 0xFF00) == 0x1600 || (index & 0xFF00) == 0x1A00;
    if (is_mapping && sub != 0 && mapping_abort(value) != 0) {
      return reply(0x80, mapping_abort(value));
    }
    objects_[object] = value;
    return reply(0x60, 0);
  }

  std::vector<CanFrame> take_command(const CanFrame& frame) {
    if (frame.dlc != mapped_bytes(0x1600)) {
      ++num_wrong_lengths_;
      return {make(0x080U + node_, {0x20, 0x82, 0x11, 0, 0, 0, 0, 0})};
    }
    const auto last = control_;
    control_ = static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      bits |= static_cast<std::uint32_t>(frame.data[2 + i]) << 8 * i;
    }
    target_ = static_cast<std::int32_t>(bits);
    if (frame.dlc == 8)
      max_torque_ = static_cast<std::uint16_t>(frame.data[6] | frame.data[7] << 8);
    if (!ignores_control_word) walk(last);
    if ((status_ & 0x6F) == 0x27 && !is_stuck) position = target_;
    return {};
  }

  void walk(std::uint16_t last) {
    if ((status_ & 0x4F) == 0x08) {
      if ((last & 0x80) == 0 && (control_ & 0x80) != 0) {
        ++num_fault_resets_;
        status_ = 0x0240;
      }
      return;
    }
    const bool enabled = (status_ & 0x6F) == 0x27;
    if ((control_ & 0x02) == 0) {
      status_ = 0x0240;
    } else if ((control_ & 0x04) == 0) {
      status_ = enabled || (status_ & 0x6F) == 0x07 ? 0x0207 : 0x0240;
    } else if ((control_ & 0x0F) == 0x06) {
      status_ = 0x0221;
    } else if ((control_ & 0x0F) == 0x07) {
      if ((status_ & 0x6F) == 0x21 || enabled) status_ = 0x0223;
    } else if ((control_ & 0x0F) == 0x0F) {
      const int state = status_ & 0x6F;
      if (state == 0x23 || state == 0x07) {
        status_ = 0x0227;
        first_enabled_target_ = target_;
      }
    }
  }

  std::uint8_t node_;
  std::uint8_t network_ = 0x7F;
  std::uint16_t status_ = 0x0240;
  std::uint16_t control_ = 0;
  std::int32_t target_ = 0;
  std::int32_t first_enabled_target_ = INT32_MIN;
  std::uint16_t max_torque_ = 0;
  int num_fault_resets_ = 0;
  int num_wrong_lengths_ = 0;
  std::vector<CanFrame> latched_;  ///< the command that waits for SYNC
  std::vector<CanFrame> requests_;
  int request_age_ms_ = 0;
  std::map<std::uint32_t, std::uint32_t> objects_;
};

}  // namespace can
