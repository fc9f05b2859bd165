// SPDX-License-Identifier: BSD-3-Clause
// The controller's state in one line, at the top of the page.

import { climb_state_t as Climb } from "./messages.js";
import { nameOf } from "./words.js";

const LEGS = ["FL", "FR", "RL", "RR"];
const SILENT_MS = 1000;
export const CALM = new Set([Climb.STATE_HOLD, Climb.STATE_CLIMBING, Climb.STATE_PAUSED, Climb.STATE_DISARMED]);
export const STOPPED = new Set([Climb.STATE_FAULT_HOLD, Climb.STATE_ESTOP]);

export class ClimbState {
  constructor(place) {
    this.place = place;
    this.heardMs = 0;
  }

  climb_state_t(message) {
    this.heardMs = performance.now();
    this.message = message;
  }

  refresh() {
    if (!this.message) return;
    const { state, reason, limb_state: limbs, refusal, burden } = this.message;
    const isSilent = performance.now() - this.heardMs > SILENT_MS;
    const why = reason > Climb.REASON_NONE ? `: ${nameOf(Climb, "REASON_", reason)}` : "";
    const legs = LEGS.map((leg, i) => [leg, limbs[i]])
      .filter(([, limb]) => limb > Climb.LIMB_LOADED)
      .map(([leg, limb]) => `${leg} ${nameOf(Climb, "LIMB_", limb)}`);
    if (state === Climb.STATE_CLIMBING && legs.length === 0) {
      if (refusal > Climb.REFUSAL_NONE) legs.push(`no grasp: ${nameOf(Climb, "REFUSAL_", refusal)}`);
      if (burden > Climb.BURDEN_BORNE) legs.push(`no limb may be lifted: ${nameOf(Climb, "BURDEN_", burden)}`);
    }
    this.place.textContent = isSilent ? "controller silent" : `${nameOf(Climb, "STATE_", state)}${why}${legs.length ? " - " + legs.join(", ") : ""}`;
    this.place.dataset.state = isSilent || STOPPED.has(state) ? "bad" : CALM.has(state) ? "good" : "poor";
  }

  forget() {
    this.message = undefined;
    this.place.textContent = "no controller";
    delete this.place.dataset.state;
  }
}
