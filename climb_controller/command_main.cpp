// SPDX-License-Identifier: BSD-3-Clause
// ladder-command: the operator's word to climb_controller. Says what came of it and why.
// Exit codes: 0 accepted and the state was reached; 1 refused, or not reached; 2 wrong arguments;
// 3 no LCM, or no controller is heard.
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <poll.h>

#include "climb_controller/state_words.h"
#include "ladder_msgs/command_t.hpp"
#include "ladder_msgs/event_t.hpp"
#include "ladder_msgs/health_t.hpp"
#include "runtime/bus.h"
#include "runtime/clock.h"

namespace {

using ladder_msgs::climb_state_t;
using ladder_msgs::command_t;
namespace words = climb_controller::words;

constexpr int kExitRefused = 1;
constexpr int kExitArguments = 2;
constexpr int kExitNobody = 3;
constexpr double kHeardWithin_s = 3.0;
constexpr double kAnsweredWithin_s = 8.0;  // a reset waits for the servo bus

/// What an order is called, what it leads to, and how long that may take.
struct OrderRow {
  const char* word;
  std::int8_t order;
  std::int8_t leads_to;
  double within_s;
  const char* help;
};
constexpr OrderRow kOrders[] = {
    {"arm", command_t::ORDER_ARM, climb_state_t::STATE_HOLD, 180.0,
     "drives on; in the dock the four claws grasp their rungs"},
    {"climb", command_t::ORDER_CLIMB, climb_state_t::STATE_CLIMBING, 5.0, "up, until the top"},
    {"pause", command_t::ORDER_PAUSE, climb_state_t::STATE_PAUSED, 5.0,
     "stand at once, also in the middle of a step"},
    {"hold", command_t::ORDER_HOLD, climb_state_t::STATE_HOLD, 60.0,
     "finish the step in the air, then stand"},
    {"reset", command_t::ORDER_RESET, climb_state_t::STATE_DISARMED, 10.0,
     "after a fault or an E-stop, once its cause is gone"},
    {"disarm", command_t::ORDER_DISARM, climb_state_t::STATE_DISARMED, 10.0, "drives off"},
    {"state", command_t::ORDER_NONE, climb_state_t::STATE_UNKNOWN, 5.0, "only look"},
};

struct Arguments {
  const OrderRow* row = nullptr;
  bool down = false;
  std::string wait;
  std::optional<double> timeout_s;
  std::string url;
};

class Operator {
 public:
  explicit Operator(const std::string& url)
      : bus_(url),
        states_(bus_.newest(runtime::channels::kClimb)),
        events_(bus_.shared_queue(runtime::channels::kEvent, 64)) {}

  /// The next state of the controller within this time; nullptr = none came.
  const climb_state_t* next(std::int64_t until_us) {
    while (true) {
      const std::int64_t now_us = runtime::clock_now().monotonic_us;
      if (now_us >= until_us) return nullptr;
      pollfd waiting{bus_.file_descriptor(), POLLIN, 0};
      ::poll(&waiting, 1, static_cast<int>((until_us - now_us) / 1000) + 1);
      bus_.drain();
      tell_warnings();
      if (const climb_state_t* state = states_.take(runtime::clock_now().utime_us)) return state;
    }
  }

  void send(const command_t& command) { bus_.publish(runtime::channels::kCommand, command); }

 private:
  /// What the controller warns of meanwhile: which drive, which object, which line.
  void tell_warnings() {
    while (const ladder_msgs::event_t* event = events_.take(0)) {
      const bool is_ours = event->service == ladder_msgs::health_t::SERVICE_CLIMB;
      if (is_ours && event->level >= event->LEVEL_WARNING) {
        std::printf("  %s\n", event->text.c_str());
      }
    }
  }

  runtime::Bus bus_;
  runtime::Mailbox<climb_state_t>& states_;
  runtime::Queue<ladder_msgs::event_t>& events_;
};

std::int64_t after_s(double duration_s) {
  return runtime::clock_now().monotonic_us + static_cast<std::int64_t>(duration_s * 1e6);
}

/// Says each state once.
void say(const climb_state_t& state, std::string& said) {
  const std::string text = words::state_and_reason(state);
  if (text != said) std::printf("%s\n", text.c_str());
  std::fflush(stdout);
  said = text;
}

/// Sends the order; true when it was accepted.
bool give(Operator& operators, const Arguments& arguments, const climb_state_t& now) {
  command_t command{};
  command.utime = runtime::clock_now().utime_us;
  command.seq = now.order_seq + 1;
  command.session_id = now.session_id;
  command.order = arguments.down ? command_t::ORDER_CLIMB_DOWN : arguments.row->order;
  operators.send(command);
  const std::int64_t until_us = after_s(kAnsweredWithin_s);
  while (const climb_state_t* state = operators.next(until_us)) {
    if (state->session_id != command.session_id || state->order_seq < command.seq) continue;
    const bool accepted =
        state->order_seq == command.seq && state->order_verdict == climb_state_t::VERDICT_ACCEPTED;
    if (!accepted) std::printf("refused: %s\n", words::why_refused(*state).c_str());
    return accepted;
  }
  std::printf("no answer within %.0f s\n", kAnsweredWithin_s);
  return false;
}

/// Does not come any more without another order?
bool is_out_of_reach(const climb_state_t& state, std::int8_t wanted, bool was_arming) {
  const bool latched =
      state.state == climb_state_t::STATE_FAULT_HOLD || state.state == climb_state_t::STATE_ESTOP;
  const bool gave_up = was_arming && state.state == climb_state_t::STATE_DISARMED;
  return state.state != wanted && (latched || gave_up);
}

int wait_for(Operator& operators, std::int8_t wanted, double timeout_s, std::string& said) {
  const std::int64_t until_us = after_s(timeout_s);
  bool was_arming = false;
  while (const climb_state_t* state = operators.next(until_us)) {
    say(*state, said);
    if (state->state == wanted) return 0;
    was_arming = was_arming || state->state == climb_state_t::STATE_ARMING;
    if (is_out_of_reach(*state, wanted, was_arming)) return kExitRefused;
  }
  std::printf("%s was not reached within %g s\n", words::state(wanted), timeout_s);
  return kExitRefused;
}

int run(const Arguments& arguments) {
  Operator operators(arguments.url);
  const climb_state_t* first = operators.next(after_s(kHeardWithin_s));
  if (first == nullptr) {
    std::fprintf(stderr, "ladder-command: no climb_controller is heard on %s\n",
                 arguments.url.c_str());
    return kExitNobody;
  }
  std::string said;
  std::int8_t wanted = arguments.row->leads_to;
  if (!arguments.wait.empty()) wanted = *words::state_from(arguments.wait);
  if (arguments.row->order == command_t::ORDER_NONE) {
    if (wanted == climb_state_t::STATE_UNKNOWN) {
      std::printf("%s", words::overview(*first).c_str());
      return 0;
    }
    if (first->state == wanted) {
      say(*first, said);
      return 0;
    }
  } else {
    say(*first, said);
    if (!give(operators, arguments, *first)) return kExitRefused;
  }
  return wait_for(operators, wanted, arguments.timeout_s.value_or(arguments.row->within_s), said);
}

std::string default_url() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  return url != nullptr && *url != '\0' ? url : runtime::Bus::kDefaultUrl;
}

/// Throws CLI::ParseError.
void parse(CLI::App& app, int argc, char** argv, Arguments& arguments) {
  arguments.url = default_url();
  app.require_subcommand(1);
  app.add_option("--url", arguments.url, "LCM URL (default: LCM_DEFAULT_URL, else the robot's)");
  for (const OrderRow& row : kOrders) {
    CLI::App* order = app.add_subcommand(row.word, row.help);
    order->fallthrough();
    order->callback([&arguments, &row] { arguments.row = &row; });
    if (row.order == command_t::ORDER_CLIMB) {
      order->add_flag("--down", arguments.down, "back to the dock");
    }
  }
  const auto is_state = [](const std::string& word) {
    return words::state_from(word) ? "" : "no such state; e.g. HOLD, FAULT_HOLD, DISARMED";
  };
  app.add_option("--wait", arguments.wait, "wait for this state instead of the order's own")
      ->check(CLI::Validator(is_state, "STATE"));
  app.add_option("--timeout", arguments.timeout_s, "[s] to wait for it")
      ->check(CLI::Range(0.0, 86'400.0));
  app.parse(argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("The operator's word to climb_controller.", "ladder-command");
  try {
    parse(app, argc, argv, arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitArguments;
  }
  try {
    return run(arguments);
  } catch (const runtime::BusError& error) {
    std::fprintf(stderr, "ladder-command: %s\n", error.what());
    return kExitNobody;
  }
}
