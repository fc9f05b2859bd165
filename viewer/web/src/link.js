// SPDX-License-Identifier: BSD-3-Clause
// The way to the server: messages come in, and the connection is made anew for as long as the page is open. What comes is only put down;
// deliver() reads it, once per picture. So a slow computer draws less often, but what it draws is the newest.

import { decode } from "./decode.js";
import { health_t as Channel } from "./messages.js";

const AGAIN_MS = 1000;
const HEAD_BYTES = 10; // when it was heard, channel number
/** Of these every message counts; of the others the newest. */
const EVERY = new Set([Channel.CHANNEL_EVENT, Channel.CHANNEL_HEALTH, Channel.CHANNEL_CLIMB, Channel.CHANNEL_COMMAND]);
const MAX_WAITING = 500;

export class Link {
  /** on: {message(channel, message, heardUs), status(object), connected(isConnected)} */
  constructor(on) {
    this.on = on;
    this.waiting = [];
    this.newest = new Map();
    this.connect();
  }

  connect() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${location.host}/messages`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => this.on.connected(true);
    this.socket.onmessage = ({ data }) => this.putDown(data);
    this.socket.onclose = () => {
      this.on.connected(false);
      setTimeout(() => this.connect(), AGAIN_MS);
    };
  }

  putDown(data) {
    if (typeof data === "string") return this.on.status(JSON.parse(data));
    const channel = new DataView(data).getInt16(8);
    if (!EVERY.has(channel)) return this.newest.set(channel, data);
    this.waiting.push(data);
    if (this.waiting.length > MAX_WAITING) this.waiting.shift();
  }

  deliver() {
    const all = [...this.waiting, ...this.newest.values()];
    this.waiting.length = 0;
    this.newest.clear();
    for (const data of all) {
      const head = new DataView(data, 0, HEAD_BYTES);
      this.on.message(head.getInt16(8), decode(new DataView(data, HEAD_BYTES)), Number(head.getBigInt64(0)));
    }
  }

  /** To the log player; live, the server cuts off whoever speaks. */
  say(order) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(order);
  }
}
