// SPDX-License-Identifier: BSD-3-Clause
// One servo axis: where it sits on the bus, its limits, and the only place where radians become
// counts. SI and the joint's side of the gear everywhere else.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace can {

struct AxisConfig {
  std::uint8_t node_id = 0;         ///< 1..126; axis = 1 + 4 leg + joint in the default layout
  double counts_per_rad = 10430.0;  ///< position units per radian of the motor shaft, > 0
  double gear = 1.0;                ///< motor turns per joint turn, > 0
  int sign = 1;                     ///< +1, or -1 when the motor turns against the joint
  double offset_rad = 0.0;          ///< joint angle at position 0 of the drive
  double min_rad = -1.0;            ///< soft limits of the joint, min < max (607Dh)
  double max_rad = 1.0;
  double max_velocity_rad_s = 2.5;        ///< > 0 (607Fh, 6080h)
  double max_acceleration_rad_s2 = 10.0;  ///< > 0 (60C5h)
  double quick_stop_rad_s2 = 20.0;        ///< > 0 (6085h)
  double following_error_rad = 0.1;       ///< > 0 (6065h)
  int following_error_ms = 50;            ///< 1..65535 (6066h)
  double rated_torque_Nm = 20.0;          ///< torque that the drive calls 1000 permille, > 0
  double max_torque_Nm = 30.0;            ///< > 0, <= 65.535 rated (6072h)
  bool has_torque = true;  ///< use 6072h and 6077h where the drive has them; else 6-byte PDOs
  bool absolute_position = true;  ///< position survives loss of power
  double max_current_A = 20.0;    ///< > 0; ODrive only (Set_Limits)
};

/// "" or the violated relation in words, naming the field.
std::string check(const AxisConfig& axis);

/// Joint angle -> drive counts, rounded to the nearest, halves up. None for an angle that is not
/// finite or does not fit 32 bits.
std::optional<std::int32_t> counts_from_rad(const AxisConfig& axis, double angle_rad);

/// Drive counts -> joint angle; exact to half a count after counts_from_rad.
double rad_from_counts(const AxisConfig& axis, std::int32_t counts);

/// A joint-side speed or acceleration in counts per second (squared), rounded down: a limit never
/// grows by rounding. None when not finite, negative or beyond 32 bits.
std::optional<std::uint32_t> limit_counts(const AxisConfig& axis, double rad_per_s);

/// A torque limit in permille of the rated torque, rounded down; none when not finite or negative.
/// Saturates at 65535.
std::optional<std::uint16_t> limit_permille(const AxisConfig& axis, double torque_Nm);

/// A signed torque in permille (feed-forward), nearest; none when not finite or beyond 16 bits.
std::optional<std::int16_t> permille_from_Nm(const AxisConfig& axis, double torque_Nm);
double Nm_from_permille(const AxisConfig& axis, std::int16_t permille);

}  // namespace can
