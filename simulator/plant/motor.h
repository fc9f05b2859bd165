// SPDX-License-Identifier: BSD-3-Clause
// A position-controlled joint: first-order lag behind its command, limited in speed, acceleration
// and torque. When the load asks for more torque than allowed, the load wins and the joint yields.
// Does not model current loops, backlash, friction's stick or heat.
#pragma once

namespace simulator {

struct MotorParams {
  double lag_s = 0.030;                    ///< > 0, of the position loop (30..60 ms)
  double max_velocity_rad_s = 3.0;         ///< > 0, what the motor can
  double max_acceleration_rad_s2 = 100.0;  ///< > 0
  double inertia_kg_m2 = 0.05;             ///< > 0, leg and rotor at the joint
  double peak_torque_Nm = 30.0;            ///< > 0
  double min_rad = -3.2;                   ///< hard stops, min < max
  double max_rad = 3.2;
};

/// What holds for one step.
struct MotorLimits {
  double velocity_rad_s = 0.0;
  double torque_Nm = 0.0;
};

/// What the drive asks of the joint in this step: for mechanics that move the joint themselves.
struct MotorCommand {
  enum class Kind { kBrake, kOff, kFollow };
  Kind kind = Kind::kBrake;
  double target_rad = 0.0;
  double velocity_rad_s = 0.0;  ///< of the target
  double torque_Nm = 0.0;       ///< feed-forward
  double torque_limit_Nm = 0.0;
};

/// What mechanics outside made of it.
struct MotorState {
  double position_rad = 0.0;
  double velocity_rad_s = 0.0;
  double torque_Nm = 0.0;
};

/// What is followed.
struct MotorTarget {
  double position_rad = 0.0;
  double velocity_rad_s = 0.0;      ///< of the interpolated position; only moved outside
  double feed_forward_rad_s = 0.0;  ///< 60B1h; only moved here
  double torque_Nm = 0.0;           ///< 60B2h; only moved outside
};

class Motor {
 public:
  explicit Motor(const MotorParams& params, double position_rad = 0.0);

  void follow(const MotorTarget& target, const MotorLimits& limits, double dt_s);
  /// Slows down at this deceleration and holds where it stands.
  void ramp_down(double deceleration_rad_s2, const MotorLimits& limits, double dt_s);
  /// No torque: a brake locks the joint, or it yields to its load.
  void release(bool brake, double dt_s);

  double position_rad() const { return position_rad_; }
  double velocity_rad_s() const { return velocity_rad_s_; }
  double torque_Nm() const { return torque_Nm_; }
  bool saturated() const { return saturated_; }

  /// From now on the joint is moved from outside: follow(), ramp_down() and release() only set the
  /// command, and position, speed and torque are what observe() says.
  void move_outside() { outside_ = true; }
  const MotorCommand& command() const { return command_; }
  void observe(const MotorState& state);
  /// A ramp has come to its end.
  bool stands() const { return outside_ ? command_.velocity_rad_s == 0.0 : velocity_rad_s_ == 0.0; }

  /// Torque that the joint must bear, positive against positive motion.
  void set_load(double load_Nm) { load_Nm_ = load_Nm; }
  double load_Nm() const { return load_Nm_; }
  /// A stop nearer than the joint's own, e.g. a rung between the jaws.
  void set_lower_stop(double stop_rad) { lower_stop_rad_ = stop_rad; }
  void set_position(double position_rad);

  bool stuck = false;        ///< fault: does not move
  bool reversed = false;     ///< fault: turns the wrong way
  double speed_share = 1.0;  ///< fault: reaches only this share of its speed

 private:
  void command_follow(const MotorTarget& target, const MotorLimits& limits);
  void command_ramp(double deceleration_rad_s2, const MotorLimits& limits, double dt_s);
  void step(double wanted_rad_s, const MotorLimits& limits, double dt_s);
  void move(double dt_s);
  double lower_stop() const;

  MotorParams params_;
  MotorCommand command_;
  bool outside_ = false;
  double position_rad_;
  double velocity_rad_s_ = 0.0;
  double torque_Nm_ = 0.0;
  double load_Nm_ = 0.0;
  double lower_stop_rad_;
  bool saturated_ = false;
};

}  // namespace simulator
