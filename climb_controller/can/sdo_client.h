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

/// What a drive may lack and move all the same.
enum class Part : std::uint8_t {
  kNone,
  kHoldOnLoss,    ///< it stops and holds by itself when the master is gone
  kTorqueLimit,   ///< 6072h in RPDO1
  kTorqueActual,  ///< 6077h in TPDO1
  kDetails,       ///< TPDO2: error code, mode, digital inputs
};
inline constexpr int kNumParts = static_cast<int>(Part::kDetails) + 1;

/// Bit i: the i-th Part.
using Parts = std::uint8_t;
constexpr Parts bit(Part part) {
  return static_cast<Parts>(1U << static_cast<unsigned>(part));
}

/// One object and what it is for.
struct ObjectStep {
  enum class Need : std::uint8_t {
    kMotion,     ///< without it the drive must not move
    kPart,       ///< without it the drive lacks `part`
    kTold,       ///< may be absent, which is told; when present it must agree
    kIfPresent,  ///< may be absent; when present it must agree
    kOptional,   ///< told, nothing more
    kMeans,      ///< a step on the way: the steps behind it show whether it worked
  };
  enum class When : std::uint8_t { kAlways, kWithPart, kWithoutPart };
  cia402::Object object;
  const char* object_name = "";  ///< a literal
  std::uint8_t num_bytes = 4;
  std::uint32_t value = 0;
  Need need = Need::kMotion;
  Part part = Part::kNone;
  When when = When::kAlways;        ///< taken only with (without) `part`, as far as known by then
  bool write = true;                ///< false: only read and compared
  bool zero_is_unknown = false;     ///< a drive that reads 0 says nothing
  std::uint32_t mask = 0xFFFFFFFF;  ///< bits that are compared; 0 = it only has to exist
};

struct SdoClientParams {
  std::int64_t timeout_us = 400'000;  ///< > 0, for one answer; some drives take 200 ms
  int max_attempts = 3;               ///< >= 1, per request
};

class SdoClient {
 public:
  /// `axis` goes into the issues only.
  SdoClient(int axis, std::uint8_t node, SdoClientParams params)
      : axis_(axis), node_(node), params_(params) {}

  /// Begins anew; `lost` is known to be missing beforehand. `steps` must outlive the run.
  void start(std::span<const ObjectStep> steps, Parts lost = 0);

  /// The frame to send now, if one is due; call again until none.
  std::optional<CanFrame> next_frame(std::int64_t now_us);

  void take(const cia402::SdoResponse& response);

  bool is_done() const { return step_index_ >= steps_.size(); }

  /// What is missing or keeps another value. A drive that never answered has one issue.
  std::span<const ObjectIssue> issues() const { return issues_; }

  bool forbids_motion() const;
  bool lacks(Part part) const { return (lost_ & bit(part)) != 0; }

 private:
  enum class Stage : std::uint8_t { kWrite, kRead };

  void begin_step();
  void finish_step();
  bool is_skipped(const ObjectStep& step) const;
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
  Parts lost_ = 0;
  std::vector<ObjectIssue> issues_;
};

}  // namespace can
