// SPDX-License-Identifier: BSD-3-Clause
// The way to the server: messages come in, and the connection is made anew for as long as the page is open.

import { decode } from "./decode.js";

const AGAIN_MS = 1000;

export class Link {
  /** on: {message(channel, message, heardUs), status(object), connected(isConnected)} */
  constructor(on) {
    this.on = on;
    this.connect();
  }

  connect() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${location.host}/messages`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => this.on.connected(true);
    this.socket.onmessage = ({ data }) => this.take(data);
    this.socket.onclose = () => {
      this.on.connected(false);
      setTimeout(() => this.connect(), AGAIN_MS);
    };
  }

  take(data) {
    if (typeof data === "string") return this.on.status(JSON.parse(data));
    const view = new DataView(data);
    const message = decode(new DataView(data, 10));
    this.on.message(view.getInt16(8), message, Number(view.getBigInt64(0)));
  }

  /** To the log player; live, the server cuts off whoever speaks. */
  say(order) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(order);
  }
}
