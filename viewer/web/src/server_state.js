// SPDX-License-Identifier: BSD-3-Clause
// Whether the page hears its server, keeps pace with it, and what the server says of itself.

const FAR_BEHIND_MS = 1000;

export class ServerState {
  constructor(place) {
    this.place = place;
    this.forget();
  }

  forget() {
    this.leastMs = Infinity; // difference of the two clocks and the shortest way
  }

  heard(us) {
    const agoMs = Date.now() - us / 1000;
    this.leastMs = Math.min(this.leastMs, agoMs);
    this.behindMs = agoMs - this.leastMs;
    this.place.dataset.behindMs = Math.round(this.behindMs);
  }

  connected(isConnected) {
    this.place.dataset.state = isConnected ? "good" : "bad";
    if (!isConnected) this.place.textContent = "no connection, trying again";
  }

  status({ received, rejected, log }) {
    const refused = rejected ? `, ${rejected} refused` : "";
    const behind = this.behindMs > FAR_BEHIND_MS ? `, this page is ${(this.behindMs / 1000).toFixed(1)} s behind` : "";
    this.place.textContent = log ? "log" : `live, ${received} messages${refused}${behind}`;
    this.place.dataset.state = rejected ? "poor" : "good";
    if (log?.damaged) {
      this.place.textContent = "log, damaged: shown up to the first damage";
      this.place.dataset.state = "poor";
    }
  }
}
