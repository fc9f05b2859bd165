// SPDX-License-Identifier: BSD-3-Clause
#include "gpio/line_params.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpio {
namespace {

using testing::HasSubstr;

LinesParams with(void (*change)(LinesParams&)) {
  LinesParams params;
  change(params);
  return params;
}

// The built-in wiring is a good one.
TEST(LineParams, DefaultsPass) {
  EXPECT_EQ(check(LinesParams{}), "");
}

// Wiring on which a broken wire reads as "run" or as a grasp is refused, and the message says how
// to do it; both fail-safe wirings of the E-stop pass.
TEST(LineParams, ABrokenWireMustBeSafe) {
  EXPECT_THAT(check(with([](LinesParams& p) { p.estop.active_low = false; })),
              HasSubstr("estop: a broken wire would read as run"));
  EXPECT_THAT(check(with([](LinesParams& p) { p.estop.bias = Bias::kPullUp; })),
              HasSubstr("estop: a broken wire would read as run"));
  EXPECT_EQ(check(with([](LinesParams& p) {
              p.estop.active_low = false;
              p.estop.bias = Bias::kPullUp;
            })),
            "");
  EXPECT_THAT(check(with([](LinesParams& p) { p.touch[2].bias = Bias::kPullUp; })),
              HasSubstr("touch_rl: a broken wire would read as a grasp"));
  EXPECT_EQ(check(with([](LinesParams& p) {
              p.touch[2].bias = Bias::kPullUp;
              p.touch[2].active_low = true;
            })),
            "");
}

// Where the chip leaves the wire alone, its resistor is outside and cannot be judged here.
TEST(LineParams, ForeignResistorsPass) {
  for (const Bias bias : {Bias::kAsIs, Bias::kDisabled}) {
    LinesParams params;
    params.estop.bias = bias;
    EXPECT_EQ(check(params), "");
  }
}

// Each field that makes no sense is named.
TEST(LineParams, NamesTheField) {
  EXPECT_THAT(check(with([](LinesParams& p) { p.chip = ""; })), HasSubstr("chip"));
  EXPECT_THAT(check(with([](LinesParams& p) { p.chip = "unix:"; })), HasSubstr("unix:PATH"));
  EXPECT_THAT(check(with([](LinesParams& p) { p.chip = "unix:" + std::string(108, 'x'); })),
              HasSubstr("unix:PATH"));
  EXPECT_THAT(check(with([](LinesParams& p) { p.touch[0].name = ""; })), HasSubstr("touch_fl"));
  EXPECT_THAT(check(with([](LinesParams& p) { p.touch[1].offset = 3; })), HasSubstr("touch_fr"));
  EXPECT_THAT(check(with([](LinesParams& p) { p.touch[3].name = "TOUCH_FL"; })),
              HasSubstr("touch_fl and touch_rr are the same line"));
  EXPECT_THAT(check(with([](LinesParams& p) { p.estop.debounce_us = -1; })),
              HasSubstr("estop_debounce_us"));
  EXPECT_THAT(check(with([](LinesParams& p) { p.estop.debounce_us = 10'001; })),
              HasSubstr("estop_debounce_us"));
  EXPECT_THAT(check(with([](LinesParams& p) { p.first_reopen_us = 0; })),
              HasSubstr("first_reopen_us"));
  EXPECT_THAT(check(with([](LinesParams& p) { p.longest_reopen_us = 1; })),
              HasSubstr("longest_reopen_us"));
}

// Two lines by offset are the same line only at the same offset.
TEST(LineParams, Offsets) {
  LinesParams params;
  params.touch[0] = {"", 0};
  params.touch[1] = {"", 1};
  EXPECT_EQ(check(params), "");
  params.touch[1].offset = 0;
  EXPECT_THAT(check(params), HasSubstr("touch_fl and touch_fr"));
}

}  // namespace
}  // namespace gpio
