// SPDX-License-Identifier: BSD-3-Clause
// The rows of the fault table that need climb_controller as a program: others of its kind, replayed
// orders, a flood of messages. Times run until its next message says so (one in two cycles).
#include "tests/hardware/fault_rows.h"
#include "tests/hardware/process_bench.h"

namespace hardware {
namespace {

using State = ProcessBench::State;
using ladder_msgs::command_t;

constexpr int kFlood_us = 500'000;
constexpr int kFloodRate_hz = 10'000;

double ms(std::int64_t us) {
  return 1e-3 * static_cast<double>(us);
}

/// It refuses to start; the first goes on as if nothing had been.
void start_second(ProcessBench& bench, int bound_ms, RowResult& result) {
  const std::int64_t start_us = ProcessBench::monotonic_us();
  const auto second = bench.start_controller();
  const int code = second->wait(std::chrono::seconds(20)).value_or(-1);
  const std::int64_t end_us = ProcessBench::monotonic_us();
  const std::int64_t seq = bench.now().seq;
  const auto goes_on = [seq](const State& m) { return m.seq > seq + 2; };
  if (code != 3) return result.miss("exit " + std::to_string(code) + ": " + second->output());
  if (!bench.wait_for(goes_on, 2.0) || bench.now().state != State::STATE_DISARMED) {
    return result.miss("the first one: " + bench.problems());
  }
  result.add(ms(end_us - start_us), bound_ms);
}

/// An order to arm of another run, or one given before: told so, and nothing moves.
void replay(ProcessBench& bench, int repetition, int bound_ms, RowResult& result) {
  const std::int64_t session = bench.now().session_id;
  const std::int64_t seq = 10 + 2 * repetition;
  bench.send(session, seq, command_t::ORDER_PAUSE);  // heard, though it means nothing here
  const auto heard = [seq](const State& m) { return m.order_seq == seq; };
  if (!bench.wait_for(heard, 2.0)) return result.miss("an order was not answered");
  const bool of_other_run = repetition % 2 == 0;
  bench.send(of_other_run ? session - 1 : session, of_other_run ? seq + 1 : seq,
             command_t::ORDER_ARM);
  const std::int8_t wanted = of_other_run ? State::VERDICT_WRONG_SESSION : State::VERDICT_REPLAYED;
  const auto took_us =
      bench.wait_for([wanted](const State& m) { return m.order_verdict == wanted; }, 2.0);
  if (!took_us) return result.miss("not refused: " + bench.problems());
  if (bench.now().state != State::STATE_DISARMED) return result.miss("it left DISARMED");
  result.add(ms(*took_us), bound_ms);
}

/// Garbage at ten thousand messages a second, as far as one emulated processor gets: the cycle is
/// as late as it says itself.
void flood(ProcessBench& bench, int bound_ms, RowResult& result) {
  const std::int64_t cycles = bench.now().cycles;
  const std::int64_t start_us = ProcessBench::monotonic_us();
  std::int64_t num_sent = 0;
  for (std::int64_t now_us = start_us; now_us < start_us + kFlood_us;
       now_us = ProcessBench::monotonic_us()) {
    if (num_sent * 1'000'000 < (now_us - start_us) * kFloodRate_hz) {
      bench.send(0, num_sent++, command_t::ORDER_NONE);
    }
  }
  const auto newer = [cycles](const State& m) { return m.cycles > cycles + 55; };
  if (!bench.wait_for(newer, 2.0)) return result.miss("it stopped: " + bench.problems());
  if (bench.now().state != State::STATE_DISARMED) return result.miss("it left DISARMED");
  result.add(ms(bench.now().late_max_us), bound_ms);
}

}  // namespace

std::vector<RowTitle> process_rows() {
  return {{26, "a second controller is started (with the program's start)", 3000},
          {28, "an order to arm is replayed", 30},
          {31, "a flood of messages; the cycle's lateness", 10}};
}

RowResult run_process_row(int number, int repetitions, const std::string& bin,
                          const std::string& chip_folder) {
  RowResult result;
  ProcessBench bench(bin, chip_folder);
  if (!bench.bring_to_disarmed()) {
    result.missed = repetitions;
    result.complaints.push_back("did not come up: " + bench.problems());
    return result;
  }
  int bound_ms = 0;
  for (const RowTitle& row : process_rows()) {
    if (row.number == number) bound_ms = row.bound_ms;
  }
  for (int i = 0; i < repetitions; ++i) {
    if (number == 26) start_second(bench, bound_ms, result);
    if (number == 28) replay(bench, i, bound_ms, result);
    if (number == 31) flood(bench, bound_ms, result);
  }
  return result;
}

}  // namespace hardware
