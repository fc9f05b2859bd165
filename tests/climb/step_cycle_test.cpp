// SPDX-License-Identifier: BSD-3-Clause
// Order of limbs and body shifts, and a whole climb on paper: ten rungs up by choice, reach and
// statics alone, and down again.
#include <gtest/gtest.h>

#include "climb/foot_line.h"
#include "climb/grasp_choice.h"
#include "climb/step_order.h"
#include "climb/support.h"
#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

// RR, FR, RL, FL upwards, for ever; backwards on the way down.
TEST(StepOrder, IsTheOneThatWasBest) {
  EXPECT_EQ(next_leg(kRearRight, true), kFrontRight);
  EXPECT_EQ(next_leg(kFrontRight, true), kRearLeft);
  EXPECT_EQ(next_leg(kRearLeft, true), kFrontLeft);
  EXPECT_EQ(next_leg(kFrontLeft, true), kRearRight);
  for (const Leg leg : kLegs) EXPECT_EQ(next_leg(next_leg(leg, true), false), leg);
  EXPECT_DOUBLE_EQ(body_shift_m(0.30, true), 0.075);
  EXPECT_DOUBLE_EQ(body_shift_m(0.30, false), -0.075);
}

// Staggered = four rungs.
TEST(StepOrder, KnowsTheStaggeredStance) {
  EXPECT_TRUE(is_staggered({3, 4, 1, 2}));
  EXPECT_FALSE(is_staggered({3, 3, 1, 2}));
  EXPECT_FALSE(is_staggered({3, 4, 1, 1}));
  EXPECT_FALSE(is_staggered({2, 4, 1, 2}));
}

/// The robot as points: body height and four held rungs of a ladder in the plane x = 0.
class PaperClimb {
 public:
  explicit PaperClimb(double spacing_m) : spacing_m_(spacing_m) {
    for (int k = 0; k <= 16; ++k) {
      RungView rung;
      rung.id = k;
      rung.trusted = true;
      rung.confidence = 1.0;
      rung.end0_m = Eigen::Vector3d(0.0, 0.2, spacing_m * k);
      rung.end1_m = Eigen::Vector3d(0.0, -0.2, spacing_m * k);
      rung.radius_m = 0.014;
      rung.covariance_m2 = 1e-6 * Eigen::Matrix3d::Identity();
      rungs_.push_back(rung);
      stretches_.push_back({k, 0.02, 0.38});
    }
    height_m_ = 2.0 * spacing_m;
  }

  /// One limb, one rung; what stands in the way, or nothing.
  std::string step(Leg leg, bool upwards) {
    const double shift_m = body_shift_m(spacing_m_, upwards);
    height_m_ += shift_m;
    const SupportVerdict held = support_.check_without(stance(), leg);
    if (!(held.margin >= params_.support.min_margin)) return name(held.burden);
    GraspQuery query;
    query.leg = leg;
    query.upwards = upwards;
    query.T_odom_body = pose();
    query.next_shift_m = Eigen::Vector3d(0.0, 0.0, shift_m);
    for (const Leg other : kLegs) query.held[other] = {other != leg, foot_m(other)};
    query.from_m = foot_m(leg);
    const GraspDecision decision = choice_.choose({rungs_, stretches_, 0.0, true}, query);
    if (decision.refusal != Refusal::kNone) return name(decision.refusal);
    const std::string way = swing(leg, decision.target);
    if (!way.empty()) return way;
    rung_[leg] = decision.target.rung_id;
    return "";
  }

  const PerLeg<int>& rungs() const { return rung_; }
  RungLoss rung_loss() const { return support_.check_rung_loss(stance()); }

 private:
  Eigen::Isometry3d pose() const {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, 0, -1, 0, 1, 0, 1, 0, 0;
    T.translation() = Eigen::Vector3d(-params_.motion.stand_off_m, 0.0, height_m_);
    return T;
  }
  Eigen::Vector3d foot_m(Leg leg) const {
    return {0.0, lateral_sign(leg) * params_.motion.lateral_home_m, spacing_m_ * rung_[leg]};
  }
  Stance stance() const {
    PerLeg<double> along_m;
    for (const Leg leg : kLegs) along_m[leg] = spacing_m_ * rung_[leg] - height_m_;
    return climb_tests::stance_at(params_, along_m, rung_);
  }
  /// Retract along the claw, straight over to the pregrasp, straight in.
  std::string swing(Leg leg, const GraspTarget& target) const {
    const Eigen::Isometry3d to_body = pose().inverse();
    const Eigen::Vector3d from = to_body * foot_m(leg);
    const LegAngles held = kinematics_.inverse(leg, from).angles_rad;
    const Eigen::Vector3d out =
        from + params_.motion.retract_m * kinematics_.retract_direction(leg, held);
    const Eigen::Vector3d before = to_body * target.pregrasp_m;
    const Eigen::Vector3d in = to_body * target.grasp_m;
    const auto reach = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, double speed) {
      return FootLine(kinematics_, leg, a, b, {speed, 1.0}).reach();
    };
    if (reach(from, out, 0.2) != Reach::kReachable) return "retract";
    if (reach(out, before, 0.3) != Reach::kReachable) return "transit";
    if (reach(before, in, 0.05) != Reach::kReachable) return "approach";
    return "";
  }

  ClimbParams params_;
  LegKinematics kinematics_{params_.robot};
  Support support_{params_.robot, params_.support};
  GraspChoice choice_{params_};
  std::vector<RungView> rungs_;
  std::vector<StretchView> stretches_;
  PerLeg<int> rung_ = {3, 3, 1, 1};
  double spacing_m_;
  double height_m_ = 0.0;
};

// Ten rungs up and ten down at each usual spacing: every grasp is found on the next rung, every
// line is reachable, three limbs always bear the robot; the rest stance survives any broken rung.
TEST(PaperClimb, GoesUpAndDown) {
  for (const double spacing_m : {0.25, 0.30, 0.35}) {
    PaperClimb climb(spacing_m);
    for (const bool upwards : {true, false}) {
      Leg leg = upwards ? kRearRight : kFrontLeft;
      for (int step = 0; step < 40; ++step) {
        const PerLeg<int> before = climb.rungs();
        ASSERT_EQ(climb.step(leg, upwards), "")
            << name(leg) << " step " << step << (upwards ? " up" : " down") << " at " << spacing_m;
        ASSERT_EQ(climb.rungs()[leg], before[leg] + (upwards ? 1 : -1));
        if (is_staggered(climb.rungs())) {
          ASSERT_TRUE(climb.rung_loss().survives) << step;
        }
        leg = next_leg(leg, upwards);
      }
    }
    EXPECT_EQ(climb.rungs(), (PerLeg<int>{3, 3, 1, 1}));
  }
}

}  // namespace
}  // namespace climb
