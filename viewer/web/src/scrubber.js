// SPDX-License-Identifier: BSD-3-Clause
// When a log is shown: play, pause, another place, another speed. All pages of one server see the same place.

import { element } from "./element.js";

const SPEEDS = [0.25, 0.5, 1, 2, 4, 8];
const clock = (s) => `${Math.floor(s / 60)}:${(s % 60).toFixed(1).padStart(4, "0")}`;

export class Scrubber {
  constructor(place, say) {
    this.place = place;
    this.button = element("button", { type: "button" });
    this.slider = element("input", { type: "range", min: 0, step: 0.1, "aria-label": "Place in the log" });
    this.words = element("output");
    this.speed = element("select", { "aria-label": "Speed" }, ...SPEEDS.map((speed) => element("option", { value: speed }, `${speed} x`)));
    place.append(this.button, this.slider, this.words, this.speed);
    this.button.onclick = () => say(this.isPlaying ? "pause" : "play");
    this.slider.oninput = () => {
      this.isHeld = true;
      this.words.textContent = clock(this.slider.valueAsNumber);
    };
    this.slider.onchange = () => {
      this.isHeld = false;
      say(`seek ${this.slider.value}`);
    };
    this.speed.onchange = () => say(`speed ${this.speed.value}`);
  }

  /** Whether the log was moved to another place since the status before. */
  jumped({ log }) {
    const hasJumped = log && this.seeks !== undefined && log.seeks !== this.seeks;
    this.seeks = log?.seeks;
    return hasJumped;
  }

  status({ log }) {
    this.place.hidden = !log;
    if (!log) return;
    this.isPlaying = log.playing;
    this.button.textContent = log.playing ? "Pause" : "Play";
    this.slider.max = log.length_s;
    this.speed.value = log.speed;
    if (this.isHeld) return;
    this.slider.value = log.at_s;
    this.words.textContent = `${clock(log.at_s)} of ${clock(log.length_s)}`;
  }
}
