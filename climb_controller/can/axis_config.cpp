// SPDX-License-Identifier: BSD-3-Clause
#include "can/axis_config.h"

#include <cmath>
#include <limits>

namespace can {
namespace {

double counts_per_joint_rad(const AxisConfig& axis) {
  return axis.counts_per_rad * axis.gear;
}

/// floor(value) as an integer type; none outside its range, NaN included (positive form).
template <class Integer>
std::optional<Integer> floored(double value) {
  const double whole = std::floor(value);
  if (!(whole >= static_cast<double>(std::numeric_limits<Integer>::min()) &&
        whole <= static_cast<double>(std::numeric_limits<Integer>::max()))) {
    return std::nullopt;
  }
  return static_cast<Integer>(whole);
}

bool is_positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

}  // namespace

std::string check(const AxisConfig& axis) {
  if (!(axis.node_id >= 1 && axis.node_id <= 126)) return "node_id in 1..126";
  if (!is_positive(axis.counts_per_rad)) return "counts_per_rad > 0";
  if (!is_positive(axis.gear)) return "gear > 0";
  if (axis.sign != 1 && axis.sign != -1) return "sign is +1 or -1";
  if (!std::isfinite(axis.offset_rad)) return "offset_rad is finite";
  if (!(axis.min_rad < axis.max_rad)) return "min_rad < max_rad";
  if (!counts_from_rad(axis, axis.min_rad) || !counts_from_rad(axis, axis.max_rad)) {
    return "min_rad and max_rad fit 32-bit counts";
  }
  if (!is_positive(axis.max_velocity_rad_s)) return "max_velocity_rad_s > 0";
  if (!is_positive(axis.max_acceleration_rad_s2)) return "max_acceleration_rad_s2 > 0";
  if (!is_positive(axis.quick_stop_rad_s2)) return "quick_stop_rad_s2 > 0";
  if (!is_positive(axis.following_error_rad)) return "following_error_rad > 0";
  for (const double limit : {axis.max_velocity_rad_s, axis.max_acceleration_rad_s2,
                             axis.quick_stop_rad_s2, axis.following_error_rad}) {
    if (limit_counts(axis, limit).value_or(0) == 0) return "every limit is 1..2^32-1 counts";
  }
  if (!(axis.following_error_ms >= 1 && axis.following_error_ms <= 65535)) {
    return "following_error_ms in 1..65535";
  }
  if (!is_positive(axis.rated_torque_Nm)) return "rated_torque_Nm > 0";
  if (!(axis.max_torque_Nm > 0.0 && axis.max_torque_Nm <= 65.535 * axis.rated_torque_Nm)) {
    return "0 < max_torque_Nm <= 65.535 rated_torque_Nm";
  }
  if (!is_positive(axis.max_current_A)) return "max_current_A > 0";
  return "";
}

std::optional<std::int32_t> counts_from_rad(const AxisConfig& axis, double angle_rad) {
  const double counts = (angle_rad - axis.offset_rad) * axis.sign * counts_per_joint_rad(axis);
  return floored<std::int32_t>(counts + 0.5);
}

double rad_from_counts(const AxisConfig& axis, std::int32_t counts) {
  return counts / counts_per_joint_rad(axis) * axis.sign + axis.offset_rad;
}

std::optional<std::uint32_t> limit_counts(const AxisConfig& axis, double rad_per_s) {
  return floored<std::uint32_t>(rad_per_s * counts_per_joint_rad(axis));
}

std::optional<std::uint16_t> limit_permille(const AxisConfig& axis, double torque_Nm) {
  const double permille = torque_Nm / axis.rated_torque_Nm * 1000.0;
  if (permille >= 65535.0 && std::isfinite(permille)) return std::uint16_t{65535};
  return floored<std::uint16_t>(permille);
}

std::optional<std::int16_t> permille_from_Nm(const AxisConfig& axis, double torque_Nm) {
  return floored<std::int16_t>(torque_Nm / axis.rated_torque_Nm * 1000.0 * axis.sign + 0.5);
}

double Nm_from_permille(const AxisConfig& axis, std::int16_t permille) {
  return permille / 1000.0 * axis.rated_torque_Nm * axis.sign;
}

}  // namespace can
