// SPDX-License-Identifier: BSD-3-Clause
// One way to be a service: a class that is built from a ServiceContext and has step(now).
// run_service() is its only main loop; a replay or the robot in a box construct the same class and
// call step() themselves.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/clock.h"
#include "runtime/bus.h"
#include "runtime/config.h"
#include "runtime/health.h"
#include "runtime/journal.h"

namespace runtime {

/// What a service may use; outlives it.
struct ServiceContext {
  Bus& bus;
  ConfigTable config;  ///< the service's own top-level table
  Health& health;
  Journal& journal;
};

class Service {
 public:
  virtual ~Service() = default;
  /// Takes what is in the mailboxes, works, publishes. Called after every drain and at least every
  /// 50 ms.
  virtual void step(const base::Now& now) noexcept = 0;
  /// Readable when step() has work that does not come from the bus (a device); -1 = none.
  virtual int wake_up() const { return -1; }

  /// Opens devices and starts threads; throws DeviceError. `--check` ends before.
  virtual void start() {}
  /// The supervisor's watchdog is fed only while this is true.
  virtual bool is_healthy() const { return true; }
  /// After each step: the exit code to end with now, or nothing to go on. `asked`: SIGTERM or
  /// SIGINT came; a second one ends at once.
  virtual std::optional<int> end_now(bool asked) noexcept {
    return asked ? std::optional<int>(0) : std::nullopt;
  }
};

/// A device cannot be used as asked: what, and how to mend it. Exit code 3.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A command line option that stands for a key of the configuration, e.g. --source for
/// sensor.source. It wins over the files, as --set does.
struct Shorthand {
  std::string option;
  std::string key;
  std::string help;
};

/// Name and number of a service, and how to build it.
struct ServiceDescription {
  std::string name;        ///< also its top-level table in the configuration, e.g. "gng"
  std::int8_t number = 0;  ///< health_t SERVICE_*
  std::string purpose;     ///< one line for --help
  std::function<std::unique_ptr<Service>(const ServiceContext&)> make;
  std::vector<Shorthand> shorthands = {};
};

inline constexpr int kExitAsked = 0;
inline constexpr int kExitConfiguration =
    2;  ///< wrong arguments or configuration: a restart will not help
inline constexpr int kExitDevice = 3;  ///< LCM or a device is missing: a restart may help
inline constexpr int kExitInternal = 70;

/// Arguments -> configuration -> bus -> construction -> start -> loop -> exit code. SIGTERM and
/// SIGINT end it with 0, unless the service says otherwise.
int run_service(int argc, char** argv, const ServiceDescription& description);

/// Top-level tables that a configuration file may hold.
const std::vector<std::string>& known_config_tables();

}  // namespace runtime
