// SPDX-License-Identifier: BSD-3-Clause
// The talk with an A010 over a pseudo terminal: start, images, garbage, silence, unplugging.
#include "sources/a010_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "fake_a010.h"
#include "recording_sink.h"

namespace sources {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class A010 : public ::testing::Test {
 protected:
  A010() {
    params_.kind = Kind::kA010;
    params_.a010.binning = 4;
    for (HeadParams& head : params_.heads) head.intrinsics = {18.0, 18.0, 12.0, 12.0};
  }
  ~A010() override { unlink(link_.c_str()); }

  void start(const std::string& device) {
    params_.heads[0].device = device;
    source_ = std::make_unique<A010Source>(params_, ready_);
  }
  /// Steps of 10 ms on both sides of the line.
  void run(std::int64_t duration_us, FakeA010* unit = nullptr) {
    for (const std::int64_t end = clock_.monotonic_us + duration_us; clock_.monotonic_us < end;) {
      clock_.monotonic_us += 10'000;
      source_->poll(clock_.now(), sink_);
      if (unit != nullptr) unit->work();
    }
  }

  const std::string link_ = "/tmp/ladder-a010-" + std::to_string(getpid());
  SourceParams params_;
  ReadySet ready_;
  TestClock clock_;
  RecordingSink sink_;
  std::unique_ptr<A010Source> source_;
};

// The unit is silenced, asked, set up and let go, in this order and once each.
TEST_F(A010, Talk) {
  FakeA010 unit;
  params_.a010 = {.binning = 2, .unit_mm = 3, .over_usb = false};
  params_.camera.frames_per_s = 12;
  start(unit.path());
  run(1'000'000, &unit);
  EXPECT_THAT(unit.commands(), ElementsAre("AT+DISP=1", "AT", "AT+BINN=2", "AT+UNIT=3", "AT+FPS=12",
                                           "AT+ISP=1", "AT+DISP=4"));
  EXPECT_THAT(sink_.reports, IsEmpty());
  EXPECT_TRUE(unit.is_sending());
}

// Images become frames: size, millimetres, time of the first byte, seq from the unit's number.
TEST_F(A010, Images) {
  FakeA010 unit;
  unit.number = 4094;
  start(unit.path());
  run(500'000, &unit);
  const std::vector<std::uint8_t> packet =
      a010_packet(std::vector<std::uint8_t>(625, 102), 25, unit.number++);
  unit.send({packet.begin(), packet.begin() + 300});
  run(10'000);
  const std::int64_t begun_utime_us = clock_.utime_us();
  unit.send({packet.begin() + 300, packet.end()});
  run(30'000);
  ASSERT_EQ(sink_.frames.size(), 1U);
  const tof::DepthFrame& frame = sink_.frames[0].frame;
  EXPECT_EQ(frame.width_px, 25);
  EXPECT_EQ(frame.height_px, 25);
  EXPECT_EQ(frame.seq, 0);
  EXPECT_EQ(frame.utime_us, begun_utime_us);
  EXPECT_EQ(sink_.frames[0].depth_mm.size(), 625U);
  EXPECT_THAT(sink_.frames[0].depth_mm, Each(400));  // (102 / 5.1)^2
  EXPECT_THAT(sink_.reports,
              ElementsAre("+ head 0 (" + unit.path() + ") delivers, sensor at 41, driver at 43"));
  unit.send_image(51);  // number 4095
  run(20'000);
  unit.number = 2;  // 0 and 1 are lost
  unit.send_image(51);
  run(20'000);
  ASSERT_EQ(sink_.frames.size(), 3U);
  EXPECT_EQ(sink_.frames[1].frame.seq, 1);
  EXPECT_EQ(sink_.frames[2].frame.seq, 4);
  EXPECT_THAT(sink_.frames[2].depth_mm, Each(100));
}

// Of several images in one step the newest counts; the others show as lost.
TEST_F(A010, LateStepTakesTheNewest) {
  FakeA010 unit;
  start(unit.path());
  run(500'000, &unit);
  unit.send_image(51);
  run(10'000);
  unit.send_image(61);
  unit.send_image(71);
  run(10'000);
  ASSERT_EQ(sink_.frames.size(), 2U);
  EXPECT_EQ(sink_.frames[1].frame.seq, 2);
  EXPECT_THAT(sink_.frames[1].depth_mm, Each(194));
}

// A unit that is in full flow when the service starts is set up all the same; images of the old
// size are not taken for ours.
TEST_F(A010, AlreadySending) {
  FakeA010 unit;
  start(unit.path());
  run(10'000);
  const std::vector<std::uint8_t> old_image =
      a010_packet(std::vector<std::uint8_t>(2500, 9), 50, 7);
  for (int i = 0; i < 100; ++i) {
    if (i < 60) unit.send(old_image);
    run(10'000, &unit);
  }
  EXPECT_THAT(sink_.frames, IsEmpty());
  EXPECT_TRUE(unit.is_sending());
  unit.send(old_image);
  unit.send_image(51);
  run(20'000);
  EXPECT_EQ(sink_.frames.size(), 1U);
}

// Garbage and damaged packets on the line cost no good image.
TEST_F(A010, GarbageOnTheLine) {
  FakeA010 unit;
  start(unit.path());
  run(500'000, &unit);
  std::vector<std::uint8_t> damaged = a010_packet(std::vector<std::uint8_t>(625, 33), 25, 5);
  damaged[100] ^= 1;
  for (int i = 0; i < 20; ++i) {
    unit.send_text(std::string("\x00\xFF noise \x00\xFF\x81\x02", 13));
    unit.send(damaged);
    unit.send_image(51);
    run(20'000);
  }
  EXPECT_EQ(sink_.frames.size(), 20U);
  for (const auto& frame : sink_.frames) EXPECT_THAT(frame.depth_mm, Each(100));
}

// Nobody answers: said once with the command, tried on.
TEST_F(A010, NobodyThere) {
  FakeA010 unit;
  unit.is_mute = true;
  start(unit.path());
  run(20'000'000, &unit);
  ASSERT_EQ(sink_.reports.size(), 1U);
  EXPECT_THAT(sink_.reports[0],
              HasSubstr("does not answer AT: no MaixSense A010, or another speed"));
  unit.is_mute = false;
  run(5'000'000, &unit);
  EXPECT_TRUE(unit.is_sending());
}

// A path that is no serial line, or not there, is refused in words.
TEST_F(A010, NoLine) {
  start("/dev/null");
  params_.heads[1].device = "/no/such/line";
  source_ = std::make_unique<A010Source>(params_, ready_);
  run(5'000'000);
  EXPECT_THAT(sink_.reports,
              ElementsAre("- head 0 (/dev/null) is no serial line",
                          "- head 1 (/no/such/line) cannot be opened: No such file or directory"));
}

// A unit that falls silent is set up anew, images or no images before.
TEST_F(A010, FallsSilent) {
  FakeA010 unit;
  params_.a010.silence_s = 2.0;
  start(unit.path());
  run(1'000'000, &unit);
  unit.send_image(51);
  run(2'500'000, &unit);
  EXPECT_THAT(sink_.last_report(), HasSubstr("has sent no image for 2 s"));
  EXPECT_EQ(std::count(unit.commands().begin(), unit.commands().end(), "AT+DISP=2"), 2);
  unit.send_image(51);
  run(20'000);
  EXPECT_EQ(sink_.frames.size(), 2U);
  EXPECT_EQ(sink_.frames[1].frame.seq, 1);
}

// Pulled out and plugged in again, where the line has another number behind the same link.
TEST_F(A010, UnpluggedAndBack) {
  auto unit = std::make_unique<FakeA010>(link_);
  start(link_);
  run(1'000'000, unit.get());
  unit->send_image(51);
  run(20'000);
  const FakeA010 other;  // takes the next number
  unit.reset();
  run(3'000'000);
  ASSERT_GE(sink_.reports.size(), 2U);
  EXPECT_THAT(sink_.reports[1], HasSubstr("is gone"));
  unit = std::make_unique<FakeA010>(link_);
  run(4'000'000, unit.get());
  unit->send_image(51);
  run(20'000);
  ASSERT_EQ(sink_.frames.size(), 2U);
  EXPECT_EQ(sink_.frames[1].frame.seq, 1);
  EXPECT_THAT(sink_.last_report(), HasSubstr("delivers"));
}

}  // namespace
}  // namespace sources
