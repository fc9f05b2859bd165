// SPDX-License-Identifier: BSD-3-Clause
// What happened, the newest on top: events of all services, changes of the controller's state, services that came back as another process.

import { element } from "./element.js";
import { climb_state_t as Climb, event_t as Event, health_t as Health } from "./messages.js";
import { STOPPED } from "./climb_state.js";
import { nameOf, timeOfDay } from "./words.js";

const MAX_LINES = 300;
const LEVELS = { [Event.LEVEL_WARNING]: "poor", [Event.LEVEL_ERROR]: "bad" };

export class Timeline {
  constructor(place) {
    this.list = element("ol");
    place.append(element("h2", {}, "What happened"), this.list);
    this.forget();
  }

  forget() {
    this.known = new Set(); // events that were shown: a server gives its last ones again to whoever comes back
    this.pids = new Map();
    this.state = undefined;
    this.list.replaceChildren();
  }

  add(us, who, level, text) {
    const line = element("li", { "data-state": level }, element("time", {}, timeOfDay(us)), element("b", {}, who), element("span", {}, text));
    line.us = us;
    const after = [...this.list.children].find((other) => other.us <= us);
    this.list.insertBefore(line, after ?? null);
    while (this.list.children.length > MAX_LINES) this.list.lastChild.remove();
  }

  event_t(message) {
    const key = `${message.service} ${message.seq} ${message.utime}`;
    if (this.known.has(key)) return;
    if (this.known.size > 10 * MAX_LINES) this.known.clear();
    this.known.add(key);
    this.add(Number(message.utime), nameOf(Health, "SERVICE_", message.service), LEVELS[message.level] ?? "good", message.text);
  }

  climb_state_t(message) {
    const state = `${message.state} ${message.reason}`;
    if (state === this.state) return;
    this.state = state;
    const why = message.reason > Climb.REASON_NONE ? `: ${nameOf(Climb, "REASON_", message.reason)}` : "";
    const level = STOPPED.has(message.state) ? "bad" : message.state === Climb.STATE_PROTECTIVE_HOLD ? "poor" : "good";
    this.add(Number(message.utime), "climb", level, nameOf(Climb, "STATE_", message.state).toUpperCase() + why);
  }

  health_t(message) {
    const before = this.pids.get(message.service);
    this.pids.set(message.service, message.pid);
    if (before === undefined || before === message.pid) return;
    this.add(Number(message.utime), nameOf(Health, "SERVICE_", message.service), "poor", `started anew, process ${message.pid}`);
  }
}
