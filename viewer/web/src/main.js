// SPDX-License-Identifier: BSD-3-Clause
// Puts the page together. Each view has a method per message type it shows (view.health_t(message, heardUs, channel)), and may have
// draw() for every picture and refresh() for what changes twice a second. No view knows another.

import "./page.css";
import { ClimbState } from "./climb_state.js";
import { DepthImages } from "./depth_images.js";
import { Lamps } from "./lamps.js";
import { Link } from "./link.js";
import { Plots } from "./plots.js";
import { RungTable } from "./rung_table.js";
import { Scene } from "./scene/scene.js";
import { Scrubber } from "./scrubber.js";
import { ServerState } from "./server_state.js";
import { Timeline } from "./timeline.js";

const REFRESH_MS = 500;
const place = (id) => document.getElementById(id);

const server = new ServerState(place("link"));
const scrubber = new Scrubber(place("scrubber"), (order) => link.say(order));
const views = [
  server,
  scrubber,
  new ClimbState(place("climb")),
  new Scene(place("scene"), place("legend"), place("layers"), place("hint")),
  new Lamps(place("lamps")),
  new DepthImages(place("depth")),
  new Plots(place("plots")),
  new RungTable(place("rungs")),
  new Timeline(place("timeline")),
];
const tell = (what, ...words) => views.forEach((view) => view[what]?.(...words));

const link = new Link({
  message: (channel, message, heardUs) => {
    server.heard(heardUs);
    tell(message.type, message, heardUs, channel);
  },
  status: (status) => {
    if (scrubber.jumped(status)) tell("forget"); // another place in the log: curves and lists begin anew
    tell("status", status);
  },
  connected: (isConnected) => tell("connected", isConnected),
});

function draw() {
  link.deliver();
  tell("draw");
  requestAnimationFrame(draw);
}
draw();
setInterval(() => tell("refresh"), REFRESH_MS);
