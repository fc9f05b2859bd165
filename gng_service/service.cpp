// SPDX-License-Identifier: BSD-3-Clause
#include "gng_service/service.h"

#include <string>

#include "ddgng/ddgng.h"
#include "gng_service/config.h"
#include "gng_service/convert.h"
#include "ladder_msgs/health_t.hpp"
#include "runtime/recording_watch.h"

namespace gng_service {
namespace {

using ladder_msgs::health_t;
namespace channels = runtime::channels;

constexpr std::int64_t kSilentAfterUs = 1'000'000;
enum Stage : std::size_t { kUpdate, kPublish };

class GngService final : public runtime::Service {
 public:
  explicit GngService(runtime::ServiceContext context)
      : context_(context),
        clouds_(context.bus.newest(channels::kCloud)),
        params_(read_params(context.config)),
        gng_(params_) {}

  void step(const base::Now& now) noexcept override {
    const ladder_msgs::point_cloud_t* cloud = clouds_.take(now.utime_us);
    if (cloud == nullptr) {
      if (now.monotonic_us - last_cloud_us_ > kSilentAfterUs) {
        context_.health.set_state(health_t::STATE_WAITING);
      }
      return;
    }
    if (cloud->num_points > params_.max_points) {
      context_.journal.warning("a cloud of " + std::to_string(cloud->num_points) +
                               " points is not used: gng.max_points is " +
                               std::to_string(params_.max_points));
      return;
    }
    last_cloud_us_ = now.monotonic_us;
    context_.health.set_state(health_t::STATE_WORKING);
    if (recording_.is_new(cloud->utime)) {
      context_.journal.info("another recording begins: all nodes are forgotten");
      gng_.reset();
    }
    const ddgng::Topology* topology = nullptr;
    {
      const runtime::StageTimer timer(context_.health, kUpdate);
      topology = &gng_.update(to_cloud_view(*cloud, recording_.step_s()));
    }
    const runtime::StageTimer timer(context_.health, kPublish);
    to_message(*topology, *cloud, message_);
    context_.bus.publish(channels::kTopology, message_);
    ++message_.seq;
  }

 private:
  runtime::ServiceContext context_;
  runtime::Mailbox<ladder_msgs::point_cloud_t>& clouds_;
  ddgng::DdgngParams params_;
  ddgng::DynamicDensityGng gng_;
  runtime::RecordingWatch recording_;
  ladder_msgs::topology_t message_{};
  std::int64_t last_cloud_us_ = 0;
};

}  // namespace

runtime::ServiceDescription description() {
  return {.name = "gng",
          .number = health_t::SERVICE_GNG,
          .purpose = "gng_service: point clouds in, DD-GNG topology out",
          .make = [](const runtime::ServiceContext& context) {
            return std::make_unique<GngService>(context);
          }};
}

}  // namespace gng_service
