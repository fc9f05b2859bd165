// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/state_words.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "climb_controller/control_cycle.h"

namespace climb_controller::words {
namespace {

using ladder_msgs::climb_state_t;

// Numbers as in convert.cpp, where both ends of each enumeration are compared.
template <class Enum>
Enum meant(std::int8_t told) {
  return static_cast<Enum>(told - 1);
}

const char* reason(std::int8_t told) {
  if (told < climb_state_t::REASON_ESTOP || told > climb_state_t::REASON_PERCEPTION_SILENT) {
    return "none";
  }
  return climb::name(static_cast<climb::Fault>(told - climb_state_t::REASON_ESTOP));
}

const char* limb(std::int8_t told) {
  const bool is_known =
      told >= climb_state_t::LIMB_LOADED && told <= climb_state_t::LIMB_SUPPORT_LOST;
  return is_known ? climb::name(meant<climb::LimbState>(told)) : "UNKNOWN";
}

std::string line(const char* format, auto... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string limbs(const climb_state_t& m) {
  std::string text;
  for (const climb::Leg leg : climb::kLegs) {
    const std::string rung =
        m.rung_id[leg] >= 0 ? "rung " + std::to_string(m.rung_id[leg]) : std::string("no rung");
    text += line("  %s %-13s %-9s %s\n", climb::name(leg), limb(m.limb_state[leg]), rung.c_str(),
                 m.touch[leg] != 0 ? "touch" : "");
  }
  return text;
}

}  // namespace

const char* state(std::int8_t told) {
  const bool is_known = told >= climb_state_t::STATE_BOOT && told <= climb_state_t::STATE_DISARMING;
  return is_known ? climb::name(meant<climb::ControllerState>(told)) : "UNKNOWN";
}

std::optional<std::int8_t> state_from(const std::string& word) {
  for (std::int8_t told = climb_state_t::STATE_BOOT; told <= climb_state_t::STATE_DISARMING;
       ++told) {
    if (word == state(told)) return told;
  }
  return std::nullopt;
}

std::string state_and_reason(const climb_state_t& m) {
  std::string text = state(m.state);
  if (m.reason > climb_state_t::REASON_NONE) text += std::string(": ") + reason(m.reason);
  if (m.refusal > climb_state_t::REFUSAL_NONE) {
    text += std::string(" (no grasp: ") + climb::name(meant<climb::Refusal>(m.refusal)) + ")";
  }
  if (m.burden > climb_state_t::BURDEN_BORNE) {
    text += std::string(" (no limb may be lifted: ") + climb::name(meant<climb::Burden>(m.burden)) +
            ")";
  }
  if (m.at_top != 0) text += " (at the top)";
  return text;
}

std::string why_refused(const climb_state_t& m) {
  switch (m.order_verdict) {
    case climb_state_t::VERDICT_WRONG_SESSION:
      return "it was meant for another run of the controller";
    case climb_state_t::VERDICT_REPLAYED:
      return "its number was used before; somebody else gives orders too";
    default:
      break;
  }
  if (m.policy > climb_state_t::POLICY_NONE) return name(meant<Policy>(m.policy));
  if (m.reason > climb_state_t::REASON_NONE) return reason(m.reason);
  return std::string("not in ") + state(m.state);
}

std::string overview(const climb_state_t& m) {
  std::string text = state_and_reason(m) + "\n" + limbs(m);
  const auto enabled =
      std::count(std::begin(m.drive_state), std::end(m.drive_state), m.DRIVE_OPERATION_ENABLED);
  const auto heard = std::count(std::begin(m.is_heard), std::end(m.is_heard), 1);
  text += line("  servo bus %s, %d of 16 drives heard, %d enabled\n",
               can::name(meant<can::BusPhase>(m.bus_phase)), static_cast<int>(heard),
               static_cast<int>(enabled));
  text += line("  E-stop %s\n", m.lines_lost != 0     ? "cannot be read"
                                : m.estop_active != 0 ? "pressed, or its wire is broken"
                                                      : "clear");
  text += line("  cycle p50 %d us, p99 %d us; late p99 %d us; %lld overruns of %lld cycles\n",
               m.cycle_p50_us, m.cycle_p99_us, m.late_p99_us, static_cast<long long>(m.overruns),
               static_cast<long long>(m.cycles));
  return text;
}

}  // namespace climb_controller::words
