// SPDX-License-Identifier: BSD-3-Clause
#include "relay/endpoint.h"

#include <algorithm>
#include <stdexcept>

#include "runtime/clock.h"

namespace relay {

Channels channels_of(std::string_view names) {
  Channels channels;
  while (!names.empty()) {
    const std::string_view name = names.substr(0, names.find(','));
    names.remove_prefix(std::min(names.size(), name.size() + 1));
    const runtime::ChannelInfo* channel = runtime::find_channel(name);
    if (channel == nullptr) {
      throw std::runtime_error("'" + std::string(name) +
                               "' is no channel; lcmtypes/README.md lists them");
    }
    channels.push_back(channel);
  }
  return channels;
}

Endpoint::Endpoint(std::shared_ptr<lcm_t> connection, const Channels& send, Channels receive)
    : connection_(std::move(connection)),
      receive_(std::move(receive)),
      tap_(connection_, send, [this](const runtime::Heard& heard) {
        board_.post(heard, runtime::clock_now().utime_us);
      }) {
  for (const runtime::ChannelInfo* channel : send) {
    if (find_received(channel->number) != nullptr) {
      throw std::runtime_error(std::string(channel->name) +
                               " is both sent and received: it would go round for ever");
    }
  }
}

const runtime::ChannelInfo* Endpoint::find_received(std::int16_t number) const {
  const auto found =
      std::find_if(receive_.begin(), receive_.end(),
                   [&](const runtime::ChannelInfo* channel) { return channel->number == number; });
  return found == receive_.end() ? nullptr : *found;
}

void Endpoint::publish(const runtime::ChannelInfo& channel, std::span<const std::uint8_t> message) {
  if (check_.check(message, channel) != runtime::Reject::kNone) {
    ++num_rejected_;
    return;
  }
  ++num_published_;
  lcm_publish(connection_.get(), std::string(channel.name).c_str(), message.data(),
              static_cast<unsigned int>(message.size()));
}

}  // namespace relay
