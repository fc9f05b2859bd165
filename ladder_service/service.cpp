// SPDX-License-Identifier: BSD-3-Clause
#include "ladder_service/service.h"

#include <string>

#include "ladder/ladder.h"
#include "ladder_msgs/health_t.hpp"
#include "ladder_service/config.h"
#include "ladder_service/convert.h"
#include "runtime/recording_watch.h"

namespace ladder_service {
namespace {

using ladder_msgs::health_t;
namespace channels = runtime::channels;

constexpr std::int64_t kSilentAfterUs = 1'000'000;
enum Stage : std::size_t { kUpdate, kPublish };

class LadderService final : public runtime::Service {
 public:
  explicit LadderService(runtime::ServiceContext context)
      : context_(context),
        topologies_(context.bus.newest(channels::kTopology)),
        tracker_(read_params(context.config)) {}

  void step(const base::Now& now) noexcept override {
    const ladder_msgs::topology_t* topology = topologies_.take(now.utime_us);
    if (topology == nullptr) {
      if (now.monotonic_us - last_topology_us_ > kSilentAfterUs) {
        context_.health.set_state(health_t::STATE_WAITING);
      }
      return;
    }
    last_topology_us_ = now.monotonic_us;
    context_.health.set_state(health_t::STATE_WORKING);
    if (recording_.is_new(topology->utime)) {
      context_.journal.info("another recording begins: all rungs are forgotten");
      tracker_.reset();
    }
    const ladder::LadderEstimate* estimate = nullptr;
    {
      const runtime::StageTimer timer(context_.health, kUpdate);
      to_node_cloud(*topology, nodes_);
      estimate = &tracker_.update(nodes_);
    }
    report_heads();
    const runtime::StageTimer timer(context_.health, kPublish);
    to_message(*estimate, *topology, message_);
    context_.bus.publish(channels::kRungs, message_);
    ++message_.seq;
  }

 private:
  /// Said once; health stays degraded while it is so.
  void report_heads() {
    const ladder::HeadFit fit = tracker_.head_fit();
    if (fit.is_misfit) context_.health.set_state(health_t::STATE_DEGRADED);
    if (fit.is_misfit && !heads_told_) {
      context_.journal.warning("heads disagree by " +
                               std::to_string(static_cast<int>(1e3 * fit.misfit_m + 0.5)) +
                               " mm on what they see: their mounting differs from the configured "
                               "one; corrected as far as it shows, please run scripts/calibrate");
    }
    heads_told_ = fit.is_misfit;
  }

  runtime::ServiceContext context_;
  runtime::Mailbox<ladder_msgs::topology_t>& topologies_;
  ladder::LadderTracker tracker_;
  ladder::NodeCloud nodes_;
  runtime::RecordingWatch recording_;
  ladder_msgs::ladder_t message_{};
  std::int64_t last_topology_us_ = 0;
  bool heads_told_ = false;
};

}  // namespace

runtime::ServiceDescription description() {
  return {.name = "ladder",
          .number = health_t::SERVICE_LADDER,
          .purpose = "ladder_service: topology in, rungs and safe grasp locations out",
          .make = [](const runtime::ServiceContext& context) {
            return std::make_unique<LadderService>(context);
          }};
}

}  // namespace ladder_service
