// SPDX-License-Identifier: BSD-3-Clause
// The fault table as data, what comes as messages: perception (rows 1 to 3), orders (28), floods
// (31).
#include <array>

#include "robot_in_a_box/drill_expect.h"
#include "robot_in_a_box/drill_tables.h"

namespace robot_in_a_box {
namespace {

using climb::LimbState;
using climb::Order;
using S = climb::ControllerState;

// --- rows 1 to 3: perception ---------------------------------------------------------------------

void silence(CaseRun& run) {
  run.memo = run.box().perception().received_us();
  run.box().perception().silent = true;
}
std::int64_t last_message_at(const CaseRun& run) {
  return run.memo;
}
bool is_protected(const CaseRun& run) {
  return run.state() == S::kProtectiveHold;
}
const char* harm_but_loading(const CaseRun& run) {
  const LimbState at = run.before().limb;
  const bool finishes = at == LimbState::kLoading || at == LimbState::kVerify ||
                        at == LimbState::kClosing || run.before().shifts;
  return finishes ? harm_to_grasps(run) : harm_after_stop(run);
}

bool waits_for_perception(const Situation& at) {
  return at.state == S::kProtectiveHold;
}
void speak_again(CaseRun& run) {
  run.box().perception().silent = false;
}
bool climbs_on(const CaseRun& run) {
  return run.state() == S::kClimbing;
}

void climb_unseeing(CaseRun& run) {
  if (run.since_us() == 400'000) run.box().order(Order::kClimb);
}
bool did_not_start(const CaseRun& run) {
  return run.since_us() >= 420'000 && (is_protected(run) || run.state() == S::kHold);
}
std::int64_t climb_ordered_at(const CaseRun& run) {
  return run.since_us() >= 410'000 ? run.injected_us() + 400'000 : -1;
}

// --- rows 2 and 3: messages that are not believed ------------------------------------------------

template <Nonsense kKind>
void speak_nonsense(CaseRun& run) {
  run.memo = run.box().perception().received_us();
  run.box().perception().nonsense = kKind;
}
bool ignores_it(const CaseRun& run) {
  return run.box().perception().received_us() == run.memo;
}
const char* harm_by_believing(const CaseRun& run) {
  if (run.box().perception().received_us() != run.memo) return "a bad message was taken";
  return harm_to_grasps(run);
}
/// Before the rungs have grown too old nothing may change for a bad message.
const char* harm_by_change(const CaseRun& run) {
  const bool stops = run.state() == S::kFaultHold || run.state() == S::kEstop;
  if (stops && !is_latched(run.before().state)) return "stopped for a message";
  return harm_by_believing(run);
}

template <Nonsense kKind>
constexpr DrillRow nonsense_row(int number, const char* part, const char* injected) {
  return {number,
          part,
          number == 2 ? "message out of order or time" : "message that makes no sense",
          injected,
          "dropped, nothing changes",
          everywhere,
          1,
          speak_nonsense<kKind>,
          nullptr,
          ignores_it,
          harm_by_change,
          nullptr,
          kT_us,
          200'000};
}
template <Nonsense kKind>
constexpr DrillRow long_nonsense_row(int number, const char* part, const char* injected) {
  return {number,
          part,
          number == 2 ? "only messages out of order" : "only senseless messages",
          injected,
          "as row 1: PROTECTIVE_HOLD",
          in_climbing,
          1,
          speak_nonsense<kKind>,
          last_message_at,
          is_protected,
          harm_by_believing,
          nullptr,
          300'000 + kT_us,
          800'000};
}

// --- rows 28 and 31: orders ----------------------------------------------------------------------

Order any_order(CaseRun& run) {
  constexpr std::array<Order, 7> kOrders = {Order::kArm,   Order::kClimb, Order::kClimbDown,
                                            Order::kPause, Order::kHold,  Order::kReset,
                                            Order::kDisarm};
  return kOrders[run.rng().below(7)];
}
void order_of_another_run(CaseRun& run) {
  const std::uint64_t other = run.box().session_id() ^ (1ULL << run.rng().below(64));
  run.memo = run.box().last_seq() + 1000;
  run.box().order({any_order(run), other, run.memo});
}
void order_from_a_log(CaseRun& run) {
  run.memo = static_cast<std::int64_t>(
      run.rng().below(static_cast<std::uint32_t>(run.box().last_seq() + 1)));
  run.box().order({any_order(run), run.box().session_id(), run.memo});
}
bool rejects_session(const CaseRun& run) {
  const bool is_next = run.report().now_us > run.injected_us();
  return is_next && run.report().verdict == climb::CommandVerdict::kWrongSession;
}
bool rejects_sequence(const CaseRun& run) {
  return run.report().order_seq == run.memo &&
         run.report().verdict == climb::CommandVerdict::kReplayed;
}
bool knows_orders(const Situation& at) {
  return at.state != S::kBoot && at.state != S::kSelftest &&
         !(at.state == S::kDisarmed && at.docked);
}
const char* harm_by_obeying(const CaseRun& run) {
  const bool by_itself = run.before().state == S::kClimbing || run.before().state == S::kArming ||
                         run.before().state == S::kDisarming ||
                         run.before().state == S::kProtectiveHold ||
                         is_unpowered(run.before().state);
  if (!by_itself && run.state() != run.before().state) return "obeyed";
  const bool starts = is_unpowered(run.before().state) && !is_unpowered(run.state());
  return starts ? "obeyed" : harm_to_grasps(run);
}

/// Ten orders of strangers and ten old messages each millisecond.
void flood(CaseRun& run) {
  for (int i = 0; i < 10; ++i) run.box().perception().repeat(run.now_us());
  for (int i = 0; i < 10; ++i) {
    const std::uint64_t other = run.rng().next() & ~1ULL;
    run.box().order({any_order(run), other, static_cast<std::int64_t>(run.rng().next() >> 1)});
  }
}

constexpr std::array kMessageRows = {
    nonsense_row<Nonsense::kRepeated>(2, "a", "repeated"),
    nonsense_row<Nonsense::kReordered>(2, "b", "reordered"),
    nonsense_row<Nonsense::kOld>(2, "c", "a second old"),
    nonsense_row<Nonsense::kAhead>(2, "d", "an hour ahead"),
    long_nonsense_row<Nonsense::kRepeated>(2, "e", "ten and more in a row"),
    nonsense_row<Nonsense::kNotFinite>(3, "a", "NaN"),
    nonsense_row<Nonsense::kHuge>(3, "b", "1e30 m"),
    nonsense_row<Nonsense::kBadCount>(3, "c", "bad array length"),
    long_nonsense_row<Nonsense::kNotFinite>(3, "d", "ten and more in a row"),
    DrillRow{1, "a", "perception silent", "no more messages", "PROTECTIVE_HOLD", in_climbing, 1,
             silence, last_message_at, is_protected, harm_but_loading, nullptr, 300'000 + kT_us,
             800'000},
    DrillRow{1, "b", "perception silent", "messages again", "CLIMBING goes on",
             waits_for_perception, 1, speak_again, next_message_at, climbs_on, harm_to_grasps,
             nullptr, 2 * kT_us, 300'000},
    DrillRow{1, "c", "perception silent", "no messages, then the order to climb", "no reach",
             in_hold, 1, silence, climb_ordered_at, did_not_start, harm_by_reaching, climb_unseeing,
             2 * kT_us, 1'500'000},
    DrillRow{28, "a", "order replayed", "of another session", "rejected", everywhere, 1,
             order_of_another_run, nullptr, rejects_session, harm_by_obeying, nullptr, kT_us,
             100'000},
    DrillRow{28, "b", "order replayed", "an old number", "rejected", knows_orders, 1,
             order_from_a_log, nullptr, rejects_sequence, harm_by_obeying, nullptr, kT_us, 100'000},
    DrillRow{31, "", "flood", "10 000 orders, 10 000 messages a second", "goes on", everywhere, 1,
             flood, nullptr, takes_no_notice, harm_by_notice, flood, 300'000, 400'000},
};

}  // namespace

std::span<const DrillRow> rows_of_messages() {
  return kMessageRows;
}

}  // namespace robot_in_a_box
