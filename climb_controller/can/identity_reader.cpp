// SPDX-License-Identifier: BSD-3-Clause
#include "can/identity_reader.h"

namespace can {
namespace {

using cia402::Object;
using cia402::SdoResponse;

constexpr std::int64_t kTimeout_us = 500'000;

struct Row {
  Object object;
  std::optional<std::uint32_t> DriveIdentity::*field;
};

constexpr std::array<Row, 8> kRows = {{
    {{0x1000, 0}, &DriveIdentity::device_type},
    {{0x1018, 1}, &DriveIdentity::vendor},
    {{0x1018, 2}, &DriveIdentity::product},
    {{0x1018, 3}, &DriveIdentity::revision},
    {{0x1018, 4}, &DriveIdentity::serial_number},
    {{0x6502, 0}, &DriveIdentity::modes},
    {{0x6041, 0}, &DriveIdentity::status_word},
    {{0x6064, 0}, &DriveIdentity::position},
}};

}  // namespace

std::optional<CanFrame> IdentityReader::next_frame(std::int64_t now_us) {
  if (is_waiting_ && now_us - asked_us_ > kTimeout_us) {
    is_waiting_ = false;
    // Nobody there: the other objects would say the same.
    index_ = identity_.answered ? index_ + 1 : kNumObjects;
  }
  if (is_done() || is_waiting_) return std::nullopt;
  is_waiting_ = true;
  asked_us_ = now_us;
  return encode(cia402::SdoRequest{node_, kRows[index_].object});
}

void IdentityReader::take(const CanFrame& frame) {
  static_assert(kRows.size() == kNumObjects);
  const auto response = cia402::decode_sdo_response(frame);
  if (!response || response->node != node_ || !is_waiting_ || is_done()) return;
  if (!(response->object == kRows[index_].object)) return;
  identity_.answered = true;
  is_waiting_ = false;
  if (response->kind == SdoResponse::Kind::kValue) {
    identity_.*kRows[index_].field = response->value;
  }
  ++index_;
}

}  // namespace can
