// SPDX-License-Identifier: BSD-3-Clause
// The robot as its own messages say it stands: pose from LADDER_POSE (else from the topology), legs from the joint angles of LADDER_CLIMB.
// Lengths and signs as in climb_controller/climb (RobotParams, LegKinematics::foot_m).

import { BoxGeometry, Group, Mesh, MeshStandardMaterial, SphereGeometry } from "three";
import { climb_state_t as Climb } from "../messages.js";
import { Bars } from "./bars.js";

const HIP_X_M = 0.25, HIP_Y_M = 0.1, ABDUCTION_M = 0.05, THIGH_M = 0.22, SHANK_M = 0.24;
const COLORS = { body: "#c9d1e3", leg: "#aab4cc", holds: "#3ddc84", free: "#ffd75e", lost: "#ff5d5d" };

/** Abduction axis, hip, knee and foot of a leg in the body frame. */
function legPoints(leg, abduction, hip, knee) {
  const front = leg < 2 ? 1 : -1, side = leg % 2 === 0 ? 1 : -1;
  const turned = ([x, y, z]) => [
    front * HIP_X_M + x,
    side * HIP_Y_M + Math.cos(abduction) * y - Math.sin(abduction) * z,
    Math.sin(abduction) * y + Math.cos(abduction) * z,
  ];
  const sideways = side * ABDUCTION_M;
  const kneeAt = [-THIGH_M * Math.sin(hip), sideways, -THIGH_M * Math.cos(hip)];
  const footAt = [kneeAt[0] - SHANK_M * Math.sin(hip + knee), sideways, kneeAt[2] - SHANK_M * Math.cos(hip + knee)];
  return [[0, 0, 0], [0, sideways, 0], kneeAt, footAt].map(turned);
}

function clawColor(limb) {
  if (limb === Climb.LIMB_LOADED) return COLORS.holds;
  return limb === Climb.LIMB_SUPPORT_LOST ? COLORS.lost : COLORS.free;
}

export class RobotModel extends Group {
  constructor() {
    super();
    const torso = new Mesh(new BoxGeometry(0.56, 0.2, 0.09), new MeshStandardMaterial({ color: COLORS.body, roughness: 0.6 }));
    const face = new Mesh(new BoxGeometry(0.05, 0.16, 0.07), new MeshStandardMaterial({ color: "#3a4258" }));
    face.position.x = 0.3;
    this.limbs = new Bars();
    this.claws = [0, 1, 2, 3].map(() => new Mesh(new SphereGeometry(0.025, 12, 8), new MeshStandardMaterial()));
    this.claws.forEach((claw) => (claw.visible = false));
    this.add(torso, face, this.limbs, ...this.claws);
    this.visible = false;
  }

  /** p: metres, q: w x y z */
  stand(p, q) {
    this.visible = true;
    this.position.set(p[0], p[1], p[2]);
    this.quaternion.set(q[1], q[2], q[3], q[0]);
  }

  bend(message) {
    const bars = [];
    for (let leg = 0; leg < 4; ++leg) {
      const isHeard = message.is_heard.subarray(4 * leg, 4 * leg + 3).every(Boolean);
      this.claws[leg].visible = isHeard;
      if (!isHeard) continue;
      const points = legPoints(leg, ...message.measured_rad.subarray(4 * leg, 4 * leg + 3));
      for (let i = 0; i < 3; ++i) bars.push({ from: points[i], to: points[i + 1], radius: i === 0 ? 0.03 : 0.02, color: COLORS.leg });
      this.claws[leg].position.set(...points[3]);
      this.claws[leg].material.color.set(clawColor(message.limb_state[leg]));
    }
    this.limbs.show(bars);
  }

  hide() {
    this.visible = false;
    this.limbs.show([]);
    this.claws.forEach((claw) => (claw.visible = false));
  }
}
