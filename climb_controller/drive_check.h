// SPDX-License-Identifier: BSD-3-Clause
// Is this drive fit for the robot? Identifies one drive, configures it as the controller would,
// reads back, names what it lacks and, if asked, moves it a little and back. By the time handed in;
// nothing is stored in the drive (1010h is not written).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "can/cia402_bus.h"
#include "can/identity_reader.h"

namespace climb_controller {

struct DriveCheckParams {
  can::AxisConfig axis;       ///< its soft limits are put around where it stands
  double move_rad = 0.0;      ///< 0: no torque is ever switched on
  double speed_rad_s = 0.25;  ///< > 0
  double margin_rad = 0.5;    ///< > 0; soft limits beyond the move
  bool reset_fault = false;   ///< a drive found in fault is reset, once
  std::int64_t cycle_us = 10'000;
  std::vector<can::cia402::Object> optional_objects;  ///< accepted as they are
};

/// "" or the violated relation in words.
std::string check(const DriveCheckParams& params);

enum class DriveVerdict : std::uint8_t {
  kFit,         ///< all that climbing asks of a drive
  kGroundOnly,  ///< works, but would not hold on loss of the controller or has no torque
  kUnfit,       ///< does not work: see problem
};

struct DriveReport {
  can::DriveIdentity identity;
  can::Capabilities capabilities;
  std::vector<can::ObjectIssue> issues;
  std::vector<can::Fault> faults;
  std::uint64_t num_malformed = 0;
  double start_rad = 0.0;
  std::optional<double> reached_rad;  ///< at the far end of the move
  std::optional<double> returned_rad;
  double max_lag_rad = 0.0;
  std::string problem;  ///< "" or why it is unfit
  DriveVerdict verdict = DriveVerdict::kUnfit;
};

/// What a person reads: identity, capabilities, each object, the move, the verdict.
std::string text_of(const DriveReport& report, const DriveCheckParams& params);

class DriveCheck {
 public:
  /// `params` pass check(); transport and recorder (may be null) outlive this.
  DriveCheck(const DriveCheckParams& params, can::Transport& transport,
             can::FlightRecorder* recorder = nullptr);

  void poll(std::int64_t now_us);
  void cycle(std::int64_t now_us);
  /// Ends early; torque is walked down first.
  void cancel();
  bool is_done() const { return stage_ == Stage::kDone; }
  const DriveReport& report() const { return report_; }

 private:
  enum class Stage : std::uint8_t {
    kListening,
    kIdentifying,
    kConfiguring,
    kResetting,
    kLooking,
    kEnabling,
    kGoing,
    kReturning,
    kDisabling,
    kDone
  };

  void enter(Stage stage);
  std::int64_t elapsed_us() const { return now_us_ - stage_since_us_; }
  void advance_without_bus();
  void start_bus();
  void advance();
  void advance_configured();
  void advance_move(double from_rad, double to_rad);
  void finish_move();
  void give_up(const std::string& problem);
  void finish();

  DriveCheckParams params_;
  can::Transport& transport_;
  can::FlightRecorder* recorder_;
  can::IdentityReader reader_;
  std::optional<can::Cia402Bus> bus_;
  can::AxisTarget target_;
  can::AxisFeedback feedback_;
  DriveReport report_;
  Stage stage_ = Stage::kListening;
  std::int64_t now_us_ = 0;
  std::int64_t stage_since_us_ = -1;
  bool was_reset_ = false;
};

}  // namespace climb_controller
