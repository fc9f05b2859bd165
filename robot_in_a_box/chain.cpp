// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/chain.h"

#include <chrono>

#include "base/check.h"
#include "gng_service/service.h"
#include "ladder_service/service.h"
#include "sensor_service/service.h"

namespace robot_in_a_box {

struct Chain::Member {
  Member(const runtime::ServiceDescription& description, const runtime::Config& config,
         std::shared_ptr<lcm_t> connection)
      : name(description.name),
        bus(std::move(connection)),
        health(description.number),
        journal(description.number, description.name) {
    journal.show_from(ladder_msgs::event_t::LEVEL_WARNING);
    service = description.make({bus, config.table(description.name), health, journal});
  }

  void step(const base::Now& now) {
    using std::chrono::steady_clock;
    const steady_clock::time_point start = steady_clock::now();
    service->step(now);
    busy += steady_clock::now() - start;
  }

  std::string name;
  runtime::Bus bus;
  runtime::Health health;
  runtime::Journal journal;
  std::unique_ptr<runtime::Service> service;
  std::chrono::steady_clock::duration busy{};
};

struct Chain::Recorder {
  Output output;

  static void on_message(const lcm_recv_buf_t* received, const char* channel, void* recorder) {
    static_cast<Recorder*>(recorder)->output(channel, received->data, received->data_size);
  }
};

Chain::Chain(const runtime::Config& config)
    : config_(config),
      connection_(runtime::open_lcm("memq://")),
      pump_(connection_),
      descriptions_{sensor_service::description(), gng_service::description(),
                    ladder_service::description()} {
  std::vector<std::string> tables;
  for (const runtime::ServiceDescription& description : descriptions_) {
    members_.push_back(std::make_unique<Member>(description, config_, connection_));
    tables.push_back(description.name);
  }
  config.check_all_read(tables, runtime::known_config_tables());
}

Chain::~Chain() = default;

void Chain::record(const std::vector<std::string>& channels, Output output) {
  recorder_ = std::make_unique<Recorder>();
  recorder_->output = std::move(output);
  for (const std::string& channel : channels) {
    lcm_subscribe(connection_.get(), channel.c_str(), &Recorder::on_message, recorder_.get());
  }
}

void Chain::feed(const std::string& channel, const void* bytes, std::size_t num_bytes,
                 std::int64_t utime_us) {
  lcm_publish(connection_.get(), channel.c_str(), bytes, static_cast<unsigned int>(num_bytes));
  work({.monotonic_us = utime_us, .utime_us = utime_us});
}

std::unique_ptr<Chain::Member>& Chain::member(const std::string& service) {
  std::size_t at = 0;
  while (at < descriptions_.size() && descriptions_[at].name != service) ++at;
  CHECK(at < descriptions_.size(), "a service of the chain: sensor, gng, ladder");
  return members_[at];
}

void Chain::kill(const std::string& service) {
  member(service).reset();
}

void Chain::start_anew(const std::string& service) {
  std::unique_ptr<Member>& again = member(service);
  const auto at = static_cast<std::size_t>(&again - members_.data());
  again.reset();
  again = std::make_unique<Member>(descriptions_[at], config_, connection_);
}

void Chain::work(const base::Now& now) {
  // All buses share the connection, so one drains for all; a message published by a step is
  // delivered in the next round.
  while (pump_.drain() > 0) {
    for (const auto& member : members_) {
      if (member != nullptr) member->step(now);
    }
  }
}

double Chain::busy_ms(std::string_view service) const {
  double sum_ms = 0.0;
  for (const auto& member : members_) {
    if (member == nullptr || member->name != service) continue;
    sum_ms += std::chrono::duration<double, std::milli>(member->busy).count();
  }
  return sum_ms;
}

std::int64_t Chain::num_rejected() const {
  std::int64_t sum = 0;
  for (const auto& member : members_) {
    if (member == nullptr) continue;
    for (const auto& input : member->bus.inputs()) sum += input->counts.rejected;
  }
  return sum;
}

}  // namespace robot_in_a_box
