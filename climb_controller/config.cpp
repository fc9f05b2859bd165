// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/config.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "can/cia402_bus.h"
#include "can/odrive_bus.h"

namespace climb_controller {
namespace {

using runtime::ConfigTable;

void read(ConfigTable table, climb::JointLimits& p) {
  table.read("min_rad", p.min_rad);
  table.read("max_rad", p.max_rad);
  table.read("max_velocity_rad_s", p.max_velocity_rad_s);
  table.read("max_acceleration_rad_s2", p.max_acceleration_rad_s2);
  table.read("max_torque_Nm", p.max_torque_Nm);
  table.read("peak_torque_Nm", p.peak_torque_Nm);
}

void read(ConfigTable table, climb::ClawParams& p) {
  table.read("width_m", p.width_m);
  table.read("open_rad", p.open_rad);
  table.read("closed_rad", p.closed_rad);
  table.read("empty_rad", p.empty_rad);
  table.read("on_rung_rad", p.on_rung_rad);
  table.read("on_rung_radius_m", p.on_rung_radius_m);
  table.read("jaw_rad_per_m", p.jaw_rad_per_m);
  table.read("jaw_row_m", p.jaw_row_m);
  table.read("on_rung_window_rad", p.on_rung_window_rad);
  table.read("capture_m", p.capture_m);
  table.read("seat_up_m", p.seat_up_m);
  table.read("seat_out_m", p.seat_out_m);
  table.read("min_rung_radius_m", p.min_rung_radius_m);
  table.read("max_rung_radius_m", p.max_rung_radius_m);
  table.read("holding_torque_Nm", p.holding_torque_Nm);
  table.read("min_closing_torque_Nm", p.min_closing_torque_Nm);
  table.read("max_torque_Nm", p.max_torque_Nm);
  table.read("max_velocity_rad_s", p.max_velocity_rad_s);
}

void read(ConfigTable table, climb::MassParams& p) {
  table.read("torso_kg", p.torso_kg);
  table.read("abduction_kg", p.abduction_kg);
  table.read("thigh_kg", p.thigh_kg);
  table.read("shank_kg", p.shank_kg);
  table.read("claw_kg", p.claw_kg);
}

void read(ConfigTable table, climb::RobotParams& p) {
  table.read("hip_x_m", p.hip_x_m);
  table.read("hip_y_m", p.hip_y_m);
  table.read("abduction_m", p.abduction_m);
  table.read("thigh_m", p.thigh_m);
  table.read("shank_m", p.shank_m);
  table.read("wrist_rad", p.wrist_rad);
  table.read("min_height_m", p.min_height_m);
  table.read("knee_sign", p.knee_sign);
  read(table.table("abduction"), p.abduction);
  read(table.table("hip"), p.hip);
  read(table.table("knee_bend"), p.knee_bend);
  read(table.table("mass"), p.mass);
  read(table.table("claw"), p.claw);
}

void read(ConfigTable table, climb::MotionParams& p) {
  table.read("stand_off_m", p.stand_off_m);
  table.read("lateral_home_m", p.lateral_home_m);
  table.read("retract_m", p.retract_m);
  table.read("retract_m_s", p.retract_m_s);
  table.read("transit_m_s", p.transit_m_s);
  table.read("pregrasp_m", p.pregrasp_m);
  table.read("aim_up_m", p.aim_up_m);
  table.read("aim_out_m", p.aim_out_m);
  table.read("bump_N", p.bump_N);
  table.read("bump_near_m", p.bump_near_m);
  table.read("approach_m_s", p.approach_m_s);
  table.read("cartesian_m_s2", p.cartesian_m_s2);
  table.read("pull_test_m", p.pull_test_m);
  table.read("clear_m", p.clear_m);
  table.read("pull_further_m", p.pull_further_m);
  table.read("prove_further_m", p.prove_further_m);
  table.read("pull_test_max_slip_m", p.pull_test_max_slip_m);
  table.read("pull_test_min_N", p.pull_test_min_N);
  table.read("pull_test_max_N", p.pull_test_max_N);
  table.read("seat_m", p.seat_m);
  table.read("seat_m_s", p.seat_m_s);
  table.read("seat_N", p.seat_N);
  table.read("unload_s", p.unload_s);
  table.read("open_s", p.open_s);
  table.read("settle_s", p.settle_s);
  table.read("close_s", p.close_s);
  table.read("pull_s", p.pull_s);
  table.read("load_s", p.load_s);
  table.read("body_shift_s", p.body_shift_s);
}

void read(ConfigTable table, climb::SupportParams& p) {
  table.read("gravity_m_s2", p.gravity_m_s2);
  table.read("grip_alarm_N", p.grip_alarm_N);
  table.read("friction", p.friction);
  table.read("squeeze_N", p.squeeze_N);
  table.read("min_margin", p.min_margin);
  table.read("max_moment_residual_Nm", p.max_moment_residual_Nm);
  table.read("max_force_residual_N", p.max_force_residual_N);
  table.read("moment_arm_m", p.moment_arm_m);
  table.read("max_iterations", p.max_iterations);
}

void read(ConfigTable table, climb::OdometryParams& p) {
  table.read("foot_sigma_m", p.foot_sigma_m);
  table.read("anchor_sigma_m", p.anchor_sigma_m);
  table.read("slip_m", p.slip_m);
  table.read("orientation_sigma_rad", p.orientation_sigma_rad);
  table.read("free_drift_m_s", p.free_drift_m_s);
  table.read("settled_after", p.settled_after);
  table.read("settling_trust", p.settling_trust);
  table.read("settling_s", p.settling_s);
}

void read(ConfigTable table, climb::GraspChoiceParams& p) {
  table.read("max_age_s", p.max_age_s);
  table.read("min_confidence", p.min_confidence);
  table.read("max_sigma_m", p.max_sigma_m);
  table.read("claw_margin_m", p.claw_margin_m);
  table.read("max_lateral_m", p.max_lateral_m);
  table.read("min_step_m", p.min_step_m);
  table.read("max_step_m", p.max_step_m);
  table.read("max_long_step_m", p.max_long_step_m);
  table.read("min_joint_margin_rad", p.min_joint_margin_rad);
  table.read("min_sigma_J_m", p.min_sigma_J_m);
  table.read("same_rung_m", p.same_rung_m);
  table.read("claw_clearance_m", p.claw_clearance_m);
  table.read("retry_distance_m", p.retry_distance_m);
  table.read("num_approach_points", p.num_approach_points);
  table.read("lateral_cost", p.lateral_cost);
  table.read("step_cost", p.step_cost);
  table.read("sigma_cost", p.sigma_cost);
  table.read("confidence_cost_m", p.confidence_cost_m);
  table.read("margin_cost_m", p.margin_cost_m);
}

void read(ConfigTable table, climb::LimbParams& p) {
  table.read("jaw_speed_rad_s", p.jaw_speed_rad_s);
  table.read("close_timeout_s", p.close_timeout_s);
  table.read("open_timeout_s", p.open_timeout_s);
  table.read("press_again_s", p.press_again_s);
  table.read("others_timeout_s", p.others_timeout_s);
  table.read("budget_s", p.budget_s);
  table.read("max_tries", p.max_tries);
  table.read("max_tries_elsewhere", p.max_tries_elsewhere);
  table.read("try_offset_m", p.try_offset_m);
  table.read("empty_window_rad", p.empty_window_rad);
}

void read(ConfigTable table, climb::ConfirmationParams& p) {
  table.read("touch_s", p.touch_s);
  table.read("lost_s", p.lost_s);
  table.read("stuck_s", p.stuck_s);
  table.read("open_window_rad", p.open_window_rad);
  table.read("max_disagreements", p.max_disagreements);
}

void read(ConfigTable table, climb::GateParams& p) {
  table.read("max_age_us", p.max_age_us);
  table.read("max_start_error_rad", p.max_start_error_rad);
}

void read(ConfigTable table, climb::WatchParams& p) {
  table.read("max_following_rad", p.max_following_rad);
  table.read("jump_margin_rad", p.jump_margin_rad);
  table.read("min_upright_cosine", p.min_upright_cosine);
  table.read("free_fall_m_s2", p.free_fall_m_s2);
  table.read("free_fall_s", p.free_fall_s);
  table.read("max_ladder_age_us", p.max_ladder_age_us);
}

void read(ConfigTable table, climb::AttitudeParams& p) {
  table.read("time_constant_s", p.time_constant_s);
  table.read("gravity_m_s2", p.gravity_m_s2);
  table.read("trust_m_s2", p.trust_m_s2);
  table.read("max_gap_s", p.max_gap_s);
}

void read(ConfigTable table, PerceptionParams& p) {
  table.read("max_age_us", p.max_age_us);
  table.read("max_ahead_us", p.max_ahead_us);
}

void read(ConfigTable table, RungMemoryParams& p) {
  table.read("memory_s", p.memory_s);
  table.read("ahead_m", p.ahead_m);
  table.read("same_rung_m", p.same_rung_m);
  table.read("clear_m", p.clear_m);
  table.read("damage_frames", p.damage_frames);
  table.read("sound_frames", p.sound_frames);
  table.require(check(p));
}

void read(ConfigTable table, DriveKind& p) {
  table.read("counts_per_rad", p.counts_per_rad);
  table.read("gear", p.gear);
  table.read("rated_torque_Nm", p.rated_torque_Nm);
  table.read("quick_stop_rad_s2", p.quick_stop_rad_s2);
  table.read("following_error_rad", p.following_error_rad);
  table.read("following_error_ms", p.following_error_ms);
  table.read("has_torque", p.has_torque);
  table.read("max_current_A", p.max_current_A);
}

/// Whole numbers written as TOML numbers.
void read(ConfigTable table, const char* key, climb::PerAxis<int>& values) {
  climb::PerAxis<double> numbers;
  std::copy(values.begin(), values.end(), numbers.begin());
  table.read(key, numbers);
  for (int axis = 0; axis < climb::kNumAxes; ++axis) {
    values[axis] = static_cast<int>(numbers[axis]);
    if (values[axis] != numbers[axis]) table.fail(key, "must hold whole numbers");
  }
}

/// "605E:0 607D:1", hexadecimal index and subindex; "" = none.
std::vector<can::cia402::Object> read_objects(ConfigTable table, const char* key) {
  std::string text;
  table.read(key, text);
  std::vector<can::cia402::Object> objects;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    can::cia402::Object object;
    const char* const end = word.data() + word.size();
    const auto index = std::from_chars(word.data(), end, object.index, 16);
    const bool has_index = index.ec == std::errc() && index.ptr != end && *index.ptr == ':';
    if (!has_index) table.fail(key, "is \"" + word + "\"; written as 605E:0");
    const auto subindex = std::from_chars(index.ptr + 1, end, object.subindex, 16);
    if (subindex.ec != std::errc() || subindex.ptr != end) {
      table.fail(key, "is \"" + word + "\"; written as 605E:0");
    }
    objects.push_back(object);
  }
  return objects;
}

void read(ConfigTable table, DriveLayout& p) {
  read(table, "node_id", p.node_id);
  for (const int id : p.node_id) {
    if (id < 1 || id > 126) table.fail("node_id", "must be 1..126");
  }
  read(table, "sign", p.sign);
  table.read("offset_rad", p.offset_rad);
  read(table.table("joint"), p.joint);
  read(table.table("jaw"), p.jaw);
}

/// "NAME", or "#5" for the line at offset 5 of a chip that names none.
void read_line(ConfigTable& table, const char* key, gpio::LineParams& line) {
  std::string place = line.name;
  table.read(key, place);
  if (!place.starts_with('#')) {
    line.name = place;
    return;
  }
  const bool is_offset = place.size() > 1 && place.size() < 6 &&
                         place.find_first_not_of("0123456789", 1) == std::string::npos;
  if (!is_offset) table.fail(key, "is \"" + place + "\"; an offset is written \"#5\"");
  line.name.clear();
  line.offset = std::stoi(place.substr(1));
}

void read_wiring(ConfigTable& table, const std::string& switches, gpio::LineParams& line) {
  table.read(switches + "_active_low", line.active_low);
  table.read(switches + "_bias", line.bias,
             {{"as_is", gpio::Bias::kAsIs},
              {"disabled", gpio::Bias::kDisabled},
              {"pull_up", gpio::Bias::kPullUp},
              {"pull_down", gpio::Bias::kPullDown}});
}

void read(ConfigTable table, gpio::LinesParams& p) {
  table.read("chip", p.chip);
  const char* const keys[] = {"touch_fl", "touch_fr", "touch_rl", "touch_rr"};
  gpio::LineParams touch = p.touch[0];
  read_wiring(table, "touch", touch);
  for (int i = 0; i < gpio::kNumTouch; ++i) {
    p.touch[i].active_low = touch.active_low;
    p.touch[i].bias = touch.bias;
    read_line(table, keys[i], p.touch[i]);
  }
  read_line(table, "estop", p.estop);
  read_wiring(table, "estop", p.estop);
  table.read("estop_debounce_us", p.estop.debounce_us);
  table.require(check(p));
}

void read_bus(ConfigTable table, ServiceParams& p) {
  table.read("interface", p.can_interface);
  table.read("protocol", p.protocol,
             {{"cia402", Protocol::kCia402}, {"odrive", Protocol::kOdrive}});
  table.read("feed_forward", p.feed_forward);
  table.read("torque_constant_Nm_A", p.torque_constant_Nm_A);
  p.accepted_objects = read_objects(table, "accepted_objects");
  if (p.protocol == Protocol::kOdrive && !p.accepted_objects.empty()) {
    table.fail("accepted_objects", "is about CiA 402: an ODrive has no objects");
  }
}

can::Cia402Params cia402_params(const ServiceParams& params) {
  can::Cia402Params bus = servo_bus_params(params.drives, params.cycle.controller.climb);
  bus.feed_forward = params.feed_forward;
  bus.optional_objects = params.accepted_objects;
  return bus;
}

can::OdriveParams odrive_params(const ServiceParams& params) {
  can::OdriveParams bus = odrive_bus_params(params.drives, params.cycle.controller.climb);
  bus.torque_constant_Nm_A = params.torque_constant_Nm_A;
  return bus;
}

/// "" or the violated relation; of drives that are not chosen nothing is asked.
std::string check_bus(const ServiceParams& params) {
  return params.protocol == Protocol::kOdrive ? check(odrive_params(params))
                                              : check(cia402_params(params));
}

void read(ConfigTable table, climb::ControllerParams& p) {
  table.read("period_s", p.climb.motion.period_s, {0.001, 0.1});
  p.gate.period_s = p.watch.period_s = p.climb.motion.period_s;
  table.read("selftest_s", p.selftest_s, {0.0, 60.0});
  table.read("enable_timeout_s", p.enable_timeout_s, {0.1, 60.0});
  table.read("dock_timeout_s", p.dock_timeout_s, {1.0, 3600.0});
  table.read("max_shifts", p.max_shifts, {0, 10});
  table.read("max_withdrawn", p.max_withdrawn, {1, 10});
  table.read("reset_after_s", p.reset_after_s, {0.0, 10.0});
  table.read("put_down_after_s", p.put_down_after_s, {0.0, 10.0});
  table.read("look_again_s", p.look_again_s, {0.0, 60.0});
  table.read("torque_ramp_s", p.torque_ramp_s, {0.0, 10.0});
  table.read("max_sag_m", p.max_sag_m, {0.0, 0.1});
  table.read("max_borne_part", p.max_borne_part, {0.0, 1.0});
  read(table.table("robot"), p.climb.robot);
  read(table.table("motion"), p.climb.motion);
  read(table.table("support"), p.climb.support);
  read(table.table("odometry"), p.climb.odometry);
  read(table.table("grasp"), p.climb.grasp);
  read(table.table("limb"), p.limb);
  read(table.table("confirmation"), p.confirmation);
  read(table.table("gate"), p.gate);
  read(table.table("watch"), p.watch);
}

}  // namespace

ServiceParams read_params(ConfigTable table) {
  ServiceParams params;
  table.read("power_off_hold", params.cycle.power_off_hold,
             {{"none", PowerOffHold::kNone},
              {"brake", PowerOffHold::kBrake},
              {"self_locking", PowerOffHold::kSelfLocking}});
  table.read("allow_no_hold_on_loss", params.cycle.allow_no_hold_on_loss);
  table.read("flight_folder", params.flight_folder);
  read(table, params.cycle.controller);
  read(table.table("drives"), params.drives);
  read_bus(table.table("can"), params);
  params.cycle.controller.feed_forward = params.feed_forward;
  read(table.table("lines"), params.lines);
  read(table.table("attitude"), params.attitude);
  read(table.table("perception"), params.perception);
  read(table.table("memory"), params.memory);

  table.table("attitude").require(check(params.attitude));
  CycleParams cycle = params.cycle;
  cycle.controller.session_id = 1;  // any: it is drawn at the start
  table.require(check(cycle));
  table.table("drives").require(check_bus(params));
  return params;
}

std::unique_ptr<can::ServoBus> make_servo_bus(const ServiceParams& params,
                                              can::Transport& transport,
                                              can::FlightRecorder* recorder) {
  if (params.protocol == Protocol::kOdrive) {
    return std::make_unique<can::OdriveBus>(odrive_params(params), transport, recorder);
  }
  return std::make_unique<can::Cia402Bus>(cia402_params(params), transport, recorder);
}

}  // namespace climb_controller
