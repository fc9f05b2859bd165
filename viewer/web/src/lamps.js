// SPDX-License-Identifier: BSD-3-Clause
// A lamp per service, from LADDER_HEALTH: green works, blue waits for input, yellow degraded or losing messages, red silent for two seconds.
// docs/OPERATION.md ("Viewer") says what to do about each.

import { element } from "./element.js";
import { health_t as Health } from "./messages.js";
import { flagsOf, nameOf } from "./words.js";

const SILENT_MS = 2000;
const SERVICES = [Health.SERVICE_SENSOR, Health.SERVICE_GNG, Health.SERVICE_LADDER, Health.SERVICE_CLIMB];
const sum = (counts) => counts.reduce((total, count) => total + Number(count), 0);

/** What is the matter with a service, in words; nothing when all is well. */
function troubles(message, before) {
  const found = flagsOf(Health, "FLAG_", message.flags);
  if (!before) return found;
  const lost = sum(message.input_lost) - sum(before.input_lost);
  const rejected = sum(message.input_rejected) - sum(before.input_rejected);
  if (lost > 0) found.push(`${lost} messages lost`);
  if (rejected > 0) found.push(`${rejected} messages refused`);
  return found;
}

class Lamp {
  constructor(service) {
    this.light = element("i", { class: "lamp" });
    this.words = element("span");
    this.root = element("div", { class: "service" }, this.light, element("b", {}, nameOf(Health, "SERVICE_", service)), this.words);
    this.show("off", "not heard");
  }

  take(message) {
    const isSameProcess = this.message?.pid === message.pid;
    this.troubles = troubles(message, isSameProcess ? this.message : undefined);
    this.message = message;
    this.heardMs = performance.now();
  }

  show(state, words) {
    this.light.dataset.state = state;
    this.words.textContent = words;
  }

  refresh() {
    if (!this.message) return;
    const silentMs = performance.now() - this.heardMs;
    const { state } = this.message;
    const age = this.message.input_age_p99_us.length ? Math.max(...this.message.input_age_p99_us) : -1;
    if (silentMs > SILENT_MS) this.show("bad", `silent for ${Math.round(silentMs / 1000)} s`);
    else if (this.troubles.length) this.show("poor", this.troubles.join(", "));
    else if (state === Health.STATE_WORKING) this.show("good", age < 0 ? "works" : `works, input ${(age / 1000).toFixed(0)} ms old at most`);
    else if (state === Health.STATE_DEGRADED) this.show("poor", "degraded");
    else this.show("wait", nameOf(Health, "STATE_", state));
  }
}

export class Lamps {
  constructor(place) {
    this.place = place;
    this.lamps = new Map();
    SERVICES.forEach((service) => this.lamp(service));
  }

  lamp(service) {
    if (!this.lamps.has(service)) {
      this.lamps.set(service, new Lamp(service));
      this.place.append(this.lamps.get(service).root);
    }
    return this.lamps.get(service);
  }

  health_t(message) {
    this.lamp(message.service).take(message);
  }

  refresh() {
    this.lamps.forEach((lamp) => lamp.refresh());
  }

  forget() {
    this.lamps.forEach((lamp) => {
      lamp.message = undefined;
      lamp.show("off", "not heard");
    });
  }
}
