// SPDX-License-Identifier: BSD-3-Clause
#include "can/cia402_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "base/check.h"

namespace can {
namespace {

using cia402::Object;
using Need = ObjectStep::Need;
using When = ObjectStep::When;

constexpr double kTwoPi = 6.283185307179586;
constexpr std::uint32_t kPdoOff = 0x80000000;
constexpr std::uint32_t kPdoNoRemote = 0x40000000;  // read back set or not: drives differ

/// A PDO's entry in its mapping: index, subindex, bits.
constexpr std::uint32_t mapped(std::uint16_t index, std::uint8_t num_bits) {
  return static_cast<std::uint32_t>(index) << 16 | num_bits;
}

class Steps {
 public:
  std::vector<ObjectStep> take() { return std::move(steps_); }

  ObjectStep& add(Object object, const char* object_name, int num_bytes, std::int64_t value) {
    ObjectStep step;
    step.object = object;
    step.object_name = object_name;
    step.num_bytes = static_cast<std::uint8_t>(num_bytes);
    step.value = static_cast<std::uint32_t>(value);
    if (num_bytes < 4) step.value &= (1U << 8 * num_bytes) - 1U;
    return steps_.emplace_back(step);
  }

  ObjectStep& only_read(Object object, const char* object_name, int num_bytes) {
    ObjectStep& step = add(object, object_name, num_bytes, 0);
    step.write = false;
    step.mask = 0;
    return step;
  }

 private:
  std::vector<ObjectStep> steps_;
};

struct Pdo {
  std::uint16_t communication;  ///< 1400h + number, 1800h + number
  std::uint32_t cob_id;
  int transmission_type;  ///< 1: with every SYNC, 255: on change and by timer
  const char* name;
  const char* mapping_name;
  Part part = Part::kNone;  ///< the whole PDO belongs to it and stays off without it
};

/// The last entry of a PDO, which the drive may lack: the PDO is shorter then.
struct LastEntry {
  std::uint32_t entry;
  Part part;
};

void belongs_to(ObjectStep& step, Part part, When when = When::kWithPart) {
  if (part == Part::kNone) return;
  step.part = part;
  step.when = when;
  step.need = Need::kPart;
}

/// CiA 301: switch the PDO off, empty its mapping, fill it, count it, switch the PDO on. What a
/// drive does not let change has to be right already.
void add_pdo(Steps& steps, const Pdo& pdo, std::initializer_list<std::uint32_t> mapping,
             std::optional<LastEntry> last = std::nullopt) {
  const std::uint16_t communication = pdo.communication;
  const auto map = static_cast<std::uint16_t>(communication + 0x200);
  steps.add({communication, 1}, pdo.name, 4, pdo.cob_id | kPdoOff).need = Need::kMeans;
  belongs_to(steps.add({communication, 2}, pdo.name, 1, pdo.transmission_type), pdo.part);
  steps.add({map, 0}, pdo.mapping_name, 1, 0).need = Need::kMeans;
  std::uint8_t subindex = 0;
  for (const std::uint32_t entry : mapping) {
    belongs_to(steps.add({map, ++subindex}, pdo.mapping_name, 4, entry), pdo.part);
  }
  if (last) {
    const auto long_count = static_cast<std::uint8_t>(subindex + 1);
    belongs_to(steps.add({map, long_count}, pdo.mapping_name, 4, last->entry), last->part);
    belongs_to(steps.add({map, 0}, pdo.mapping_name, 1, long_count), last->part);
  }
  ObjectStep& count = steps.add({map, 0}, pdo.mapping_name, 1, subindex);
  if (last) {
    belongs_to(count, last->part, When::kWithoutPart);
    count.need = Need::kMotion;
  } else {
    belongs_to(count, pdo.part);
  }
  if (pdo.transmission_type == 255) {
    belongs_to(steps.add({communication, 5}, pdo.name, 2, 100), pdo.part);
  }
  ObjectStep& on = steps.add({communication, 1}, pdo.name, 4, pdo.cob_id);
  on.mask = ~kPdoNoRemote;
  belongs_to(on, pdo.part);
}

void add_pdos(Steps& steps, const AxisConfig& axis, const Cia402Params& params) {
  const std::uint32_t node = axis.node_id;
  const Pdo rpdo1{0x1400, 0x200 + node, 1, "RPDO1", "RPDO1 mapping"};
  const Pdo rpdo2{0x1401, 0x300 + node, 1, "RPDO2", "RPDO2 mapping"};
  const Pdo tpdo1{0x1800, 0x180 + node, 1, "TPDO1", "TPDO1 mapping"};
  const Pdo tpdo2{0x1801, 0x280 + node, 255, "TPDO2", "TPDO2 mapping", Part::kDetails};
  add_pdo(steps, rpdo1, {mapped(0x6040, 16), mapped(0x607A, 32)},
          LastEntry{mapped(0x6072, 16), Part::kTorqueLimit});
  add_pdo(steps, tpdo1, {mapped(0x6041, 16), mapped(0x6064, 32)},
          LastEntry{mapped(0x6077, 16), Part::kTorqueActual});
  add_pdo(steps, tpdo2, {mapped(0x603F, 16), mapped(0x6061, 8), mapped(0x60FD, 32)});
  if (params.feed_forward) {
    // The last byte is filled by the dummy object 0005h (unsigned8).
    add_pdo(steps, rpdo2,
            {mapped(0x60B1, 32), mapped(0x60B2, 16), mapped(0x6060, 8), mapped(0x0005, 8)});
  }
  // What else a drive sends as delivered would only be frames that nobody knows.
  steps.add({0x1802, 1}, "TPDO3", 4, kPdoOff | (0x380 + node)).need = Need::kMeans;
  steps.add({0x1803, 1}, "TPDO4", 4, kPdoOff | (0x480 + node)).need = Need::kMeans;
  const std::int64_t deadline_ms = params.max_missed_cycles * params.cycle_us / 1000;
  steps.add({0x1400, 5}, "RPDO1 deadline", 2, deadline_ms).need = Need::kOptional;
}

std::int64_t limit(const AxisConfig& axis, double rad_per_s) {
  const auto counts = limit_counts(axis, rad_per_s);
  CHECK(counts.has_value(), "the configuration was checked");
  return *counts;
}

void add_motion_limits(Steps& steps, const AxisConfig& axis) {
  const auto first = counts_from_rad(axis, axis.min_rad);
  const auto second = counts_from_rad(axis, axis.max_rad);
  CHECK(first && second, "the configuration was checked");
  steps.add({0x607D, 1}, "software position limit, minimum", 4, std::min(*first, *second));
  steps.add({0x607D, 2}, "software position limit, maximum", 4, std::max(*first, *second));
  // The controller's own gate and watch come before these: a drive may lack them, which is told.
  const double motor_rpm = std::floor(axis.max_velocity_rad_s * axis.gear * 60.0 / kTwoPi);
  const auto add_told = [&](Object object, const char* object_name, int num_bytes,
                            std::int64_t value) {
    steps.add(object, object_name, num_bytes, value).need = Need::kTold;
  };
  add_told({0x607F, 0}, "max profile velocity", 4, limit(axis, axis.max_velocity_rad_s));
  add_told({0x6080, 0}, "max motor speed", 4,
           static_cast<std::int64_t>(std::max(1.0, std::min(motor_rpm, 4e9))));
  add_told({0x60C5, 0}, "max acceleration", 4, limit(axis, axis.max_acceleration_rad_s2));
  add_told({0x6085, 0}, "quick stop deceleration", 4, limit(axis, axis.quick_stop_rad_s2));
  add_told({0x6065, 0}, "following error window", 4, limit(axis, axis.following_error_rad));
  add_told({0x6066, 0}, "following error time out", 2, axis.following_error_ms);
  const auto permille = limit_permille(axis, axis.max_torque_Nm);
  CHECK(permille.has_value(), "the configuration was checked");
  belongs_to(steps.add({0x6072, 0}, "max torque", 2, *permille), Part::kTorqueLimit);
  belongs_to(steps.only_read({0x6077, 0}, "torque actual value", 2), Part::kTorqueActual);
}

/// Every missing object of hold on loss is told, not only the first.
void holds_on_loss(ObjectStep& step) {
  belongs_to(step, Part::kHoldOnLoss, When::kAlways);
}

void add_reactions(Steps& steps, const Cia402Params& params) {
  // Ramp down, then stay in QUICK STOP ACTIVE: torque stays on.
  holds_on_loss(steps.add({0x605A, 0}, "quick stop option code", 2, 6));
  // Heartbeat of the master lost, bus off or stopped: quick stop.
  holds_on_loss(steps.add({0x6007, 0}, "abort connection option code", 2, 3));
  steps.add({0x605E, 0}, "fault reaction option code", 2, 2);
  holds_on_loss(steps.add({0x1016, 1}, "consumer heartbeat time", 4,
                          std::int64_t{cia402::kMasterNode} << 16 | params.master_lost_ms));
  steps.add({0x1017, 0}, "producer heartbeat time", 2, params.drive_heartbeat_ms);
  steps.add({0x1029, 1}, "error behaviour, communication", 1, 1).need = Need::kTold;
  steps.add({0x1006, 0}, "communication cycle period", 4, params.cycle_us).need = Need::kTold;
}

}  // namespace

std::string check(const Cia402Params& params) {
  const std::string problem = check_bus(params);
  if (!problem.empty()) return problem;
  for (const AxisConfig& axis : params.axes) {
    const auto& others = params.other_nodes;
    if (std::find(others.begin(), others.end(), axis.node_id) != others.end()) {
      return "node_id " + std::to_string(axis.node_id) + " occurs twice";
    }
  }
  if (params.cycle_us > 100'000 || params.cycle_us % 1000 != 0) {
    return "cycle_us is 1000..100000, whole milliseconds";
  }
  if (params.master_heartbeat_us <= 0) return "master_heartbeat_us > 0";
  if (params.master_lost_ms * 1000 <= params.master_heartbeat_us || params.master_lost_ms > 65535) {
    return "master_lost_ms > master_heartbeat_us";
  }
  if (params.drive_heartbeat_ms < 1 || params.drive_lost_ms <= params.drive_heartbeat_ms ||
      params.drive_lost_ms > 65535) {
    return "0 < drive_heartbeat_ms < drive_lost_ms <= 65535";
  }
  if (params.sdo.timeout_us <= 0 || params.sdo.max_attempts < 1) {
    return "sdo.timeout_us > 0 and sdo.max_attempts >= 1";
  }
  return "";
}

std::vector<ObjectStep> configuration_of(const AxisConfig& axis, const Cia402Params& params) {
  Steps list;
  ObjectStep& type = list.add({0x1000, 0}, "device type", 4, 402);
  type.write = false;
  type.mask = 0xFFFF;
  list.add({0x6060, 0}, "modes of operation", 1, 8);
  list.add({0x60C2, 1}, "interpolation time, value", 1, params.cycle_us / 1000);
  list.add({0x60C2, 2}, "interpolation time, exponent", 1, -3);
  ObjectStep& encoder = list.add({0x608F, 1}, "encoder increments per revolution", 4,
                                 static_cast<std::int64_t>(axis.counts_per_rad * kTwoPi + 0.5));
  encoder.write = false;
  encoder.need = Need::kIfPresent;
  encoder.zero_is_unknown = true;
  add_motion_limits(list, axis);
  add_reactions(list, params);
  add_pdos(list, axis, params);
  std::vector<ObjectStep> steps = list.take();
  for (ObjectStep& step : steps) {
    const auto& accepted = params.optional_objects;
    const bool is_required =
        step.need == Need::kMotion || step.need == Need::kTold || step.need == Need::kIfPresent;
    if (is_required && std::find(accepted.begin(), accepted.end(), step.object) != accepted.end()) {
      step.need = Need::kOptional;
    }
  }
  return steps;
}

}  // namespace can
