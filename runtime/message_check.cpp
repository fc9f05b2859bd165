// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/message_check.h"

namespace runtime {
namespace {

template <class Msg>
std::int8_t sender_of(const Msg& message) {
  if constexpr (requires { message.service; }) {
    return message.service;
  } else {
    return 0;
  }
}

}  // namespace

Reject MessageCheck::check(std::span<const std::uint8_t> message, const ChannelInfo& channel) {
  Reject verdict = Reject::kFingerprint;
  const auto check_as = [&](auto& decoded) {
    if (channel.type != &kWireTypeOf<std::decay_t<decltype(decoded)>>) return;
    verdict = decode_guarded(message, decoded);
    sender_ = sender_of(decoded);
  };
  std::apply([&](auto&... decoded) { (check_as(decoded), ...); }, decoded_);
  return verdict;
}

}  // namespace runtime
