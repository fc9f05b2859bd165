// SPDX-License-Identifier: BSD-3-Clause
// What the simulator knows: the ladder as built and the body where it truly is. Only to compare by eye; no service hears it.

import { BoxGeometry, EdgesGeometry, Group, LineBasicMaterial, LineSegments } from "three";
import { truth_t as Truth } from "../messages.js";
import { nameOf } from "../words.js";
import { Bars } from "./bars.js";

export const TRUTH_COLOR = "#d7b3ff";

export class TruthModel extends Group {
  constructor() {
    super();
    this.bars = new Bars();
    this.body = new LineSegments(new EdgesGeometry(new BoxGeometry(0.56, 0.2, 0.09)), new LineBasicMaterial({ color: TRUTH_COLOR }));
    this.body.visible = false;
    this.add(this.bars, this.body);
  }

  show(message) {
    const bar = (part, i, radius, hint) => ({
      from: ["x0", "y0", "z0"].map((name) => message[`${part}_${name}_m`][i]),
      to: ["x1", "y1", "z1"].map((name) => message[`${part}_${name}_m`][i]),
      radius,
      color: TRUTH_COLOR,
      opacity: 0.35,
      hint,
    });
    const rungs = [...message.rung_id.keys()].map((i) =>
      bar("rung", i, message.rung_radius_m[i], `truth: rung ${message.rung_id[i]}, ${nameOf(Truth, "RUNG_", message.rung_kind[i])}`));
    const rails = [...message.rail_x0_m.keys()].map((i) => bar("rail", i, message.rail_half_width_m[i], "truth: rail"));
    this.bars.show([...rungs, ...rails]);
    const [w, x, y, z] = message.q_odom_body;
    this.body.visible = true;
    this.body.position.set(...message.p_odom_body_m);
    this.body.quaternion.set(x, y, z, w);
  }

  hide() {
    this.bars.show([]);
    this.body.visible = false;
  }
}
