// SPDX-License-Identifier: BSD-3-Clause
// Brings the objects of one drive to their values: each is written, read back and compared. One
// request at a time, as SDO demands; frames and time are handed in and out, nothing waits.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "can/cia402.h"
#include "can/servo_bus.h"

namespace can {

/// One object and what it is for.
struct ObjectStep {
  enum class Need : std::uint8_t {
    kMotion,      ///< without it the drive must not move
    kHoldOnLoss,  ///< without it the drive does not hold by itself when the master is gone
    kOptional,    ///< reported, nothing more
    kIfPresent,   ///< may be absent; when present it must agree
  };
  cia402::Object object;
  const char* object_name = "";  ///< a literal
  std::uint8_t num_bytes = 4;
  std::uint32_t value = 0;
  Need need = Need::kMotion;
  bool write = true;                ///< false: only read and compared
  std::uint32_t mask = 0xFFFFFFFF;  ///< bits that are compared; 0 = it only has to exist
};

struct SdoClientParams {
  std::int64_t timeout_us = 100'000;  ///< > 0, for one answer
  int max_attempts = 3;               ///< >= 1, per request
};

class SdoClient {
 public:
  /// `axis` goes into the issues only.
  SdoClient(int axis, std::uint8_t node, SdoClientParams params)
      : axis_(axis), node_(node), params_(params) {}

  /// Begins anew. `steps` must outlive the run.
  void start(std::span<const ObjectStep> steps);

  /// The frame to send now, if one is due; call again until none.
  std::optional<CanFrame> next_frame(std::int64_t now_us);

  void take(const cia402::SdoResponse& response);

  bool is_done() const { return step_index_ >= steps_.size(); }

  /// What is missing or keeps another value. A drive that never answered has one issue.
  std::span<const ObjectIssue> issues() const { return issues_; }

  bool forbids_motion() const;
  bool lacks_hold_on_loss() const { return lacks_hold_on_loss_; }

 private:
  enum class Stage : std::uint8_t { kWrite, kRead };

  void begin_step();
  void finish_step();
  void give_up();
  void note(ObjectIssue::Kind kind, std::uint32_t abort_code, std::uint32_t found);
  void compare(std::uint32_t found);

  int axis_;
  std::uint8_t node_;
  SdoClientParams params_;
  std::span<const ObjectStep> steps_;
  std::size_t step_index_ = 0;
  Stage stage_ = Stage::kWrite;
  std::uint32_t write_abort_ = 0;  ///< abort code of the write, 0 = none
  int num_attempts_ = 0;
  bool is_waiting_ = false;
  std::int64_t deadline_us_ = 0;
  bool has_answered_ = false;
  bool lacks_hold_on_loss_ = false;
  std::vector<ObjectIssue> issues_;
};

}  // namespace can
