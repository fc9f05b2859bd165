// SPDX-License-Identifier: BSD-3-Clause
// Whether the page hears its server, and what the server says of itself.

export class ServerState {
  constructor(place) {
    this.place = place;
    this.numMessages = 0;
  }

  connected(isConnected) {
    this.place.dataset.state = isConnected ? "good" : "bad";
    if (!isConnected) this.place.textContent = "no connection, trying again";
  }

  status({ received, rejected, missed, log }) {
    const refused = rejected ? `, ${rejected} refused` : "";
    const skipped = missed ? `, ${missed} skipped here` : "";
    this.place.textContent = log ? "log" : `live, ${received} messages${refused}${skipped}`;
    this.place.dataset.state = rejected ? "poor" : "good";
    if (log?.damaged) {
      this.place.textContent = "log, damaged: shown up to the first damage";
      this.place.dataset.state = "poor";
    }
  }
}
