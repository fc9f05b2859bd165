// SPDX-License-Identifier: BSD-3-Clause
// ladder_fault_rows: those rows of the fault table that need a kernel, each many times on vcan and
// gpio-sim, while a claw reaches for its rung from the dock or while all four hold. A reaction is
// met when the controller has stopped for the right reason within the bound and 50 ms for an
// emulated machine; where it must fall silent, when the plant heard no frame of it after that.
// Times are of the guest's clock. The other rows, all states and exact bounds: the drill in virtual
// time.
#include "tests/hardware/fault_rows.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <linux/can.h>
#include <linux/can/error.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/rng.h"
#include "simulator/plant/socket_can_port.h"
#include "tests/hardware/kernel_box.h"

namespace hardware {
namespace {

using climb::CommandVerdict;
using climb::ControllerState;
using climb::Order;

constexpr const char* kInterface = "vcan0";
constexpr double kSilence_s = 0.2;  ///< listened for after a reaction that must be silent

struct Row {
  RowTitle title;
  climb::FaultFlags reasons;  ///< one of these is told
  bool silent;                ///< the controller may not send any more
};

constexpr Row kRows[] = {
    {{11, "a drive says nothing", 40}, climb::flag(climb::Fault::kServoSilent), false},
    {{12, "a drive's heartbeat stops", 260}, climb::flag(climb::Fault::kHeartbeatLost), false},
    {{13, "a drive reports a fault", 10}, climb::flag(climb::Fault::kServoFault), false},
    {{16, "eleven odd frames in a second", 10},
     climb::flag(climb::Fault::kMalformedFrames) | climb::flag(climb::Fault::kServoState),
     false},
    {{17, "bus-off", 10}, climb::flag(climb::Fault::kBusDown), true},
    {{19, "interface down", 10}, climb::flag(climb::Fault::kBusDown), true},
    {{23, "E-stop pressed, or its wire broken", 20}, climb::flag(climb::Fault::kEstop), false},
    {{26, "a second master on the bus", 10}, climb::flag(climb::Fault::kSecondController), true},
};

void set_interface(bool up) {
  const int fd = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
  ifreq request{};
  std::strncpy(request.ifr_name, kInterface, IFNAMSIZ - 1);
  ::ioctl(fd, SIOCGIFFLAGS, &request);
  request.ifr_flags =
      static_cast<short>(up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP);
  if (::ioctl(fd, SIOCSIFFLAGS, &request) != 0) std::perror("cannot set the interface");
  ::close(fd);
}

/// Another node, or another program, on the bus.
class Stranger {
 public:
  Stranger() : port_(kInterface) {}

  void send(std::uint32_t id, int length) {
    simulator::BusFrame frame;
    frame.id = id;
    frame.length = static_cast<std::uint8_t>(length);
    const std::int64_t num_lost = port_.num_lost();
    port_.send(frame);
    // A socket reports once that its interface had been down, instead of sending.
    if (port_.num_lost() > num_lost) port_.send(frame);
  }
  void send_odd_frames() {
    for (int i = 0; i < 11; ++i) {
      switch (i % 3) {
        case 0:
          send(0x181 | CAN_RTR_FLAG, 0);
          break;
        case 1:
          send(0x181 | CAN_EFF_FLAG, 8);
          break;
        default:
          send(0x181, 3);
      }
    }
  }
  void send_as_master(int repetition) {
    constexpr struct {
      std::uint32_t id;
      int length;
    } kFrames[] = {{0x000, 2}, {0x080, 0}, {0x201, 8}, {0x301, 8}, {0x601, 8}, {0x77F, 1}};
    const auto& frame = kFrames[repetition % 6];
    send(frame.id, frame.length);
  }

 private:
  simulator::SocketCanPort port_;
};

class RowRunner {
 public:
  explicit RowRunner(std::string chip_folder) : chip_folder_(std::move(chip_folder)) {}

  RowResult run(const Row& row, int repetitions) {
    RowResult result;
    for (int i = 0; i < repetitions; ++i) {
      if (!bring_up_patiently(i, result)) {
        result.miss("gave up");
        continue;
      }
      run_once(row, i, result);
      end(row, i);
      if (!recover()) forget(result);
    }
    if (box_) forget(result);
    return result;
  }

 private:
  void forget(RowResult& result) {
    result.violations += static_cast<std::int64_t>(box_->monitor().violations().size());
    for (const auto& violation : box_->monitor().violations()) {
      result.complaints.push_back(simulator::describe(violation));
    }
    box_.reset();
  }

  /// On a machine that does something else meanwhile a drive may miss the controller's frames and
  /// say so before the row has begun.
  bool bring_up_patiently(int repetition, RowResult& result) {
    for (int attempt = 0; attempt < 3; ++attempt) {
      if (bring_up(repetition)) return true;
      result.complaints.push_back("did not come up: " + box_->problems());
      box_.reset();
    }
    return false;
  }

  /// Every tenth time until four claws hold, else into a claw's way to its rung.
  bool bring_up(int repetition) {
    if (!box_) {
      KernelBoxParams params;
      params.chip_folder = chip_folder_;
      box_ = std::make_unique<KernelBox>(params);
      if (!box_->reach(ControllerState::kDisarmed, 20.0)) return false;
      const std::int64_t patient_us = box_->now_us() + 10'000'000;
      while (box_->report().bus_phase != can::BusPhase::kReady && box_->now_us() < patient_us) {
        box_->cycle();
      }
    }
    if (box_->order(Order::kArm) != CommandVerdict::kAccepted) return false;
    if (repetition % 10 == 0) return box_->reach(ControllerState::kHold, 60.0);
    const std::int64_t patient_us = box_->now_us() + 10'000'000;
    while (!box_->report().output.send && box_->now_us() < patient_us) box_->cycle();
    box_->run_s(rng_.uniform());
    return box_->state() == ControllerState::kArming || box_->state() == ControllerState::kHold;
  }

  void run_once(const Row& row, int repetition, RowResult& result) {
    std::int64_t begun_us = 0;
    box_->at(box_->now_us() + 20'000 + static_cast<std::int64_t>(rng_.below(10'000)), [&] {
      begun_us = box_->now_us();
      begin(row, repetition);
    });
    const double most_s = 1e-3 * (row.title.bound_ms + 1000);
    const std::int64_t give_up_us = box_->now_us() + static_cast<std::int64_t>(1e6 * most_s);
    while (!is_latched(box_->state()) && box_->now_us() < give_up_us) box_->cycle();
    const std::int64_t reacted_us = box_->now_us();
    if (!is_latched(box_->state()) || (climb::flag(box_->reason()) & row.reasons) == 0) {
      result.miss(box_->problems());
      return;
    }
    double time_ms = 1e-3 * static_cast<double>(reacted_us - begun_us);
    if (row.silent) {
      box_->run_s(kSilence_s);
      time_ms = std::max(time_ms, 1e-3 * static_cast<double>(box_->master_heard_us() - begun_us));
    }
    result.add(time_ms, row.title.bound_ms);
  }

  void begin(const Row& row, int repetition) {
    const int axis = repetition % simulator::kNumAxes;
    simulator::RobotPlant& plant = box_->plant();
    switch (row.title.number) {
      case 11:
        plant.drive(axis).faults.silent = true;
        return;
      case 12:
        plant.drive(axis).faults.no_heartbeat = true;
        return;
      case 13:
        return plant.inject(axis, 0x2310);
      case 16:
        return stranger_.send_odd_frames();
      case 17:
        return stranger_.send(CAN_ERR_FLAG | CAN_ERR_BUSOFF, 8);
      case 19:
        return set_interface(false);
      case 23:
        if (repetition % 2 == 0) return plant.press_estop(true);
        return plant.set_wire_fault(simulator::kEstopN, simulator::WireFault::kStuckLow);
      default:
        return stranger_.send_as_master(repetition);
    }
  }

  /// The cause goes.
  void end(const Row& row, int repetition) {
    const int axis = repetition % simulator::kNumAxes;
    simulator::RobotPlant& plant = box_->plant();
    plant.drive(axis).faults = {};
    plant.press_estop(false);
    plant.set_wire_fault(simulator::kEstopN, simulator::WireFault::kNone);
    if (row.title.number == 19) set_interface(true);
    box_->run_s(1.0);
  }

  /// Reset by the operator; tried again while the cause still hangs on.
  bool recover() {
    for (int i = 0; i < 10; ++i) {
      if (box_->order(Order::kReset) == CommandVerdict::kAccepted) return true;
      box_->run_s(0.5);
    }
    std::fprintf(stderr, "not reset: %s", box_->problems().c_str());
    return false;
  }

  std::string chip_folder_;
  std::unique_ptr<KernelBox> box_;
  Stranger stranger_;
  base::Rng rng_{1};
};

double median(std::vector<double> values) {
  if (values.empty()) return -1.0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

std::string json_of(const RowTitle& row, int cases, const RowResult& result) {
  char head[300];
  const double worst_ms = result.times_ms.empty()
                              ? -1.0
                              : *std::max_element(result.times_ms.begin(), result.times_ms.end());
  std::snprintf(
      head, sizeof head,
      "  {\"row\": %d, \"what\": \"%s\", \"cases\": %d, \"missed\": %d, \"bound_ms\": %d, "
      "\"allowed_ms\": %d, \"median_ms\": %.1f, \"worst_ms\": %.1f, \"violations\": %lld, "
      "\"times_ms\": [",
      row.number, row.what, cases, result.missed, row.bound_ms, row.bound_ms + kAllowed_ms,
      median(result.times_ms), worst_ms, static_cast<long long>(result.violations));
  std::string text = head;
  for (std::size_t i = 0; i < result.times_ms.size(); ++i) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.1f", i == 0 ? "" : ", ", result.times_ms[i]);
    text += number;
  }
  return text + "]}";
}

class Report {
 public:
  void add(const RowTitle& title, int cases, const RowResult& result) {
    const std::string line = json_of(title, cases, result);
    std::printf("%s\n", line.c_str());
    for (const std::string& complaint : result.complaints)
      std::printf("    %s\n", complaint.c_str());
    std::fflush(stdout);
    rows_ += (rows_.empty() ? "" : ",\n") + line;
    all_met_ = all_met_ && result.missed == 0;
  }
  bool all_met() const { return all_met_; }
  bool write(const std::string& path) const {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (file == nullptr) return false;
    std::fprintf(
        file,
        "{\"where\": \"vcan and gpio-sim in the machine of scripts/vm\", \"rows\": [\n%s\n]}\n",
        rows_.c_str());
    return std::fclose(file) == 0;
  }

 private:
  std::string rows_;
  bool all_met_ = true;
};

struct Options {
  std::vector<int> rows;  ///< empty: all
  int repetitions = 20;
  std::string json_path;
  std::string bin;

  bool wants(int number) const {
    return rows.empty() || std::find(rows.begin(), rows.end(), number) != rows.end();
  }
};

int run(const Options& options) {
  const char* chip_folder = std::getenv("LADDER_GPIO_SIM");
  if (chip_folder == nullptr) {
    std::fprintf(stderr, "run it in the machine: scripts/vm --vcan 1 --gpio-sim -- ...\n");
    return 3;
  }
  Report report;
  RowRunner runner(chip_folder);
  for (const Row& row : kRows) {
    if (!options.wants(row.title.number)) continue;
    report.add(row.title, options.repetitions, runner.run(row, options.repetitions));
  }
  for (const RowTitle& row : process_rows()) {
    if (!options.wants(row.number)) continue;
    report.add(row, options.repetitions,
               run_process_row(row.number, options.repetitions, options.bin, chip_folder));
  }
  if (!options.json_path.empty() && !report.write(options.json_path)) {
    std::perror(options.json_path.c_str());
    return 3;
  }
  return report.all_met() ? 0 : 1;
}

}  // namespace
}  // namespace hardware

int main(int argc, char** argv) {
  CLI::App app("Rows of the fault table on kernel devices.", "ladder_fault_rows");
  hardware::Options options;
  options.bin = LADDER_BIN_DIR;
  app.add_option("--rows", options.rows, "only these")->delimiter(',');
  app.add_option("--repeats", options.repetitions, "of each row");
  app.add_option("--json", options.json_path, "write the results here");
  CLI11_PARSE(app, argc, argv);
  return hardware::run(options);
}
