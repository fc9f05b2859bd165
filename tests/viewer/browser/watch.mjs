// SPDX-License-Identifier: BSD-3-Clause
// What a person would look for, in Chromium:  node watch.mjs URL SECONDS    (called by tests/viewer/in_browser)
// For SECONDS topologies of 1000 nodes must come 20 times a second, rungs and lamps must be shown, and what is drawn must never be half a second
// old. Then it asks for "restart" on standard output, must say that the connection is gone, and, after "restarted" came on standard input, must
// show new messages again.
import assert from "node:assert/strict";
import { createInterface } from "node:readline";
import { decode } from "../../../viewer/web/src/decode.js";
import { health_t as Channel } from "../../../viewer/web/src/messages.js";
import { chromium } from "./chromium.mjs";

const [url, seconds] = process.argv.slice(2);
const HEAD_BYTES = 10; // of the viewer, before each message
const WARM_UP_S = 5; // the page compiles its shaders, the topology grows
const MAX_BEHIND_MS = 500;
const MIN_TOPOLOGIES_PER_S = 19;
const MIN_NODES = 990;
const PATIENCE = { timeout: 60_000, polling: 200 };
const words = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
const hear = async (word) => assert.equal((await words.next()).value, word);
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** In the page, before its own code: counts messages per channel and drawn pictures, keeps the newest topology. */
function count(topologyChannel) {
  window.counted = { messages: {}, pictures: 0 };
  window.WebSocket = class extends WebSocket {
    constructor(...words) {
      super(...words);
      this.addEventListener("message", ({ data }) => {
        if (typeof data === "string") return;
        const channel = new DataView(data).getInt16(8);
        window.counted.messages[channel] = (window.counted.messages[channel] ?? 0) + 1;
        if (channel === topologyChannel) window.topology = data;
      });
    }
  };
  const draw = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (then) => draw((ms) => (++window.counted.pictures, then(ms)));
}

const browser = await chromium();
const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
const errors = [];
page.on("pageerror", (error) => errors.push(error.message));
const others = new Set();
page.on("request", (request) => new URL(request.url()).host !== new URL(url).host && others.add(request.url()));
await page.addInitScript(count, Channel.CHANNEL_TOPOLOGY);
await page.goto(url);

const counted = () => page.evaluate(() => ({ ...window.counted, behindMs: Number(document.querySelector("#link").dataset.behindMs) }));
const numNodes = async () => {
  const bytes = Uint8Array.from(await page.evaluate(() => Array.from(new Uint8Array(window.topology))));
  return decode(new DataView(bytes.buffer, HEAD_BYTES)).num_nodes;
};
await page.waitForFunction(() => document.querySelectorAll("#rungs tbody tr").length > 0, undefined, PATIENCE);
await page.waitForFunction(() => document.querySelectorAll("#lamps .lamp:not([data-state=off])").length > 0, undefined, PATIENCE);
await sleep(1000 * WARM_UP_S);

const [before, beganMs] = [await counted(), performance.now()];
let worstMs = 0;
for (let second = 0; second < seconds; ++second) {
  await sleep(1000);
  worstMs = Math.max(worstMs, (await counted()).behindMs);
}
const [after, tookS] = [await counted(), (performance.now() - beganMs) / 1000];
const perSecond = (of) => (of(after) - of(before)) / tookS;
const topologies = perSecond((all) => all.messages[Channel.CHANNEL_TOPOLOGY] ?? 0);
const all = perSecond(({ messages }) => Object.values(messages).reduce((sum, number) => sum + number, 0));
const nodes = await numNodes();
console.log(`${tookS.toFixed(1)} s: ${topologies.toFixed(1)} topologies a second of ${nodes} nodes, ${all.toFixed(0)} messages a second in all, ` +
  `${perSecond(({ pictures }) => pictures).toFixed(0)} pictures a second, what is drawn ${worstMs} ms behind at most`);
assert.ok(worstMs < MAX_BEHIND_MS, `the page falls behind: ${worstMs} ms`); // also when it is not a number
assert.ok(topologies >= MIN_TOPOLOGIES_PER_S, "topologies come too seldom");
assert.ok(nodes >= MIN_NODES, "too few nodes");

console.log("restart");
await page.waitForFunction(() => document.querySelector("#link").textContent.startsWith("no connection"), undefined, PATIENCE);
console.log("restarted?");
await hear("restarted");
const gone = await counted();
const isBack = (number) => /^live, [1-9]/.test(document.querySelector("#link").textContent) && window.counted.messages[number.channel] > number.before;
await page.waitForFunction(isBack, { channel: Channel.CHANNEL_TOPOLOGY, before: gone.messages[Channel.CHANNEL_TOPOLOGY] }, PATIENCE);
console.log("the page is back after the viewer was started anew");
assert.deepEqual(errors, []);
assert.deepEqual([...others], [], "the page asked somebody else");
await browser.close();
console.log("passed");
process.exit(0);
