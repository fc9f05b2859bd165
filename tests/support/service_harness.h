// SPDX-License-Identifier: BSD-3-Clause
// One service on LCM's in-memory transport, in virtual time: tests publish inputs, step, and read
// outputs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/service.h"

namespace support {

class ServiceHarness {
 public:
  explicit ServiceHarness(const runtime::ServiceDescription& description,
                          const std::vector<std::string>& overrides = {})
      : config_(runtime::Config::load({}, overrides)),
        connection_(runtime::open_lcm("memq://")),
        bus(connection_),
        outside(connection_),
        health(description.number),
        journal(description.number, description.name) {
    journal.show_from(ladder_msgs::event_t::LEVEL_ERROR);
    service_ = description.make({bus, config_.table(description.name), health, journal});
  }

  /// Delivers everything published so far and lets the service work, as at this time.
  void step(std::int64_t utime_us) {
    bus.drain();
    service_->step({.monotonic_us = utime_us, .utime_us = utime_us});
    bus.drain();
  }

  /// health_t as the service would report it now.
  const ladder_msgs::health_t& report() { return health.snapshot(1, bus); }

 private:
  runtime::Config config_;
  std::shared_ptr<lcm_t> connection_;

 public:
  runtime::Bus bus;      ///< the service's
  runtime::Bus outside;  ///< the test's
  runtime::Health health;
  runtime::Journal journal;

 private:
  std::unique_ptr<runtime::Service> service_;
};

}  // namespace support
