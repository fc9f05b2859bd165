// SPDX-License-Identifier: BSD-3-Clause
// Is the rung in the claw? Four witnesses must agree: touch closed for 30 ms (level, not edge), jaw
// where this rung's radius stops it (fully closed = missed), closing torque, and the pull test.
// Also tells a touch switch that is stuck closed, and witnesses that contradict each other again
// and again.
#pragma once

#include <cstdint>
#include <string>

#include "climb/params.h"

namespace climb {

struct ConfirmationParams {
  double touch_s = 0.030;  ///< > 0; touch must be closed so long, without a break
  double lost_s = 0.020;   ///< > 0; open (or jaw off the rung) so long = the grasp is lost
  double stuck_s = 0.100;  ///< > 0; closed so long while the claw stands open = stuck
  /// The jaw counts as standing open within this of open_rad.
  double open_window_rad = 0.3;
  int max_disagreements = 3;  ///< > 0; in a row
};

std::string check(const ConfirmationParams& params);

/// Of one claw, one cycle.
struct ClawReading {
  bool touch = false;
  double jaw_rad = 0.0;
  double jaw_torque_Nm = 0.0;  ///< magnitude counts
};

/// What the claw is to close on.
struct ExpectedRung {
  double radius_m = 0.0;  ///< 0 = not known: anything that the claw can hold
  double skew = 0.0;      ///< tangent between rung and claw, in the plane that the jaw closes in
};

struct JawWindow {
  double low_rad = 0.0;
  double high_rad = 0.0;
  bool holds(double jaw_rad) const { return jaw_rad >= low_rad && jaw_rad <= high_rad; }
};

/// Where the jaw stands on such a rung.
JawWindow jaw_window(const ClawParams& claw, const ExpectedRung& rung);

struct PullResult {
  double slip_m = 0.0;  ///< of the foot, back from the ladder
  double force_N = 0.0;
};

/// Each witness by itself.
struct GraspWitness {
  bool touch = false;
  bool jaw = false;
  bool torque = false;
  bool pull = false;

  bool all() const { return touch && jaw && torque && pull; }
  /// All but the pull test, which needs the others first.
  bool closed() const { return touch && jaw && torque; }
};

class GraspConfirmation {
 public:
  GraspConfirmation(const ClawParams& claw, const MotionParams& motion,
                    const ConfirmationParams& params);

  /// From now on; until told, nothing is known of the rung.
  void expect(const ExpectedRung& rung) { window_ = jaw_window(claw_, rung); }

  /// Each cycle. Readings that are not finite witness against.
  void update(const ClawReading& reading, double dt_s);

  /// Of the last update; `pull` false.
  GraspWitness witness() const;

  /// The verdict of one try, after its pull test; counts contradictions.
  GraspWitness conclude(const PullResult& pull);

  /// A try without contact: contradiction when some witnesses say closed and others not.
  void conclude_missed();

  /// Touch and jaw say so in this very cycle.
  bool holds() const { return open_s_ <= 0.0; }
  /// A grasp that was confirmed and now lacks touch, or whose jaw left the window.
  bool is_lost() const {
    return open_s_ >= params_.lost_s + grace_s_ || jaw_off_s_ >= params_.lost_s;
  }
  bool is_touch_stuck() const { return stuck_s_ >= params_.stuck_s; }
  /// Witnesses contradicted each other max_disagreements times in a row.
  bool disagrees() const { return num_disagreements_ >= params_.max_disagreements; }
  int num_disagreements() const { return num_disagreements_; }
  void forgive() { num_disagreements_ = 0; }
  /// The jaw begins to press anew from where it was measured: until it does, but at most so long,
  /// an open touch is no loss. A jaw that leaves its window is one all the same.
  void press_again(double within_s) {
    grace_s_ = within_s;
    open_s_ = jaw_off_s_ = 0.0;
  }

 private:
  bool in_window() const { return window_.holds(reading_.jaw_rad); }

  ClawParams claw_;
  MotionParams motion_;
  ConfirmationParams params_;
  JawWindow window_;
  ClawReading reading_;
  double touch_s_ = 0.0;
  double open_s_ = 0.0;
  double jaw_off_s_ = 0.0;
  double grace_s_ = 0.0;
  double stuck_s_ = 0.0;
  int num_disagreements_ = 0;
};

}  // namespace climb
