// SPDX-License-Identifier: BSD-3-Clause
// Frames of the CANopen wire contract: whole frames as hex, round trips, frames that are none.
#include <gtest/gtest.h>

#include "can/cia402.h"
#include "fake_line.h"
#include "random_messages.h"

namespace can::cia402 {
namespace {

// Each frame of the contract, byte for byte.
TEST(Cia402Codec, FramesAsHex) {
  EXPECT_EQ(hex(encode(Nmt{NmtCommand::kStart, 0})), "000#0100");
  EXPECT_EQ(hex(encode(Nmt{NmtCommand::kEnterPreOperational, 5})), "000#8005");
  EXPECT_EQ(hex(encode(Nmt{NmtCommand::kResetNode, 16})), "000#8110");
  EXPECT_EQ(hex(encode_sync()), "080#");
  EXPECT_EQ(hex(encode(Heartbeat{kMasterNode, NmtState::kOperational})), "77F#05");
  EXPECT_EQ(hex(encode(Heartbeat{1, NmtState::kBootUp})), "701#00");
  EXPECT_EQ(hex(encode(Rpdo1{1, 0x000F, -2, 1500})), "201#0F00FEFFFFFFDC05");
  EXPECT_EQ(hex(encode(Rpdo1{16, 0x000B, 0x12345678, std::nullopt})), "210#0B0078563412");
  EXPECT_EQ(hex(encode(Rpdo2{2, -1000, -3, 8})), "302#18FCFFFFFDFF0800");
  EXPECT_EQ(hex(encode(Tpdo1{1, 0x0627, 1000, -12})), "181#2706E8030000F4FF");
  EXPECT_EQ(hex(encode(Tpdo1{1, 0x0627, 1000, std::nullopt})), "181#2706E8030000");
  EXPECT_EQ(hex(encode(Tpdo2{3, 0x8611, 8, 0x00010203})), "283#11860803020100");
  EXPECT_EQ(hex(encode(GripperTpdo{0x21, 5, {100, -100}})), "1A1#050064009CFF");
  EXPECT_EQ(hex(encode(Emergency{4, 0x3120, 4, {1, 2, 3, 4, 5}})), "084#2031040102030405");
}

// Expedited SDO in all four sizes, and an abort.
TEST(Cia402Codec, SdoAsHex) {
  EXPECT_EQ(hex(encode(SdoRequest{1, {0x6060, 0}, true, 1, 8})), "601#2F60600008000000");
  EXPECT_EQ(hex(encode(SdoRequest{1, {0x6007, 0}, true, 2, 3})), "601#2B07600003000000");
  EXPECT_EQ(hex(encode(SdoRequest{1, {0x1234, 5}, true, 3, 0xABCDEF})), "601#27341205EFCDAB00");
  EXPECT_EQ(hex(encode(SdoRequest{1, {0x1016, 1}, true, 4, 0x007F0096})), "601#2316100196007F00");
  EXPECT_EQ(hex(encode(SdoRequest{2, {0x1000, 0}, false, 4, 0})), "602#4000100000000000");
  EXPECT_EQ(hex(encode(SdoRequest{1, {0x60C2, 2}, true, 1, 0xFFFFFFFD})), "601#2FC26002FD000000");
  EXPECT_EQ(hex(encode(SdoResponse{2, {0x1000, 0}, SdoResponse::Kind::kValue, 4, 0x20192})),
            "582#4300100092010200");
  EXPECT_EQ(hex(encode(SdoResponse{2, {0x6060, 0}, SdoResponse::Kind::kWritten, 4, 0})),
            "582#6060600000000000");
  EXPECT_EQ(hex(encode(SdoResponse{2, {0x6007, 0}, SdoResponse::Kind::kAbort, 4, kAbortNoObject})),
            "582#8007600000000206");
  EXPECT_EQ(hex(encode_sdo_abort(2, {0x6007, 0}, kAbortTimeout)), "602#8007600000000405");
}

// An answer that does not tell its size carries four bytes; segmented answers are not understood.
TEST(Cia402Codec, SdoAnswersOfOtherKinds) {
  const auto untold = decode_sdo_response(from_hex("581#4200100092010200"));
  ASSERT_TRUE(untold);
  EXPECT_EQ(untold->value, 0x20192U);
  const auto one_byte = decode_sdo_response(from_hex("581#4F60600008AABBCC"));
  ASSERT_TRUE(one_byte);
  EXPECT_EQ(one_byte->value, 8U);
  EXPECT_FALSE(decode_sdo_response(from_hex("581#4108100010000000")));
  EXPECT_FALSE(decode_sdo_response(from_hex("581#0001020304050607")));
  EXPECT_FALSE(decode_sdo_response(from_hex("581#43001000920102")));
  EXPECT_STREQ(abort_text(0x06090030), "value range exceeded");
  EXPECT_STREQ(abort_text(1), "unknown abort code");
}

// A million random process data frames come back as they went out.
TEST(Cia402Codec, MillionRoundTrips) {
  base::Rng rng(3);
  for (int i = 0; i < 250'000; ++i) {
    const bool has_torque = rng.below(2) == 0;
    const Rpdo1 command = random_rpdo1(rng, has_torque);
    const auto command_again = decode_rpdo1(encode(command));
    ASSERT_TRUE(command_again && command_again->node == command.node &&
                command_again->control_word == command.control_word &&
                command_again->target_counts == command.target_counts &&
                command_again->max_torque_permille == command.max_torque_permille);
    const Tpdo1 state = random_tpdo1(rng, has_torque);
    const auto state_again = decode_tpdo1(encode(state));
    ASSERT_TRUE(state_again && state_again->node == state.node &&
                state_again->status_word == state.status_word &&
                state_again->position_counts == state.position_counts &&
                state_again->torque_permille == state.torque_permille);
    const Rpdo2 feed{any_node(rng, 127), any<std::int32_t>(rng), any<std::int16_t>(rng),
                     any<std::int8_t>(rng)};
    const auto feed_again = decode_rpdo2(encode(feed));
    ASSERT_TRUE(feed_again && feed_again->node == feed.node &&
                feed_again->velocity_offset_counts_s == feed.velocity_offset_counts_s &&
                feed_again->torque_offset_permille == feed.torque_offset_permille &&
                feed_again->mode == feed.mode);
    const Tpdo2 slow{any_node(rng, 127), any<std::uint16_t>(rng), any<std::int8_t>(rng),
                     any<std::uint32_t>(rng)};
    const auto slow_again = decode_tpdo2(encode(slow));
    ASSERT_TRUE(slow_again && slow_again->node == slow.node &&
                slow_again->error_code == slow.error_code && slow_again->mode == slow.mode &&
                slow_again->digital_inputs == slow.digital_inputs);
  }
}

// A hundred thousand random SDO requests, answers and emergencies likewise.
TEST(Cia402Codec, ServiceRoundTrips) {
  base::Rng rng(4);
  for (int i = 0; i < 100'000; ++i) {
    const auto num_bytes = static_cast<std::uint8_t>(1 + rng.below(4));
    const std::uint32_t value = any<std::uint32_t>(rng) >> (32 - 8 * num_bytes);
    const SdoRequest request{any_node(rng, 127),
                             {any<std::uint16_t>(rng), any<std::uint8_t>(rng)},
                             true,
                             num_bytes,
                             value};
    const auto again = decode_sdo_request(encode(request));
    ASSERT_TRUE(again && again->object == request.object && again->write &&
                again->num_bytes == num_bytes && again->value == value);
    const SdoResponse response{request.node, request.object, SdoResponse::Kind::kValue, num_bytes,
                               value};
    const auto answer = decode_sdo_response(encode(response));
    ASSERT_TRUE(answer && answer->object == request.object && answer->value == value &&
                answer->num_bytes == num_bytes);
    const Emergency emergency{request.node,
                              any<std::uint16_t>(rng),
                              any<std::uint8_t>(rng),
                              {any<std::uint8_t>(rng), 1, 2, 3, any<std::uint8_t>(rng)}};
    const auto told = decode_emergency(encode(emergency));
    ASSERT_TRUE(told && told->error_code == emergency.error_code &&
                told->vendor == emergency.vendor);
  }
}

int num_understood(const CanFrame& frame) {
  return (decode_nmt(frame) ? 1 : 0) + (is_sync(frame) ? 1 : 0) +
         (decode_emergency(frame) ? 1 : 0) + (decode_tpdo1(frame) ? 1 : 0) +
         (decode_rpdo1(frame) ? 1 : 0) + (decode_tpdo2(frame) ? 1 : 0) +
         (decode_rpdo2(frame) ? 1 : 0) + (decode_sdo_response(frame) ? 1 : 0) +
         (decode_sdo_request(frame) ? 1 : 0) + (decode_heartbeat(frame) ? 1 : 0);
}

// Of all 2048 identifiers and all lengths: at most one meaning, and only with the contract's
// length.
TEST(Cia402Codec, EveryIdentifierAndLength) {
  for (std::uint32_t id = 0; id < 0x800; ++id) {
    for (std::uint8_t dlc = 0; dlc <= 8; ++dlc) {
      CanFrame frame;
      frame.id = id;
      frame.dlc = dlc;
      frame.data = {0x60, 0, 0, 0, 0, 0, 0, 0};
      if (id == 0) frame.data = {1, 1, 0, 0, 0, 0, 0, 0};
      if ((id & 0x780) == 0x700) frame.data[0] = 5;
      if ((id & 0x780) == 0x600) frame.data[0] = 0x40;
      const std::uint32_t function = id & 0x780;
      const bool has_node = (id & 0x7F) != 0;
      const bool expected =
          (id == 0 && dlc == 2) || (id == 0x80 && dlc == 0) ||
          (has_node && function == 0x080 && dlc == 8) ||
          (has_node && (function == 0x180 || function == 0x200) && (dlc == 6 || dlc == 8)) ||
          (has_node && function == 0x280 && dlc == 7) ||
          (has_node && function == 0x300 && dlc == 8) ||
          (has_node && (function == 0x580 || function == 0x600) && dlc == 8) ||
          (has_node && function == 0x700 && dlc == 1);
      ASSERT_EQ(num_understood(frame), expected ? 1 : 0) << std::hex << id << " " << int{dlc};
    }
  }
}

// The same frames as RTR, with 29 bits, as FD or as error frames mean nothing.
TEST(Cia402Codec, OnlyPlainFrames) {
  for (const char* text : {"000#0101", "080#", "081#0000000000000000", "181#000000000000",
                           "201#0000000000000000", "281#00000000000000", "301#0000000000000000",
                           "581#6000000000000000", "601#4000000000000000", "701#05"}) {
    const CanFrame plain = from_hex(text);
    ASSERT_EQ(num_understood(plain), 1) << text;
    for (bool CanFrame::*flag :
         {&CanFrame::extended, &CanFrame::remote, &CanFrame::error, &CanFrame::fd}) {
      CanFrame odd = plain;
      odd.*flag = true;
      EXPECT_EQ(num_understood(odd), 0) << text;
    }
  }
}

// Commands and states that CiA 301 does not know are no messages.
TEST(Cia402Codec, UnknownValues) {
  EXPECT_FALSE(decode_nmt(from_hex("000#0301")));
  EXPECT_FALSE(decode_nmt(from_hex("000#0180")));
  EXPECT_FALSE(decode_heartbeat(from_hex("701#06")));
  EXPECT_FALSE(decode_heartbeat(from_hex("701#85")));
}

}  // namespace
}  // namespace can::cia402
