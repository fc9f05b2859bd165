// SPDX-License-Identifier: BSD-3-Clause
// How a chip and its lines are found, on chips that exist only here; the kernel's own are in
// tests/hardware.
#include "gpio/kernel_lines.h"

#include <algorithm>
#include <cerrno>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpio {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Wires {
  std::string label;
  std::vector<LineInfo> lines;
  std::vector<bool> levels = std::vector<bool>(8);
  int open_error = 0;
  int edge_error = 0;   ///< of a request with edges
  int plain_error = 0;  ///< of a request without
  bool is_gone = false;
  InputRequests requested{};
};

struct WiredChip : GpiodChip {
  explicit WiredChip(Wires& chip_wires) : wires(chip_wires) {}
  std::string label() const override { return wires.label; }
  int num_lines() const override { return static_cast<int>(wires.lines.size()); }
  LineInfo line(int offset) const override { return wires.lines.at(offset); }
  int request(const InputRequests& inputs, bool with_edges) override {
    for (const InputRequest& input : inputs) {
      if (wires.lines.at(input.offset).is_used) return EBUSY;
    }
    has_edges = with_edges;
    wires.requested = inputs;
    return with_edges ? wires.edge_error : wires.plain_error;
  }
  bool read(Levels& levels) override {
    for (std::size_t i = 0; i < levels.size(); ++i) {
      levels[i] = wires.levels.at(wires.requested[i].offset);
    }
    return !wires.is_gone;
  }
  int wake_fd() const override { return has_edges ? 9 : -1; }
  Wires& wires;
  bool has_edges = false;
};

struct WiredChips : Chips {
  std::vector<std::string> paths() const override {
    std::vector<std::string> paths;
    for (const auto& [path, wires] : by_path) paths.push_back(path);
    return paths;
  }
  std::unique_ptr<GpiodChip> open(const std::string& path, int& error) const override {
    Wires& wires = by_path.at(path);
    error = wires.open_error;
    return error == 0 ? std::make_unique<WiredChip>(wires) : nullptr;
  }
  mutable std::map<std::string, Wires> by_path;
};

Wires ladder_chip() {
  Wires wires;
  wires.label = "ladder-gpio";
  wires.lines = {{"", false, ""},         {"TOUCH_FL", false, ""}, {"TOUCH_FR", false, ""},
                 {"TOUCH_RL", false, ""}, {"TOUCH_RR", false, ""}, {"ESTOP_N", false, ""},
                 {"LED", true, "blinky"}, {"", false, ""}};
  return wires;
}

struct KernelLinesTest : testing::Test {
  KernelLinesTest() {
    chips.by_path["/dev/gpiochip0"] = {"soc", {{"LED", false, ""}}};
    chips.by_path["/dev/gpiochip1"] = ladder_chip();
  }
  Wires& ladder() { return chips.by_path["/dev/gpiochip1"]; }
  std::string open() { return KernelLines(params, chips).open(); }
  WiredChips chips;
  LinesParams params;
};

// No chip at all, only others, one that may not be opened: the message names what there is.
TEST_F(KernelLinesTest, NoChip) {
  params.chip = "robot";
  EXPECT_THAT(open(), AllOf(HasSubstr("no GPIO chip is labelled \"robot\""),
                            HasSubstr("\"soc\" (/dev/gpiochip0), \"ladder-gpio\" (/dev/gpiochip1)"),
                            HasSubstr("gpio.chip")));
  ladder().open_error = EACCES;
  EXPECT_THAT(open(), AllOf(HasSubstr("/dev/gpiochip1 cannot be opened: Permission denied"),
                            HasSubstr("add this user to the group")));
  chips.by_path.clear();
  EXPECT_THAT(open(), HasSubstr("there is no other"));
}

// Two chips with one label: neither is guessed.
TEST_F(KernelLinesTest, TwoChipsOfOneLabel) {
  chips.by_path["/dev/gpiochip4"] = ladder_chip();
  EXPECT_THAT(open(), AllOf(HasSubstr("two GPIO chips are labelled \"ladder-gpio\""),
                            HasSubstr("/dev/gpiochip1 and /dev/gpiochip4")));
}

// A name that the chip does not have, or has twice, or an offset beyond its end.
TEST_F(KernelLinesTest, LineNotFound) {
  params.estop.name = "STOP";
  EXPECT_THAT(open(), AllOf(HasSubstr("\"ladder-gpio\" (/dev/gpiochip1) has no line named STOP"),
                            HasSubstr("gpioinfo")));
  params.estop.name = "";
  params.estop.offset = 8;
  EXPECT_THAT(open(), HasSubstr("has 8 lines, none at offset 8"));
  params = {};
  ladder().lines[7].name = "TOUCH_RL";
  EXPECT_THAT(open(), HasSubstr("two lines named TOUCH_RL, at offsets 3 and 7"));
  params.touch[2] = {"", 3};
  EXPECT_EQ(open(), "") << "as the message says, the offset helps";
}

// One wire cannot be two switches, once by name and once by offset.
TEST_F(KernelLinesTest, OneWireTwice) {
  params.touch[0] = {"", 5};
  EXPECT_THAT(open(),
              HasSubstr("line 5 of GPIO chip \"ladder-gpio\" (/dev/gpiochip1) is configured "
                        "twice"));
}

// A line that another program holds: which, where, by whom, and what to do.
TEST_F(KernelLinesTest, BusyLine) {
  ladder().lines[5] = {"ESTOP_N", true, "gpiomon"};
  EXPECT_THAT(open(), AllOf(HasSubstr("line ESTOP_N at offset 5 of GPIO chip \"ladder-gpio\" "
                                      "(/dev/gpiochip1) is held by \"gpiomon\""),
                            HasSubstr("end that program")));
}

// A chip without interrupts serves without waking; one that refuses both ways is told.
TEST_F(KernelLinesTest, WithoutEdges) {
  ladder().edge_error = ENXIO;
  KernelLines lines(params, chips);
  EXPECT_EQ(lines.open(), "");
  EXPECT_EQ(lines.wake_fd(), -1);
  ladder().plain_error = EPERM;
  EXPECT_THAT(open(), HasSubstr("does not give its lines as inputs: Operation not permitted"));
}

// Each line is read where its name stands, with its own bias; all permutations of the names.
TEST_F(KernelLinesTest, ReadsByName) {
  params.touch[1].bias = Bias::kAsIs;
  std::vector<std::string> names = {"ESTOP_N", "TOUCH_FL", "TOUCH_FR", "TOUCH_RL", "TOUCH_RR"};
  do {
    for (std::size_t i = 0; i < names.size(); ++i) ladder().lines[i + 1].name = names[i];
    KernelLines lines(params, chips);
    ASSERT_EQ(lines.open(), "");
    EXPECT_EQ(lines.wake_fd(), 9);
    EXPECT_EQ(ladder().requested[1].bias, Bias::kAsIs);
    EXPECT_EQ(ladder().requested[4].bias, Bias::kPullDown);
    for (int high = 0; high < kNumLines; ++high) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        ladder().levels[i + 1] = names[i] == params.line(high).name;
      }
      Levels expected{};
      expected[high] = true;
      Levels levels{};
      EXPECT_EQ(lines.read(levels), ReadStatus::kDone);
      EXPECT_EQ(levels, expected);
    }
  } while (std::next_permutation(names.begin(), names.end()));
}

// A chip that goes and comes back under another number is found by its label.
TEST_F(KernelLinesTest, ComesBackUnderAnotherNumber) {
  KernelLines lines(params, chips);
  Levels levels{};
  EXPECT_EQ(lines.read(levels), ReadStatus::kLost) << "never opened";
  ASSERT_EQ(lines.open(), "");
  ladder().is_gone = true;
  EXPECT_EQ(lines.read(levels), ReadStatus::kLost);
  EXPECT_EQ(lines.read(levels), ReadStatus::kLost) << "and stays so until it is opened";
  EXPECT_EQ(lines.wake_fd(), -1);
  EXPECT_EQ(lines.loss(), "GPIO chip \"ladder-gpio\" (/dev/gpiochip1) has gone");
  chips.by_path.erase("/dev/gpiochip1");
  EXPECT_NE(lines.open(), "");
  chips.by_path["/dev/gpiochip7"] = ladder_chip();
  EXPECT_EQ(lines.open(), "");
  EXPECT_EQ(lines.read(levels), ReadStatus::kDone);
}

}  // namespace
}  // namespace gpio
