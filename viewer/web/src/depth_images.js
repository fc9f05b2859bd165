// SPDX-License-Identifier: BSD-3-Clause
// The four depth images: near is bright, far is dark, no return is blue.

import { element } from "./element.js";

const SILENT_MS = 2000;
const NO_RETURN = [20, 30, 70];

class DepthImage {
  constructor(head) {
    this.canvas = element("canvas");
    this.words = element("figcaption", {}, `head ${head}: nothing`);
    this.root = element("figure", {}, this.canvas, this.words);
    this.head = head;
  }

  take(frame) {
    this.frame = frame;
    this.isNew = true;
    this.heardMs = performance.now();
  }

  draw() {
    if (!this.isNew) return;
    this.isNew = false;
    const { width_px: width, height_px: height, depth_mm: depth, range_max_m: range } = this.frame;
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    const context = this.canvas.getContext("2d");
    const image = context.createImageData(width, height);
    const far = 1 / (range * 1000);
    for (let i = 0, at = 0; i < depth.length; ++i, at += 4) {
      const grey = depth[i] > 0 ? Math.max(25, 255 * (1 - depth[i] * far) ** 2) : -1;
      image.data[at] = grey < 0 ? NO_RETURN[0] : grey;
      image.data[at + 1] = grey < 0 ? NO_RETURN[1] : grey * 0.95;
      image.data[at + 2] = grey < 0 ? NO_RETURN[2] : grey * 0.85;
      image.data[at + 3] = 255;
    }
    context.putImageData(image, 0, 0);
  }

  refresh() {
    if (!this.frame) return;
    const isSilent = performance.now() - this.heardMs > SILENT_MS;
    this.words.textContent = `head ${this.head}: ${isSilent ? "silent" : `up to ${this.frame.range_max_m.toFixed(1)} m`}`;
    this.root.classList.toggle("silent", isSilent);
  }
}

export class DepthImages {
  constructor(place) {
    this.images = [0, 1, 2, 3].map((head) => new DepthImage(head));
    place.append(...this.images.map((image) => image.root));
  }

  tof_frame_t(frame) {
    this.images[frame.head]?.take(frame);
  }

  draw() {
    this.images.forEach((image) => image.draw());
  }

  refresh() {
    this.images.forEach((image) => image.refresh());
  }
}
