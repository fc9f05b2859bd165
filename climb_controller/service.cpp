// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/service.h"

#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

#include <sys/random.h>

#include "climb_controller/chronicle.h"
#include "climb_controller/control_thread.h"
#include "climb_controller/convert.h"
#include "ladder_msgs/health_t.hpp"

namespace climb_controller {
namespace {

using ladder_msgs::health_t;
namespace channels = runtime::channels;

constexpr std::size_t kMaxWaitingSamples = 256;  // more than a second of a 200 Hz unit
constexpr std::size_t kMaxWaitingOrders = 16;
constexpr std::int64_t kPoseEvery = 2;            // cycles: 50 Hz
constexpr std::int64_t kStateEvery = 5;           // cycles: 20 Hz
constexpr std::int64_t kMaxLatePeriods = 3;       // later, and the watchdog is not fed
constexpr std::int64_t kMaxSilence_us = 100'000;  // of the control thread
enum Stage : std::size_t { kCycle, kLate };

/// Positive and not 0: a message's int64 holds it, and commands of zeros never match.
std::uint64_t draw_session_id() {
  std::uint64_t id = 0;
  while (id == 0) {
    if (getrandom(&id, sizeof id, 0) != sizeof id) continue;
    id >>= 1;
  }
  return id;
}

ServiceParams read_all(runtime::ConfigTable table) {
  ServiceParams params = read_params(std::move(table));
  params.cycle.controller.session_id = draw_session_id();
  if (params.flight_folder.empty()) {
    if (const char* folder = std::getenv("STATE_DIRECTORY")) params.flight_folder = folder;
  }
  return params;
}

class ClimbService final : public runtime::Service {
 public:
  explicit ClimbService(runtime::ServiceContext context)
      : context_(context),
        params_(read_all(context.config)),
        rungs_in_(context.bus.newest(channels::kRungs)),
        imu_in_(context.bus.queue(channels::kImu, kMaxWaitingSamples)),
        orders_in_(context.bus.shared_queue(channels::kCommand, kMaxWaitingOrders)),
        rungs_(params_.perception),
        memory_(params_.memory),
        imu_(params_.attitude),
        chronicle_(context.journal),
        control_(params_) {
    state_.session_id = static_cast<std::int64_t>(params_.cycle.controller.session_id);
    state_.seq = pose_.seq = -1;
  }

  void start() override {
    control_.start();
    context_.journal.info("servo bus " + params_.can_interface + ", lines " + params_.lines.chip +
                          ", " + control_.rights());
  }

  int wake_up() const override { return control_.news_fd(); }

  void step(const base::Now& now) noexcept override {
    now_us_ = now.monotonic_us;
    take_messages(now);
    control_.forget_wake_up();
    if (control_.news().refresh()) tell(control_.news().newest());
    if (const can::FlightRecorder* flight = control_.flight()) write_flight(*flight, now);
  }

  bool is_healthy() const override { return is_in_time_ && now_us_ - news_us_ <= kMaxSilence_us; }

  std::optional<int> end_now(bool asked) noexcept override;

 private:
  void take_messages(const base::Now& now);
  void tell(const CycleNews& news);
  void judge_health(const CycleNews& news);
  void publish(const CycleNews& news);
  void write_flight(const can::FlightRecorder& flight, const base::Now& now);

  runtime::ServiceContext context_;
  ServiceParams params_;
  runtime::Mailbox<ladder_msgs::ladder_t>& rungs_in_;
  runtime::Queue<ladder_msgs::imu_t>& imu_in_;
  runtime::Queue<ladder_msgs::command_t>& orders_in_;
  RungsInbox rungs_;
  RungMemory memory_;
  ImuInbox imu_;
  Chronicle chronicle_;
  ControlThread control_;

  ladder_msgs::climb_state_t state_{};
  ladder_msgs::pose_t pose_{};
  base::Quantiles work_us_;
  base::Quantiles late_us_;
  std::int64_t max_late_us_ = 0;  ///< since health was judged last
  std::int64_t pose_cycle_ = 0;
  std::int64_t state_cycle_ = 0;
  std::uint64_t num_answers_told_ = 0;
  std::int64_t now_us_ = 0;
  std::int64_t news_us_ = 0;  ///< when the control thread was heard last
  bool is_in_time_ = true;
  bool is_ending_ = false;
};

void ClimbService::take_messages(const base::Now& now) {
  bool is_imu_new = false;
  while (const ladder_msgs::imu_t* sample = imu_in_.take(now.utime_us)) {
    is_imu_new = imu_.accept(*sample, now.monotonic_us) || is_imu_new;
  }
  if (is_imu_new) {
    control_.imu().writing() = imu_.newest();
    control_.imu().publish();
  }
  if (const ladder_msgs::ladder_t* rungs = rungs_in_.take(now.utime_us)) {
    const auto verdict = rungs_.accept(*rungs, now, control_.rungs().writing());
    if (verdict == runtime::Reject::kNone) {
      const Eigen::Isometry3d T_odom_body =
          control_.news().newest().report.output.pose.T_odom_body();
      memory_.complete(now.monotonic_us, T_odom_body, control_.rungs().writing());
      control_.rungs().publish();
    }
  }
  while (const ladder_msgs::command_t* order = orders_in_.take(now.utime_us)) {
    if (!control_.orders().push(to_command(*order))) {
      context_.journal.warning("too many orders at once: some were dropped");
    }
  }
}

void ClimbService::tell(const CycleNews& news) {
  news_us_ = now_us_;
  CycleTiming timing;
  while (control_.timings().pop(timing)) {
    work_us_.add(timing.work_us);
    late_us_.add(timing.late_us);
    context_.health.add_stage_us(kCycle, timing.work_us);
    context_.health.add_stage_us(kLate, timing.late_us);
    max_late_us_ = std::max<std::int64_t>(max_late_us_, timing.late_us);
  }
  chronicle_.tell(news.report);
  if (chronicle_.take_stop()) control_.want_flight();
  judge_health(news);
  publish(news);
}

void ClimbService::judge_health(const CycleNews& news) {
  const auto period_us =
      static_cast<std::int64_t>(params_.cycle.controller.climb.motion.period_s * 1e6);
  is_in_time_ = max_late_us_ <= kMaxLatePeriods * period_us;
  max_late_us_ = 0;
  const climb::ControllerState state = news.report.output.state;
  context_.health.set_state(state == climb::ControllerState::kBoot ? health_t::STATE_WAITING
                            : news.report.output.reason != climb::Fault::kNone
                                ? health_t::STATE_DEGRADED
                                : health_t::STATE_WORKING);
}

void ClimbService::publish(const CycleNews& news) {
  if (news.num_cycles - pose_cycle_ >= kPoseEvery && imu_.newest().reading.valid) {
    pose_cycle_ = news.num_cycles;
    to_message(news.report.output.pose, pose_);
    pose_.utime = news.utime_us;
    ++pose_.seq;
    context_.bus.publish(channels::kPose, pose_);
  }
  // An answer is told at once, also one to a stranger, whose number is not repeated.
  const bool has_answered = num_answers_told_ != news.report.num_answers;
  if (news.num_cycles - state_cycle_ < kStateEvery && !has_answered) return;
  num_answers_told_ = news.report.num_answers;
  state_cycle_ = news.num_cycles;
  to_message(news.report, state_);
  state_.utime = news.utime_us;
  ++state_.seq;
  state_.cycles = news.num_cycles;
  state_.overruns = news.num_overruns;
  state_.cycle_p50_us = static_cast<std::int32_t>(work_us_.quantile(0.5));
  state_.cycle_p99_us = static_cast<std::int32_t>(work_us_.quantile(0.99));
  state_.cycle_max_us = static_cast<std::int32_t>(work_us_.quantile(1.0));
  state_.late_p99_us = static_cast<std::int32_t>(late_us_.quantile(0.99));
  state_.late_max_us = static_cast<std::int32_t>(late_us_.quantile(1.0));
  context_.bus.publish(channels::kClimb, state_);
}

void ClimbService::write_flight(const can::FlightRecorder& flight, const base::Now& now) {
  if (!params_.flight_folder.empty()) {
    const std::string path = params_.flight_folder + "/flight-" + std::to_string(now.utime_us);
    std::ofstream frames(path + ".candump.log");
    flight.write_candump(frames, "can0");
    std::ofstream events(path + ".events.txt");
    flight.write_events(events);
    if (frames && events) {
      context_.journal.info("the last bus frames are in " + path + ".candump.log");
    } else {
      context_.journal.warning("the last bus frames could not be written to " + path);
    }
  }
  control_.release_flight();
}

std::optional<int> ClimbService::end_now(bool asked) noexcept {
  const CycleReport& report = control_.news().newest().report;
  const bool is_first = report.output.state == climb::ControllerState::kBoot;
  if (is_first && (report.faults & climb::flag(climb::Fault::kSecondController)) != 0) {
    context_.journal.error("another controller speaks on " + params_.can_interface +
                           ": this one does not start");
    return runtime::kExitDevice;
  }
  if (!asked) return std::nullopt;
  control_.terminate();
  if (finishes_first(report.output.state)) {
    if (!is_ending_) context_.journal.info("asked to end: the step in the air is finished first");
    is_ending_ = true;
    return std::nullopt;
  }
  control_.hand_over();
  if (!control_.has_handed_over()) return std::nullopt;
  const bool hold = !params_.cycle.allow_no_hold_on_loss;
  context_.journal.info(hold ? "handed over: the drives hold by themselves"
                             : "handed over: what the drives do now is theirs (ground test)");
  return runtime::kExitAsked;
}

}  // namespace

runtime::ServiceDescription description() {
  return {.name = "climb",
          .number = health_t::SERVICE_CLIMB,
          .purpose = "climb_controller: rungs, IMU and orders in; servo frames, state and pose out",
          .make = [](const runtime::ServiceContext& context) {
            return std::make_unique<ClimbService>(context);
          }};
}

}  // namespace climb_controller
