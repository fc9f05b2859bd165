// SPDX-License-Identifier: BSD-3-Clause
// Rungs by trust, rails, and on each rung the stretches where a gripper may close, or why not.

import { Group } from "three";
import { ladder_t as Ladder } from "../messages.js";
import { flagsOf, namesOf } from "../words.js";
import { Bars } from "./bars.js";

export const LADDER_COLORS = { trusted: "#ffd75e", candidate: "#9aa0ae", rail: "#6e7688", free: "#3ddc84", refused: "#ff5d5d" };
const REASONS = namesOf(Ladder, "REASON_");
const MIN_RADIUS_M = 0.008;

const between = (a, b, share) => a.map((value, k) => value + (b[k] - value) * share);

/** Ends and looks of one rung. */
function rungBar(message, i) {
  const isTrusted = message.rung_state[i] === Ladder.RUNG_TRUSTED;
  const flags = flagsOf(Ladder, "FLAG_", message.rung_flags[i]);
  const sight = `${Math.round(message.rung_confidence[i] * 100)} %`;
  return {
    from: [message.rung_x0_m[i], message.rung_y0_m[i], message.rung_z0_m[i]],
    to: [message.rung_x1_m[i], message.rung_y1_m[i], message.rung_z1_m[i]],
    radius: Math.max(MIN_RADIUS_M, message.rung_radius_m[i]),
    color: isTrusted ? LADDER_COLORS.trusted : LADDER_COLORS.candidate,
    opacity: isTrusted ? 1 : 0.35 + 0.5 * message.rung_confidence[i],
    hint: [`rung ${message.rung_id[i]}`, isTrusted ? "trusted" : "candidate", sight, ...flags].join(", "),
  };
}

/** A sleeve around the rung: green where a gripper may close, red where not. */
function sleeve(message, i, rung) {
  const length = Math.hypot(...rung.to.map((value, k) => value - rung.from[k])) || 1e-6;
  const isFree = message.interval_reason[i] === Ladder.REASON_NONE;
  const [from, to] = [message.interval_from_m[i], message.interval_to_m[i]];
  const stretch = `${Math.round(from * 100)} to ${Math.round(to * 100)} cm`;
  return {
    from: between(rung.from, rung.to, from / length),
    to: between(rung.from, rung.to, to / length),
    radius: rung.radius * (isFree ? 1.5 : 1.2),
    color: isFree ? LADDER_COLORS.free : LADDER_COLORS.refused,
    opacity: isFree ? 0.75 : 0.4,
    hint: `${stretch}: ${isFree ? "a gripper may close here" : REASONS[message.interval_reason[i]]}`,
  };
}

export class LadderModel {
  constructor(scene) {
    this.rungs = new Group();
    this.bars = new Bars();
    this.affordances = new Bars();
    this.rungs.add(this.bars);
    scene.add(this.rungs, this.affordances);
  }

  show(message) {
    const rungs = [...message.rung_id.keys()].map((i) => rungBar(message, i));
    const rails = [...message.rail_x0_m.keys()].map((i) => ({
      from: [message.rail_x0_m[i], message.rail_y0_m[i], message.rail_z0_m[i]],
      to: [message.rail_x1_m[i], message.rail_y1_m[i], message.rail_z1_m[i]],
      radius: 0.02,
      color: LADDER_COLORS.rail,
      opacity: 0.8,
      hint: "rail",
    }));
    this.bars.show([...rungs, ...rails]);
    const isShown = (i) => message.interval_reason[i] !== Ladder.REASON_NOT_TRUSTED; // a candidate's colour says it already
    const sleeves = [...message.interval_rung.keys()].filter(isShown).map((i) => sleeve(message, i, rungs[message.interval_rung[i]]));
    this.affordances.show(sleeves);
  }

  hide() {
    this.bars.show([]);
    this.affordances.show([]);
  }
}
