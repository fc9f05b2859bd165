// SPDX-License-Identifier: BSD-3-Clause
// Two plots over the last two minutes: how old the chain's results are when they are heard, and how often each comes.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { element } from "./element.js";
import { health_t as Health } from "./messages.js";

const WINDOW_S = 120;
const HEIGHT_PX = 105;
const LATENCIES = [["depth", "#7aa2f7"], ["cloud", "#9ece6a"], ["topology", "#e0af68"], ["rungs", "#f7768e"], ["controller", "#bb9af7"]];
const RATES = [["head 0", "#7aa2f7"], ["topology", "#e0af68"], ["rungs", "#f7768e"], ["controller", "#bb9af7"]];

/** A number per moment and curve; nothing where nothing was heard since the moment before. */
class Curves {
  constructor(place, title, unit, curves) {
    this.names = curves.map(([name]) => name);
    this.columns = [[], ...curves.map(() => [])];
    const axis = { stroke: "#8b93a7", grid: { stroke: "#2a2f3d" }, ticks: { stroke: "#2a2f3d" } };
    const figure = element("figure", {}, element("figcaption", {}, `${title} [${unit}]`));
    place.append(figure);
    this.plot = new uPlot({
      width: 380,
      height: HEIGHT_PX,
      cursor: { drag: { x: false, y: false }, points: { show: false } },
      axes: [{ ...axis, space: 60, size: 24, values: (_, ticks) => ticks.map((s) => `${Math.round(s - this.columns[0].at(-1))} s`) }, { ...axis, size: 40 }],
      scales: { x: { time: false }, y: { range: (_, low, high) => [0, Math.max(high ?? 1, 1) * 1.05] } },
      series: [{}, ...curves.map(([label, stroke]) => ({ label, stroke, width: 1.5, points: { show: false }, spanGaps: true, value: (_, v) => (v ?? this.newest(label))?.toFixed(0) ?? "-" }))],
    }, this.columns, figure);
    new ResizeObserver(() => this.plot.setSize({ width: figure.clientWidth, height: HEIGHT_PX })).observe(figure);
  }

  newest(name) {
    return this.columns[this.names.indexOf(name) + 1].at(-1);
  }

  add(s, values) {
    this.columns[0].push(s);
    this.names.forEach((name, i) => this.columns[i + 1].push(values[name] ?? null));
    while (s - this.columns[0][0] > WINDOW_S) this.columns.forEach((column) => column.shift());
    this.plot.setData(this.columns);
  }

  forget() {
    this.columns.forEach((column) => column.splice(0));
    this.plot.setData(this.columns);
  }
}

/** Messages per second of a sender, from its own count: what was not passed on to this page counts too. */
class Rate {
  take(message) {
    this.last = message;
  }

  perSecond() {
    const { first, last } = this;
    this.first = last;
    if (!first || !last || last.utime <= first.utime || last.seq <= first.seq) return undefined;
    return Number(last.seq - first.seq) / (Number(last.utime - first.utime) / 1e6);
  }
}

export class Plots {
  constructor(place) {
    this.latencies = new Curves(place, "age when heard", "ms", LATENCIES);
    this.rates = new Curves(place, "rate", "1/s", RATES);
    this.forget();
  }

  forget() {
    this.worst = {};
    this.rate = Object.fromEntries(RATES.map(([name]) => [name, new Rate()]));
    this.latencies.forget();
    this.rates.forget();
    this.nowUs = 0;
  }

  /** The oldest since the last point of the curve. */
  note(name, us, heardUs) {
    this.nowUs = Math.max(this.nowUs, heardUs);
    this.worst[name] = Math.max(this.worst[name] ?? 0, us / 1000);
  }

  noteAge(name, message, heardUs) {
    this.note(name, heardUs - Number(message.utime), heardUs);
    this.rate[name]?.take(message);
  }

  tof_frame_t(message, heardUs) {
    this.noteAge("depth", message, heardUs);
    if (message.head === 0) this.rate["head 0"].take(message);
  }

  topology_t(message, heardUs) {
    this.noteAge("topology", message, heardUs);
  }

  ladder_t(message, heardUs) {
    this.noteAge("rungs", message, heardUs);
  }

  climb_state_t(message, heardUs) {
    this.nowUs = Math.max(this.nowUs, heardUs);
    this.rate.controller.take(message);
  }

  /** Clouds are not sent here: gng_service says how old they are when it begins; the controller says it of rungs. */
  health_t(message, heardUs) {
    const age = (channel) => message.input_age_p50_us[message.input_channel.indexOf(channel)] ?? -1;
    if (message.service === Health.SERVICE_GNG && age(Health.CHANNEL_CLOUD) >= 0) this.note("cloud", age(Health.CHANNEL_CLOUD), heardUs);
    if (message.service === Health.SERVICE_CLIMB && age(Health.CHANNEL_RUNGS) >= 0) this.note("controller", age(Health.CHANNEL_RUNGS), heardUs);
  }

  refresh() {
    const s = this.nowUs / 1e6;
    const times = this.latencies.columns[0];
    if (s === 0 || s <= (times.at(-1) ?? 0)) return;
    this.latencies.add(s, this.worst);
    this.worst = {};
    this.rates.add(s, Object.fromEntries(Object.entries(this.rate).map(([name, rate]) => [name, rate.perSecond()])));
  }
}
