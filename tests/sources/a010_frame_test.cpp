// SPDX-License-Identifier: BSD-3-Clause
// The byte stream of an A010: packets found whole or in pieces, among garbage and damaged ones.
#include "sources/a010_frame.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/rng.h"
#include "fake_a010.h"

namespace sources {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Bytes = std::vector<std::uint8_t>;

/// Pixels that hold everything a packet begins and ends with.
Bytes tricky_counts(int side) {
  Bytes counts(static_cast<std::size_t>(side * side));
  constexpr std::array<std::uint8_t, 7> kPattern{0x00, 0xFF, 0x81, 0x02, 0x00, 0xFF, 0xDD};
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = kPattern[i % kPattern.size()];
  return counts;
}

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Numbers of the images that come out when the stream arrives in pieces of this size.
std::vector<int> numbers_in(A010Parser& parser, const Bytes& stream, std::size_t piece) {
  std::vector<int> numbers;
  for (std::size_t at = 0; at < stream.size();) {
    const std::span<std::uint8_t> room = parser.room();
    const std::size_t size = std::min({piece, room.size(), stream.size() - at});
    std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(at), size, room.begin());
    parser.fill(size);
    at += size;
    A010Frame frame;
    while (parser.next(frame)) numbers.push_back(frame.number);
  }
  return numbers;
}

// One packet, written out: every field is where Sipeed's page puts it.
TEST(A010Frame, ByteForByte) {
  Bytes packet{0x00, 0xFF, 0x81, 0x02, 0xFF, 0x00, 0x29, 0x2B, 0xE8, 0x03,
               0x00, 0x00, 0x00, 0x00, 0x19, 0x19, 0x34, 0x02, 0x01, 0xFF};
  for (int i = 0; i < 625; ++i) packet.push_back(static_cast<std::uint8_t>(i % 7 + 100));
  packet.push_back(0x9A);
  packet.push_back(0xDD);
  ASSERT_EQ(packet.size(), 647U);
  A010Parser parser;
  std::copy(packet.begin(), packet.end(), parser.room().begin());
  parser.fill(packet.size());
  A010Frame frame;
  ASSERT_TRUE(parser.next(frame));
  EXPECT_EQ(frame.width_px, 25);
  EXPECT_EQ(frame.height_px, 25);
  EXPECT_EQ(frame.number, 0x234);
  EXPECT_EQ(frame.sensor_temperature, 41);
  EXPECT_EQ(frame.driver_temperature, 43);
  ASSERT_EQ(frame.counts.size(), 625U);
  for (int i = 0; i < 625; ++i) EXPECT_EQ(frame.counts[i], i % 7 + 100);
  EXPECT_FALSE(parser.next(frame));
  EXPECT_FALSE(parser.has_begun());
}

// Every size of image, in pieces of every size, with pixels that look like packets.
TEST(A010Frame, InPieces) {
  for (const int side : {25, 50, 100}) {
    Bytes stream;
    for (int number = 0; number < 3; ++number)
      stream = stream + a010_packet(tricky_counts(side), side, number);
    for (const std::size_t piece : {1U, 2U, 19U, 20U, 21U, 647U, 4096U, 60'000U}) {
      A010Parser parser;
      EXPECT_THAT(numbers_in(parser, stream, piece), ElementsAre(0, 1, 2)) << side << " " << piece;
      EXPECT_EQ(parser.num_damaged() + parser.num_skipped(), 0);
    }
  }
}

// Garbage of any kind before, between and behind costs no image.
TEST(A010Frame, AmongGarbage) {
  base::Rng rng(7);
  for (int round = 0; round < 200; ++round) {
    Bytes stream;
    for (int number = 0; number < 4; ++number) {
      Bytes garbage(rng.below(300));
      for (std::uint8_t& byte : garbage)
        byte = rng.below(3) == 0 ? (rng.below(2) == 0 ? 0x00 : 0xFF)
                                 : static_cast<std::uint8_t>(rng.below(256));
      stream = stream + garbage + a010_packet(tricky_counts(25), 25, number);
    }
    A010Parser parser;
    EXPECT_THAT(numbers_in(parser, stream, 1 + rng.below(700)), ElementsAre(0, 1, 2, 3));
  }
}

// One wrong byte anywhere costs that image alone; the next one is found even when the damage made
// a packet look longer.
TEST(A010Frame, OneWrongByte) {
  const Bytes good = a010_packet(tricky_counts(25), 25, 1);
  const Bytes next = a010_packet(tricky_counts(25), 25, 2);
  for (std::size_t at = 0; at < good.size(); ++at) {
    Bytes bad = good;
    bad[at] ^= 0x10;
    A010Parser parser;
    EXPECT_THAT(numbers_in(parser, bad + next, 256), ElementsAre(2)) << "byte " << at;
    EXPECT_GT(parser.num_skipped(), 0);
  }
}

// A packet that breaks off costs itself alone.
TEST(A010Frame, BrokenOff) {
  const Bytes first = a010_packet(Bytes(10'000, 80), 100, 1);
  for (const std::size_t kept : {1U, 3U, 20U, 21U, 5000U, 10'021U}) {
    const Bytes stream = Bytes(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(kept)) +
                         a010_packet(Bytes(10'000, 90), 100, 2) +
                         a010_packet(Bytes(10'000, 90), 100, 3);
    A010Parser parser;
    EXPECT_THAT(numbers_in(parser, stream, 777), ElementsAre(2, 3)) << kept;
  }
}

// A million random bytes: no image, no bound broken.
TEST(A010Frame, NoiseOnly) {
  base::Rng rng(11);
  Bytes noise(1'000'000);
  for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(rng.below(256));
  A010Parser parser;
  EXPECT_THAT(numbers_in(parser, noise, 3000), IsEmpty());
}

// The unit's quantisation: p x unit, or (p / 5.1)^2; the ends mean nothing measured.
TEST(A010Frame, Millimetres) {
  for (int count = 1; count < 255; ++count) {
    const auto byte = static_cast<std::uint8_t>(count);
    const double exact_mm = std::pow(count / 5.1, 2.0);
    EXPECT_NEAR(a010_depth_mm(byte, 0), exact_mm, 0.5 + 1e-9) << count;
    for (int unit_mm = 1; unit_mm <= 10; ++unit_mm)
      EXPECT_EQ(a010_depth_mm(byte, unit_mm), count * unit_mm);
  }
  for (const int unit_mm : {0, 1, 10}) {
    EXPECT_EQ(a010_depth_mm(0, unit_mm), 0);
    EXPECT_EQ(a010_depth_mm(255, unit_mm), 0);
  }
}

}  // namespace
}  // namespace sources
