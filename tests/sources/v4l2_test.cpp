// SPDX-License-Identifier: BSD-3-Clause
// Z16 cameras behind recorded answers: agreement on a format, pixels, time, numbers, unplugging.
#include <cerrno>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recorded_cameras.h"
#include "recording_sink.h"
#include "sources/depth_counts.h"
#include "sources/v4l2_source.h"

namespace sources {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kNumPixels = 8 * 6;

std::vector<std::uint16_t> ramp(std::uint16_t first) {
  std::vector<std::uint16_t> counts(kNumPixels);
  std::iota(counts.begin(), counts.end(), first);
  return counts;
}

// Rows are found through the padding behind them; counts become rounded millimetres; 0, the mask
// value and what does not fit are no return.
TEST(DepthCounts, Convert) {
  const std::vector<std::uint8_t> bytes{0xE8, 0x03, 0x00, 0x00, 9, 9,   // 1000, 0, padding
                                        0xFF, 0xFF, 0xFE, 0xFF, 9, 9};  // 65535, 65534
  std::vector<std::int16_t> depth_mm(4, -1);
  const CountImage image{.bytes = bytes, .width_px = 2, .height_px = 2, .stride_bytes = 6};
  EXPECT_TRUE(to_depth_mm(image, {.unit_um = 250, .no_return = 65535}, depth_mm));
  EXPECT_THAT(depth_mm, ElementsAre(250, 0, 0, 16384));
  EXPECT_TRUE(to_depth_mm(image, {.unit_um = 1000, .no_return = 1000}, depth_mm));
  EXPECT_THAT(depth_mm, ElementsAre(0, 0, 0, 0));
}

// Every count times every plausible unit is what real arithmetic says, to half a millimetre.
TEST(DepthCounts, AllCounts) {
  std::vector<std::uint8_t> bytes(2 * 1024 * 64);
  for (std::size_t i = 0; i < bytes.size() / 2; ++i) {
    bytes[2 * i] = static_cast<std::uint8_t>(i & 0xFF);
    bytes[2 * i + 1] = static_cast<std::uint8_t>(i >> 8);
  }
  std::vector<std::int16_t> depth_mm(1024 * 64);
  const CountImage image{
      .bytes = bytes, .width_px = 1024, .height_px = 64, .stride_bytes = 2 * 1024};
  for (const int unit_um : {1, 100, 125, 250, 1000, 100'000}) {
    ASSERT_TRUE(to_depth_mm(image, {.unit_um = unit_um}, depth_mm));
    for (std::size_t count = 0; count < depth_mm.size(); ++count) {
      const double exact_mm = static_cast<double>(count) * unit_um / 1000.0;
      if (exact_mm < 32'767.4) {
        ASSERT_NEAR(depth_mm[count], exact_mm, 0.5) << count << " x " << unit_um;
      } else if (exact_mm >= 32'767.5) {
        ASSERT_EQ(depth_mm[count], 0) << count << " x " << unit_um;
      }
    }
  }
}

// An image that is too short or does not fit changes nothing.
TEST(DepthCounts, MisfitsAreRefused) {
  const std::vector<std::uint8_t> bytes(12, 1);
  std::vector<std::int16_t> depth_mm(4, -1);
  const CountImage good{.bytes = bytes, .width_px = 2, .height_px = 2, .stride_bytes = 6};
  CountImage bad = good;
  bad.bytes = std::span(bytes).first(9);  // the last row needs no padding: 10 would do
  EXPECT_FALSE(to_depth_mm(bad, {}, depth_mm));
  bad = good;
  bad.stride_bytes = 3;
  EXPECT_FALSE(to_depth_mm(bad, {}, depth_mm));
  bad = good;
  bad.height_px = 0;
  EXPECT_FALSE(to_depth_mm(bad, {}, depth_mm));
  EXPECT_FALSE(to_depth_mm(good, {}, std::span(depth_mm).first(3)));
  EXPECT_THAT(depth_mm, ElementsAre(-1, -1, -1, -1));
}

class V4l2 : public ::testing::Test {
 protected:
  V4l2() {
    params_.kind = Kind::kV4l2;
    params_.v4l2.width_px = 8;
    params_.v4l2.height_px = 6;
    params_.heads[0].device = "/dev/video2";
    for (HeadParams& head : params_.heads) head.intrinsics = {8.0, 8.0, 3.5, 2.5};
  }

  void start() { source_ = std::make_unique<V4l2Source>(params_, ready_, cameras_); }
  void poll() {
    if (!source_) start();
    source_->poll(clock_.now(), sink_);
  }
  /// Lets time pass in steps of the work loop.
  void wait(std::int64_t duration_us) {
    for (const std::int64_t end = clock_.monotonic_us + duration_us; clock_.monotonic_us < end;) {
      clock_.monotonic_us += 50'000;
      poll();
    }
  }
  /// A frame that the driver stamped just now.
  void deliver(RecordedCamera& camera, std::uint32_t sequence, std::uint16_t first = 1000) {
    camera.waiting.push_back(
        {.counts = ramp(first), .monotonic_us = clock_.monotonic_us - 3'000, .sequence = sequence});
  }

  RecordedCameras cameras_;
  RecordedCamera& camera_ = cameras_.at("/dev/video2");
  SourceParams params_;
  ReadySet ready_;
  TestClock clock_;
  RecordingSink sink_;
  std::unique_ptr<V4l2Source> source_;
};

// The calls from opening to the first frame, in the order that the kernel's documentation asks for.
TEST_F(V4l2, CallsOfAStart) {
  poll();
  deliver(camera_, 0);
  poll();
  EXPECT_THAT(camera_.calls, ElementsAre("QUERYCAP", "S_FMT", "S_PARM", "REQBUFS", "QUERYBUF",
                                         "QBUF", "QUERYBUF", "QBUF", "QUERYBUF", "QBUF", "QUERYBUF",
                                         "QBUF", "STREAMON", "DQBUF", "DQBUF", "QBUF", "DQBUF"));
  ASSERT_EQ(sink_.frames.size(), 1U);
  EXPECT_THAT(sink_.reports, ElementsAre("+ head 0 (/dev/video2) delivers"));
}

// Pixels, size, time and all that configuration says of the head arrive in the frame.
TEST_F(V4l2, FrameIsComplete) {
  params_.camera = {.depth_kind = tof::DepthKind::kRadial,
                    .range_min_m = 0.2,
                    .range_max_m = 3.0,
                    .wrap_range_m = 5.0};
  params_.heads[0].T_body_head.p_m = {0.1, 0.2, 0.3};
  camera_.padding_bytes = 16;
  poll();
  deliver(camera_, 0, 500);
  poll();
  ASSERT_EQ(sink_.frames.size(), 1U);
  const tof::DepthFrame& frame = sink_.frames[0].frame;
  EXPECT_EQ(frame.utime_us, clock_.utime_us() - 3'000);
  EXPECT_EQ(frame.seq, 0);
  EXPECT_EQ(frame.head, 0);
  EXPECT_EQ(frame.depth_kind, tof::DepthKind::kRadial);
  EXPECT_EQ(frame.width_px, 8);
  EXPECT_EQ(frame.height_px, 6);
  EXPECT_EQ(frame.intrinsics, (tof::Intrinsics{8.0, 8.0, 3.5, 2.5}));
  EXPECT_EQ(frame.range_min_m, 0.2);
  EXPECT_EQ(frame.range_max_m, 3.0);
  EXPECT_EQ(frame.wrap_range_m, 5.0);
  EXPECT_EQ(frame.T_body_head.p_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  for (std::size_t i = 0; i < kNumPixels; ++i)
    EXPECT_EQ(sink_.frames[0].depth_mm[i], 500 + static_cast<int>(i));
}

// A driver that has another size or format is refused with the list of what it has, once, and is
// asked again in case it changes.
TEST_F(V4l2, RefusalNamesWhatIsOffered) {
  camera_.formats = {{V4L2_PIX_FMT_Z16, {{480, 270}, {848, 480}}},
                     {V4L2_PIX_FMT_YUYV, {{640, 480}}}};
  wait(3'000'000);
  ASSERT_EQ(sink_.reports.size(), 1U);
  EXPECT_EQ(sink_.reports[0],
            "- head 0 (/dev/video2) does not deliver Z16 8x6: Depth Camera 435 offers Z16 480x270 "
            "848x480, YUYV 640x480");
  EXPECT_EQ(cameras_.num_open(), 0);
  camera_.formats[0].sizes.push_back({8, 6});
  wait(2'000'000);
  deliver(camera_, 0);
  poll();
  EXPECT_EQ(sink_.frames.size(), 1U);
}

// A node that is no capture device, and every call that may fail at the start: refused with the
// reason, nothing left open or mapped.
TEST_F(V4l2, EveryFailureAtTheStart) {
  camera_.capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  poll();
  EXPECT_THAT(sink_.last_report(), HasSubstr("captures no video"));
  camera_.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  camera_.num_buffers = 1;
  wait(200'000);
  EXPECT_THAT(sink_.last_report(), HasSubstr("fewer than two buffers"));
  camera_.num_buffers = 4;
  for (const auto& [request, text] : std::map<unsigned long, std::string>{
           {VIDIOC_QUERYCAP, "is no video device"},
           {VIDIOC_S_FMT, "is used by somebody else"},
           {VIDIOC_REQBUFS, "gives no buffers: Device or resource busy"},
           {VIDIOC_QUERYBUF, "cannot be mapped"},
           {VIDIOC_QBUF, "cannot be mapped"},
           {VIDIOC_STREAMON, "does not stream: Device or resource busy"}}) {
    camera_.failures = {{request, EBUSY}};
    wait(2'500'000);
    EXPECT_THAT(sink_.last_report(), HasSubstr(text));
    EXPECT_EQ(cameras_.num_open(), 0);
    EXPECT_EQ(cameras_.num_mapped(), 0);
  }
  EXPECT_THAT(sink_.frames, IsEmpty());
}

// Drivers that do not let one choose the rate serve all the same.
TEST_F(V4l2, RateIsAWishOnly) {
  camera_.failures = {{VIDIOC_S_PARM, ENOTTY}};
  poll();
  deliver(camera_, 0);
  poll();
  EXPECT_EQ(sink_.frames.size(), 1U);
}

// Unplugged while it streams: said once, nothing leaks; plugged in again it delivers, its numbers
// go on rising by one although the device's begin anew.
TEST_F(V4l2, UnpluggedAndBack) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    poll();
    deliver(camera_, i);
    wait(50'000);
  }
  camera_.is_plugged_in = false;
  wait(5'000'000);
  EXPECT_EQ(sink_.reports.size(), 3U);  // delivers, gone, cannot be opened
  EXPECT_THAT(sink_.reports[1], HasSubstr("gives no frame: No such device"));
  EXPECT_THAT(sink_.reports[2], HasSubstr("cannot be opened: No such file or directory"));
  EXPECT_EQ(cameras_.num_open(), 0);
  EXPECT_EQ(cameras_.num_mapped(), 0);
  camera_.is_plugged_in = true;
  wait(2'000'000);
  deliver(camera_, 0);
  poll();
  ASSERT_EQ(sink_.frames.size(), 4U);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(sink_.frames[i].frame.seq, i);
  EXPECT_THAT(sink_.last_report(), HasSubstr("delivers"));
}

// A queue in error (POLLERR) and an error of DQBUF count as unplugged.
TEST_F(V4l2, ErrorsOfARunningDevice) {
  poll();
  camera_.is_broken = true;
  poll();
  EXPECT_THAT(sink_.last_report(), HasSubstr("POLLERR"));
  camera_.is_broken = false;
  wait(200'000);
  camera_.failures = {{VIDIOC_DQBUF, EIO}};
  poll();
  EXPECT_THAT(sink_.last_report(), HasSubstr("gives no frame: Input/output error"));
  EXPECT_EQ(cameras_.num_mapped(), 0);
}

// By its name a camera is found under any number, past nodes of the same camera that carry other
// data; by its bus the one of two equal cameras.
TEST_F(V4l2, FoundByNameAndByBus) {
  RecordedCamera& metadata = cameras_.at("/dev/video0");
  metadata.capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  RecordedCamera& colour = cameras_.at("/dev/video1");
  colour.formats = {{V4L2_PIX_FMT_YUYV, {{640, 480}}}};
  RecordedCamera& second = cameras_.at("/dev/video7");
  second.bus = "usb-0000:00:14.0-3";
  params_.heads[0].device = "name:Depth Camera 435";
  params_.heads[1].device = "bus:usb-0000:00:14.0-3";
  poll();
  EXPECT_TRUE(camera_.is_streaming);
  EXPECT_TRUE(second.is_streaming);
  EXPECT_EQ(cameras_.num_open(), 2);

  second.is_plugged_in = false;
  wait(100'000);
  cameras_.move("/dev/video7", "/dev/video3");
  cameras_.at("/dev/video3").is_plugged_in = true;
  wait(2'000'000);
  deliver(cameras_.at("/dev/video3"), 0);
  poll();
  ASSERT_EQ(sink_.frames.size(), 1U);
  EXPECT_EQ(sink_.frames[0].frame.head, 1);
}

// A name that no camera has: said once.
TEST_F(V4l2, NoSuchName) {
  params_.heads[0].device = "name:Somebody else's";
  wait(5'000'000);
  EXPECT_THAT(sink_.reports,
              ElementsAre("- head 0 (name:Somebody else's) cannot be opened: No such "
                          "device"));
  EXPECT_EQ(cameras_.num_open(), 0);
}

// Lost frames show as a gap in seq; a device whose number stands still counts on by one.
TEST_F(V4l2, SequenceNumbers) {
  poll();
  for (const std::uint32_t sequence : {5U, 6U, 9U, 9U, 0U, 1U}) {
    deliver(camera_, sequence);
    poll();
  }
  std::vector<std::int64_t> seqs;
  for (const auto& frame : sink_.frames) seqs.push_back(frame.frame.seq);
  EXPECT_THAT(seqs, ElementsAre(0, 1, 4, 5, 6, 7));
}

// Several frames wait: the newest counts, the older ones show as lost, all buffers go back.
TEST_F(V4l2, LateStepTakesTheNewest) {
  poll();
  deliver(camera_, 0);
  poll();
  for (std::uint32_t i = 1; i <= 3; ++i) deliver(camera_, i, static_cast<std::uint16_t>(100 * i));
  poll();
  ASSERT_EQ(sink_.frames.size(), 2U);
  EXPECT_EQ(sink_.frames[1].frame.seq, 3);
  EXPECT_EQ(sink_.frames[1].depth_mm[0], 300);
  EXPECT_EQ(camera_.queued.size(), 4U);
}

// Frames that the driver marks as damaged, or that broke off, are passed over and cost no buffer.
TEST_F(V4l2, DamagedFrames) {
  poll();
  camera_.waiting.push_back({.counts = ramp(1), .flags = V4L2_BUF_FLAG_ERROR});
  camera_.waiting.push_back({.counts = ramp(1), .missing_bytes = 2});
  poll();
  EXPECT_THAT(sink_.frames, IsEmpty());
  EXPECT_EQ(camera_.queued.size(), 4U);
}

// A driver with another clock, or a stamp from another time: the time of arrival serves.
TEST_F(V4l2, OtherClocks) {
  poll();
  camera_.waiting.push_back({.counts = ramp(1), .monotonic_us = clock_.monotonic_us, .flags = 0});
  poll();
  camera_.waiting.push_back({.counts = ramp(1), .monotonic_us = 7, .sequence = 1});
  wait(50'000);
  ASSERT_EQ(sink_.frames.size(), 2U);
  EXPECT_EQ(sink_.frames[0].frame.utime_us, clock_.utime_us() - 50'000);
  EXPECT_EQ(sink_.frames[1].frame.utime_us, clock_.utime_us());
}

// A camera that streams but sends nothing is opened anew after three seconds, and said once.
TEST_F(V4l2, SilentCamera) {
  wait(10'000'000);
  EXPECT_THAT(sink_.reports, ElementsAre("- head 0 (/dev/video2) has sent nothing for 3 s"));
  deliver(camera_, 0);
  wait(3'000'000);
  EXPECT_EQ(sink_.frames.size(), 1U);
}

// Four heads in one step come in the order of their time.
TEST_F(V4l2, FourHeadsByTime) {
  const std::array<std::string, 4> paths{"/dev/video2", "/dev/video4", "/dev/video6",
                                         "/dev/video8"};
  for (int head = 0; head < 4; ++head) {
    cameras_.at(paths[head]);
    params_.heads[head].device = paths[head];
  }
  poll();
  const std::array<std::int64_t, 4> ages_us{10'000, 40'000, 20'000, 30'000};
  for (int head = 0; head < 4; ++head) {
    cameras_.at(paths[head])
        .waiting.push_back(
            {.counts = ramp(1), .monotonic_us = clock_.monotonic_us - ages_us[head]});
  }
  poll();
  std::vector<int> order;
  for (const auto& frame : sink_.frames) order.push_back(frame.frame.head);
  EXPECT_THAT(order, ElementsAre(1, 3, 2, 0));
}

}  // namespace
}  // namespace sources
