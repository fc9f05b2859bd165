// SPDX-License-Identifier: BSD-3-Clause
// One line per rung, the highest on top: what is believed of it, and where and why it may not be grasped.

import { element } from "./element.js";
import { ladder_t as Ladder } from "./messages.js";
import { flagsOf, namesOf } from "./words.js";

const REASONS = namesOf(Ladder, "REASON_");
const HEADS = ["id", "height", "trust", "sight", "length", "where to grasp"];
const cm = (m) => `${Math.round(m * 100)} cm`;

function lengthOf(ladder, i) {
  return Math.hypot(ladder.rung_x1_m[i] - ladder.rung_x0_m[i], ladder.rung_y1_m[i] - ladder.rung_y0_m[i], ladder.rung_z1_m[i] - ladder.rung_z0_m[i]);
}

/** "24-51 cm; damaged": where a gripper may close, then why not elsewhere. */
function grasping(ladder, rung) {
  const free = [], reasons = new Set();
  for (let i = 0; i < ladder.num_intervals; ++i) {
    if (ladder.interval_rung[i] !== rung) continue;
    if (ladder.interval_reason[i] === Ladder.REASON_NONE) {
      free.push(`${Math.round(ladder.interval_from_m[i] * 100)}-${cm(ladder.interval_to_m[i])}`);
    } else reasons.add(REASONS[ladder.interval_reason[i]]);
  }
  return [...free, ...reasons].join(", ");
}

export class RungTable {
  constructor(place) {
    this.title = element("h2", {}, "Rungs");
    this.body = element("tbody");
    const heads = element("tr", {}, ...HEADS.map((head) => element("th", {}, head)));
    place.append(this.title, element("table", {}, element("thead", {}, heads), this.body));
  }

  ladder_t(message) {
    this.ladder = message;
  }

  refresh() {
    const { ladder } = this;
    if (!ladder) return;
    const isLadder = ladder.ladder_state === Ladder.LADDER_CONFIRMED;
    this.title.textContent = isLadder ? `Rungs, ${cm(ladder.spacing_m)} apart` : "Rungs, no ladder confirmed";
    const middle = (i) => (ladder.rung_z0_m[i] + ladder.rung_z1_m[i]) / 2;
    const order = [...ladder.rung_id.keys()].sort((a, b) => middle(b) - middle(a));
    this.body.replaceChildren(...order.map((i) => {
      const isTrusted = ladder.rung_state[i] === Ladder.RUNG_TRUSTED;
      const flags = flagsOf(Ladder, "FLAG_", ladder.rung_flags[i]).join(", ");
      const cells = [ladder.rung_id[i], cm(middle(i)), isTrusted ? "trusted" : "candidate", `${Math.round(ladder.rung_confidence[i] * 100)} %`,
        cm(lengthOf(ladder, i)), [flags, grasping(ladder, i)].filter(Boolean).join(", ")];
      return element("tr", { class: isTrusted ? "trusted" : "candidate" }, ...cells.map((cell) => element("td", {}, String(cell))));
    }));
  }

  forget() {
    this.ladder = undefined;
    this.title.textContent = "Rungs";
    this.body.replaceChildren();
  }
}
