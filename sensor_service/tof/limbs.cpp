// SPDX-License-Identifier: BSD-3-Clause
#include "tof/limbs.h"

namespace tof {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The claw in the plane across its rung, (along the claw's x, away from the shank): as modelled in
// the simulator's robot.xml. Its two rows of fingers are 24 mm apart.
const Vector2d kPalm_m(-0.028, 0.021);
const Vector2d kPalmEnd_m(0.026, 0.021);
const Vector2d kFingerEnd_m(0.022, -0.024);
const Vector2d kJawKnee_m(-0.002, -0.040);  // from the hinge, which is at the palm's begin
const Vector2d kJawTip_m(0.020, -0.050);
constexpr double kFingers_m = 0.017;  // half the rows' distance and a finger's radius

struct Turn {
  double sine, cosine;
};

/// Taylor series of an eighth of the angle, doubled three times: 1e-15 for |angle| <= 4.
Turn turn(double angle_rad) {
  const double x = 0.125 * angle_rad;
  const double x2 = x * x;
  double sine = x * (1.0 - x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0))));
  double cosine = 1.0 - x2 / 2.0 * (1.0 - x2 / 12.0 * (1.0 - x2 / 30.0 * (1.0 - x2 / 56.0)));
  for (int i = 0; i < 3; ++i) {
    const double doubled = 2.0 * sine * cosine;
    cosine = cosine * cosine - sine * sine;
    sine = doubled;
  }
  return {sine, cosine};
}

/// Turned about y by the angle, in the plane (x, z).
Vector2d turned(const Turn& by, const Vector2d& p) {
  return {by.cosine * p.x() + by.sine * p.y(), -by.sine * p.x() + by.cosine * p.y()};
}

/// One leg: everything below the abduction axis lies in a plane that turns about it.
class Leg {
 public:
  Leg(const LimbParams& params, int leg, double abduction_rad)
      : params_(params),
        abduction_(turn(abduction_rad)),
        left_(leg % 2 == 0 ? 1.0 : -1.0),
        axis_m_((leg < 2 ? 1.0 : -1.0) * params.hip_x_m, left_ * params.hip_y_m, 0.0) {}

  /// From the leg's plane, (x, z) from the hip, into the body.
  Vector3d in_body_m(const Vector2d& p_m) const {
    const double y = left_ * params_.abduction_m;
    return axis_m_ + Vector3d(p_m.x(), abduction_.cosine * y - abduction_.sine * p_m.y(),
                              abduction_.sine * y + abduction_.cosine * p_m.y());
  }
  Capsule between(const Vector2d& from_m, const Vector2d& to_m, double radius_m) const {
    return {in_body_m(from_m), in_body_m(to_m), radius_m + params_.margin_m};
  }

 private:
  const LimbParams& params_;
  Turn abduction_;
  double left_;
  Vector3d axis_m_;
};

}  // namespace

Limbs limbs_of(const LimbParams& params, const JointAngles& angles_rad) {
  Limbs limbs;
  for (int index = 0; index < 4; ++index) {
    const double* q = &angles_rad[static_cast<std::size_t>(4 * index)];
    const Leg leg(params, index, q[0]);
    const Turn shank = turn(q[1] + q[2]);
    const Turn claw = turn(q[1] + q[2] + (index < 2 ? -params.wrist_rad : params.wrist_rad));
    const Turn jaw = turn(q[1] + q[2] + q[3] + (index < 2 ? -params.wrist_rad : params.wrist_rad));
    const Vector2d knee_m = turned(turn(q[1]), {0.0, -params.thigh_m});
    const Vector2d foot_m = knee_m + turned(shank, {0.0, -params.shank_m});
    const Vector2d hinge_m = foot_m + turned(claw, kPalm_m);
    const Vector2d palm_end_m = foot_m + turned(claw, kPalmEnd_m);
    const Vector2d jaw_knee_m = hinge_m + turned(jaw, kJawKnee_m);
    Capsule* capsule = &limbs[static_cast<std::size_t>(kCapsulesPerLeg * index)];
    capsule[0] = leg.between({0.0, 0.0}, knee_m, params.thigh_radius_m);
    capsule[1] = leg.between(knee_m, foot_m, params.shank_radius_m);
    capsule[2] = leg.between(hinge_m, palm_end_m, kFingers_m);
    capsule[3] = leg.between(palm_end_m, foot_m + turned(claw, kFingerEnd_m), kFingers_m);
    capsule[4] = leg.between(hinge_m, jaw_knee_m, kFingers_m);
    capsule[5] = leg.between(jaw_knee_m, hinge_m + turned(jaw, kJawTip_m), kFingers_m);
  }
  return limbs;
}

}  // namespace tof
