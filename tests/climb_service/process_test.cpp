// SPDX-License-Identifier: BSD-3-Clause
// climb_controller, ladder-command and the plant as processes: bus and lines over local sockets,
// rungs and IMU over LCM. What ends, restarts and strangers do to them.
#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "runtime/bus.h"
#include "runtime/clock.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace {

using ladder_msgs::climb_state_t;
using ladder_msgs::command_t;
using support::ChildProcess;
using ::testing::HasSubstr;
using ::testing::Not;
using namespace std::chrono_literals;
namespace channels = runtime::channels;

const std::string kBin = LADDER_BIN_DIR;

class ClimbProcess : public ::testing::Test {
 protected:
  void SetUp() override {
    static int next_port = 40'000 + getpid() % 2'000 * 8;
    url_ = "udpm://239.255.76.67:" + std::to_string(next_port++) + "?ttl=0";
    bus_ = std::make_unique<runtime::Bus>(url_);
    states_ = &bus_->newest(channels::kClimb);
    poses_ = &bus_->newest(channels::kPose);
    plant_ = std::make_unique<ChildProcess>(
        kBin + "/ladder_plant",
        std::vector<std::string>{"--can", can(), "--lines", "unix:" + folder_ / "lines",
                                 "--rungs-from-truth", url_, "--print_period_s", "0.05"});
    for (int i = 0; i < 500 && ::access((folder_ / "lines").c_str(), F_OK) != 0; ++i) {
      usleep(10'000);
    }
  }

  std::string can() const { return "unix:" + folder_ / "can"; }
  std::unique_ptr<ChildProcess> controller(const std::string& can_interface) const {
    return std::make_unique<ChildProcess>(
        kBin + "/climb_controller",
        std::vector<std::string>{"--url", url_, "--set", "climb.can.interface=" + can_interface,
                                 "--set", "climb.lines.chip=unix:" + folder_ / "lines", "--set",
                                 "climb.flight_folder=" + folder_.path(), "--set",
                                 "climb.power_off_hold=brake"});
  }
  /// The exit code of ladder-command.
  int command(std::vector<std::string> words) {
    words.insert(words.end(), {"--url", url_});
    ChildProcess tool(kBin + "/ladder-command", words);
    const int code = tool.wait(240s).value_or(-1);
    said_ = tool.output();
    return code;
  }

  /// Tried again after what a starved machine does to any real-time program, and nothing else.
  bool arm() {
    for (int i = 0; i < 3; ++i) {
      if (command({"arm"}) == 0) return true;
      bool is_starved = false;
      for (const char* sign : {"overrun", "IMU silent", "perception silent", "transmit stalled"}) {
        is_starved = is_starved || said_.find(sign) != std::string::npos;
      }
      if (!is_starved) return false;
      usleep(500'000);
      command({"reset"});
    }
    return false;
  }

  /// The next state that satisfies the condition, within 60 s.
  template <class Condition>
  bool wait_for(Condition condition) {
    const std::int64_t until_us = runtime::clock_now().monotonic_us + 60'000'000;
    while (runtime::clock_now().monotonic_us < until_us) {
      usleep(5'000);
      bus_->drain();
      if (const climb_state_t* state = states_->take(0)) now_ = *state;
      if (now_.seq >= 0 && now_.session_id != 0 && condition(now_)) return true;
    }
    return false;
  }
  void send(std::int64_t session_id, std::int64_t seq, std::int8_t order) {
    command_t message{};
    message.utime = runtime::clock_now().utime_us;
    message.seq = seq;
    message.session_id = session_id;
    message.order = order;
    bus_->publish(channels::kCommand, message);
  }

  std::string url_;
  support::TemporaryFolder folder_;
  std::unique_ptr<runtime::Bus> bus_;
  runtime::Mailbox<climb_state_t>* states_ = nullptr;
  runtime::Mailbox<ladder_msgs::pose_t>* poses_ = nullptr;
  std::unique_ptr<ChildProcess> plant_;
  climb_state_t now_{};
  std::string said_;
};

// Power-up, armed on four rungs, one complete limb cycle to a new rung, standing, disarmed; the
// pose is published.
TEST_F(ClimbProcess, WholeRun) {
  const auto climber = controller(can());
  ASSERT_EQ(command({"state", "--wait", "DISARMED", "--timeout", "30"}), 0) << climber->output();
  EXPECT_EQ(command({"climb"}), 1);
  EXPECT_THAT(said_, HasSubstr("refused: not in DISARMED"));
  ASSERT_TRUE(arm()) << said_ << climber->output();
  ASSERT_TRUE(wait_for([](const climb_state_t& m) { return m.state == m.STATE_HOLD; }));
  const std::vector<int> docked_rungs(std::begin(now_.rung_id), std::end(now_.rung_id));
  EXPECT_THAT(docked_rungs, testing::Each(testing::Ge(0)));
  plant_->signal(SIGUSR1);
  ASSERT_EQ(command({"climb"}), 0) << said_;
  ASSERT_TRUE(wait_for([&docked_rungs](const climb_state_t& m) {
    return m.rung_id[3] != docked_rungs[3];
  })) << climber->output();
  ASSERT_EQ(command({"hold"}), 0) << said_ << climber->output();
  EXPECT_NE(poses_->take(0), nullptr);
  ASSERT_EQ(command({"disarm"}), 0) << said_;
  EXPECT_TRUE(plant_->comes_to_show("enabled  0")) << plant_->last_line();
}

// The dock is taken away and brought back: disarmed there, the claws open and the dock carries.
TEST_F(ClimbProcess, DisarmsInTheDock) {
  const auto climber = controller(can());
  ASSERT_EQ(command({"state", "--wait", "DISARMED", "--timeout", "30"}), 0) << climber->output();
  ASSERT_TRUE(arm()) << said_ << climber->output();
  plant_->signal(SIGUSR1);
  ASSERT_TRUE(plant_->comes_to_show("docked", false)) << plant_->last_line();
  plant_->signal(SIGUSR1);
  ASSERT_TRUE(plant_->comes_to_show("docked")) << plant_->last_line();
  ASSERT_EQ(command({"disarm", "--wait", "DISARMED"}), 0) << said_ << climber->output();
  EXPECT_TRUE(plant_->comes_to_show("enabled  0  claws - - - -")) << plant_->last_line();
  EXPECT_THAT(plant_->output(), Not(HasSubstr("FALLEN")));
}

// Asked to end while it stands and holds: the hand-over is not told as a fault, no flight is kept.
TEST_F(ClimbProcess, EndInHoldIsNoFault) {
  const auto climber = controller(can());
  ASSERT_EQ(command({"state", "--wait", "DISARMED", "--timeout", "30"}), 0) << climber->output();
  ASSERT_TRUE(arm()) << said_ << climber->output();
  const std::size_t before = climber->output().size();
  climber->signal(SIGTERM);
  EXPECT_EQ(climber->wait(10s), 0);
  const std::string told = climber->output().substr(before);
  EXPECT_THAT(told, HasSubstr("handed over"));
  EXPECT_THAT(told, Not(HasSubstr("FAULT_HOLD")));
  EXPECT_THAT(told, Not(HasSubstr("candump")));
  EXPECT_TRUE(plant_->comes_to_show("enabled  0")) << plant_->last_line();
}

// Asked to end while climbing: the step in the air is finished, then the drives hold by themselves.
TEST_F(ClimbProcess, EndsHolding) {
  const auto climber = controller(can());
  ASSERT_EQ(command({"state", "--wait", "DISARMED", "--timeout", "30"}), 0) << climber->output();
  ASSERT_TRUE(arm()) << said_ << climber->output();
  plant_->signal(SIGUSR1);
  ASSERT_EQ(command({"climb"}), 0) << said_;
  ASSERT_TRUE(wait_for([](const climb_state_t& m) { return m.limb_state[3] == m.LIMB_TRANSIT; }));
  climber->signal(SIGTERM);
  EXPECT_EQ(climber->wait(60s), 0);
  EXPECT_THAT(climber->output(), HasSubstr("handed over"));
  EXPECT_THAT(plant_->output(), Not(HasSubstr("FALLEN")));
  EXPECT_THAT(plant_->last_line(), Not(HasSubstr(" - ")));  // no claw without a rung
}

// An order of another run and an order that was given before change nothing and are told so.
TEST_F(ClimbProcess, RefusesReplayedOrders) {
  auto climber = controller(can());
  ASSERT_EQ(command({"state", "--wait", "DISARMED", "--timeout", "30"}), 0) << climber->output();
  ASSERT_TRUE(wait_for([](const climb_state_t&) { return true; }));
  const std::int64_t old_session = now_.session_id;
  climber->signal(SIGTERM);
  ASSERT_EQ(climber->wait(10s), 0);

  climber = controller(can());
  ASSERT_TRUE(wait_for([old_session](const climb_state_t& m) {
    return m.session_id != old_session && m.state == m.STATE_DISARMED;
  })) << climber->output();
  send(old_session, 1'000'000, command_t::ORDER_ARM);
  ASSERT_TRUE(
      wait_for([](const climb_state_t& m) { return m.order_verdict == m.VERDICT_WRONG_SESSION; }));
  EXPECT_EQ(now_.state, now_.STATE_DISARMED);
  send(now_.session_id, 5, command_t::ORDER_PAUSE);  // heard, though it means nothing here
  ASSERT_TRUE(wait_for([](const climb_state_t& m) { return m.order_seq == 5; }));
  send(now_.session_id, 5, command_t::ORDER_ARM);
  ASSERT_TRUE(
      wait_for([](const climb_state_t& m) { return m.order_verdict == m.VERDICT_REPLAYED; }));
  EXPECT_EQ(now_.state, now_.STATE_DISARMED);
  EXPECT_TRUE(plant_->comes_to_show("enabled  0")) << plant_->last_line();
}

// A second controller of this host refuses to start; so does one that only hears the first on the
// bus. The first goes on.
TEST_F(ClimbProcess, SecondControllerRefusesToStart) {
  const auto first = controller(can());
  ASSERT_EQ(command({"state", "--wait", "DISARMED", "--timeout", "30"}), 0) << first->output();
  const auto second = controller(can());
  EXPECT_EQ(second->wait(10s), 3);
  EXPECT_THAT(second->output(), HasSubstr("another controller of this host"));

  const std::string other_name = folder_ / "other_name";
  ASSERT_EQ(::symlink((folder_ / "can").c_str(), other_name.c_str()), 0);
  const auto third = controller("unix:" + other_name);
  EXPECT_EQ(third->wait(10s), 3);
  EXPECT_THAT(third->output(), HasSubstr("another controller speaks"));
  EXPECT_TRUE(first->running());
  ASSERT_TRUE(wait_for([&](const climb_state_t& m) { return m.cycles > 0; }));
  EXPECT_EQ(now_.state, now_.STATE_DISARMED) << first->output();
}

// Killed while its drives are enabled: they stop and hold by themselves; a new one starts without
// touching them and waits to be armed.
TEST_F(ClimbProcess, KilledControllerLeavesHoldingDrives) {
  auto climber = controller(can());
  ASSERT_EQ(command({"state", "--wait", "DISARMED", "--timeout", "30"}), 0) << climber->output();
  ASSERT_EQ(command({"arm", "--wait", "ARMING"}), 0) << said_;
  ASSERT_TRUE(wait_for([](const climb_state_t& m) { return m.has_targets != 0; }));
  climber->signal(SIGKILL);
  EXPECT_EQ(climber->wait(5s), 128 + SIGKILL);
  usleep(600'000);
  EXPECT_TRUE(plant_->comes_to_show("enabled  0")) << plant_->last_line();
  climber = controller(can());
  const std::int64_t old_session = now_.session_id;
  ASSERT_TRUE(wait_for([old_session](const climb_state_t& m) {
    return m.session_id != old_session && m.state == m.STATE_DISARMED;
  })) << climber->output();
}

// Killed while it hangs on the ladder: the next one is armed there, claw by claw, and lets none go.
TEST_F(ClimbProcess, IsArmedOnTheLadderAfterAKill) {
  auto climber = controller(can());
  ASSERT_EQ(command({"state", "--wait", "DISARMED", "--timeout", "30"}), 0) << climber->output();
  ASSERT_TRUE(arm()) << said_ << climber->output();
  plant_->signal(SIGUSR1);
  ASSERT_TRUE(wait_for([](const climb_state_t& m) { return m.state == m.STATE_HOLD; }));
  const std::int64_t old_session = now_.session_id;
  climber->signal(SIGKILL);
  climber->wait(5s);
  climber = controller(can());
  ASSERT_TRUE(wait_for([old_session](const climb_state_t& m) {
    return m.session_id != old_session && m.state == m.STATE_DISARMED;
  })) << climber->output();
  EXPECT_TRUE(arm()) << said_ << climber->output();
  EXPECT_THAT(plant_->output(), Not(HasSubstr("FALLEN")));
  EXPECT_THAT(plant_->last_line(), Not(HasSubstr(" - ")));  // no claw without a rung
}

// Stopped in its tracks for a while, as by a debugger: the drives have stopped by themselves;
// going on it finds that out and stays in FAULT_HOLD, until the operator's reset: then it is armed
// again.
TEST_F(ClimbProcess, HungControllerStaysStopped) {
  const auto climber = controller(can());
  ASSERT_EQ(command({"state", "--wait", "DISARMED", "--timeout", "30"}), 0) << climber->output();
  ASSERT_EQ(command({"arm", "--wait", "ARMING"}), 0) << said_;
  ASSERT_TRUE(wait_for([](const climb_state_t& m) { return m.has_targets != 0; }));
  climber->signal(SIGSTOP);
  usleep(300'000);
  EXPECT_TRUE(plant_->comes_to_show("enabled  0")) << plant_->last_line();
  climber->signal(SIGCONT);
  ASSERT_TRUE(wait_for([](const climb_state_t& m) { return m.state == m.STATE_FAULT_HOLD; }))
      << climber->output();
  EXPECT_GT(now_.overruns, 0);
  usleep(300'000);
  EXPECT_TRUE(plant_->comes_to_show("enabled  0")) << plant_->last_line();
  EXPECT_EQ(command({"reset"}), 0) << said_ << climber->output();
  EXPECT_TRUE(arm()) << said_ << climber->output();
}

// The E-stop line stops everything and stays latched after its release until the operator's reset;
// the last bus frames are written.
TEST_F(ClimbProcess, StopsByTheLine) {
  const auto climber = controller(can());
  ASSERT_EQ(command({"state", "--wait", "DISARMED", "--timeout", "30"}), 0) << climber->output();
  ASSERT_EQ(command({"arm", "--wait", "ARMING"}), 0) << said_;
  ASSERT_TRUE(wait_for([](const climb_state_t& m) { return m.has_targets != 0; }));
  plant_->signal(SIGUSR2);
  ASSERT_TRUE(wait_for([](const climb_state_t& m) { return m.state == m.STATE_ESTOP; }));
  EXPECT_EQ(now_.reason, now_.REASON_ESTOP);
  EXPECT_EQ(command({"reset"}), 1);
  plant_->signal(SIGUSR2);
  ASSERT_TRUE(wait_for([](const climb_state_t& m) { return m.estop_active == 0; }));
  EXPECT_EQ(now_.state, now_.STATE_ESTOP);
  usleep(500'000);  // the drives must have come to stand
  EXPECT_EQ(command({"reset"}), 0) << said_ << climber->output();
  EXPECT_THAT(climber->output(), HasSubstr(".candump.log"));
}

// Without a controller the tool says so and ends with 3; a word that is no state is an argument
// error.
TEST_F(ClimbProcess, CommandWithoutController) {
  EXPECT_EQ(command({"state"}), 3);
  EXPECT_THAT(said_, HasSubstr("no climb_controller is heard"));
  EXPECT_EQ(command({"arm", "--wait", "ARMD"}), 2);
  EXPECT_EQ(command({}), 2);
}

// No bus, no lines: exit 3 with the culprit's name. The shipped configuration equals the defaults.
TEST_F(ClimbProcess, StartsOnlyWithDevices) {
  ChildProcess no_bus(kBin + "/climb_controller",
                      {"--url", url_, "--set", "climb.can.interface=unix:/no/such/can"});
  EXPECT_EQ(no_bus.wait(10s), 3);
  EXPECT_THAT(no_bus.output(), HasSubstr("/no/such/can"));
  ChildProcess no_lines(kBin + "/climb_controller",
                        {"--url", url_, "--set", "climb.can.interface=" + can(), "--set",
                         "climb.lines.chip=unix:/no/such/lines"});
  EXPECT_EQ(no_lines.wait(10s), 3);
  EXPECT_THAT(no_lines.output(), HasSubstr("/no/such/lines"));
  const std::string file = std::string(LADDER_CONFIG_DIR) + "/robot.toml";
  ChildProcess shipped(kBin + "/climb_controller", {"--check", "--config", file});
  ChildProcess built_in(kBin + "/climb_controller", {"--check"});
  ASSERT_EQ(shipped.wait(10s), 0) << shipped.output();
  ASSERT_EQ(built_in.wait(10s), 0);
  EXPECT_EQ(shipped.output(), built_in.output());
}

// A wrong value ends the start with 2 and the key's name, before any device is touched.
TEST_F(ClimbProcess, WrongConfiguration) {
  const std::pair<const char*, const char*> wrong[] = {
      {"climb.no_such_key=1", "climb.no_such_key"},
      {"climb.power_off_hold=rope", "power_off_hold"},
      {"climb.can.accepted_objects=605E", "accepted_objects"},
      {"climb.can.protocol=canopen", "protocol"},
      {"climb.period_s=0.5", "period_s"},
      {"climb.drives.node_id=[1,1,3,4,5,6,7,8,9,10,11,12,13,14,15,16]", "node_id"},
      {"climb.robot.knee_bend.max_rad=0.1", "knee_bend"},
      {"climb.lines.chip=''", "chip"}};
  for (const auto& [setting, culprit] : wrong) {
    ChildProcess child(kBin + "/climb_controller", {"--check", "--set", setting});
    EXPECT_EQ(child.wait(10s), 2) << setting;
    EXPECT_THAT(child.output(), HasSubstr(culprit)) << setting;
  }
}

}  // namespace
