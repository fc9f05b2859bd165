// SPDX-License-Identifier: BSD-3-Clause
// The perception services in one process on LCM's in-memory transport, in virtual time: the same
// classes as in the live processes, stepped after every message. Output is a function of
// configuration and input alone.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/service.h"

namespace robot_in_a_box {

class Chain {
 public:
  /// Called with every message that a service publishes on one of the recorded channels.
  using Output = std::function<void(const char* channel, const void* bytes, std::size_t num_bytes)>;

  /// Throws runtime::ConfigError.
  explicit Chain(const runtime::Config& config);
  ~Chain();
  Chain(const Chain&) = delete;
  Chain& operator=(const Chain&) = delete;

  /// Records what the chain publishes on these channels.
  void record(const std::vector<std::string>& channels, Output output);

  /// Delivers one message as if it had arrived at this time and lets every service work until
  /// nothing is left to do.
  void feed(const std::string& channel, const void* bytes, std::size_t num_bytes,
            std::int64_t utime_us);

  /// The process of that service ("sensor", "gng", "ladder") is gone, without a word.
  void kill(const std::string& service);
  /// It is there again and knows nothing.
  void start_anew(const std::string& service);
  /// How long the steps of a service ("sensor", "gng", "ladder") have taken since the start.
  double busy_ms(std::string_view service) const;

  /// Messages that a service refused, over all causes.
  std::int64_t num_rejected() const;

 private:
  struct Member;
  struct Recorder;
  void work(const base::Now& now);
  std::unique_ptr<Member>& member(const std::string& service);

  runtime::Config config_;
  std::shared_ptr<lcm_t> connection_;
  runtime::Bus pump_;  ///< delivers for all
  std::vector<runtime::ServiceDescription> descriptions_;
  std::vector<std::unique_ptr<Member>> members_;  ///< in that order; null: killed
  std::unique_ptr<Recorder> recorder_;
};

}  // namespace robot_in_a_box
