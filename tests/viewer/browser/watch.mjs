// SPDX-License-Identifier: BSD-3-Clause
// What a person would look for, in Chromium:  node watch.mjs URL SECONDS    (called by tests/viewer/in_browser)
// For SECONDS the page must show rungs and lamps and stay less than half a second behind; then it waits for "restart" on
// standard input, must say that the connection is gone, and must show new messages again after "restarted".
import assert from "node:assert/strict";
import { createInterface } from "node:readline";
import { chromium } from "./chromium.mjs";

const [url, seconds] = process.argv.slice(2);
const MAX_BEHIND_MS = 500;
const words = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
const hear = async (word) => assert.equal((await words.next()).value, word);
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

const browser = await chromium();
const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
const errors = [];
page.on("pageerror", (error) => errors.push(error.message));
const others = new Set();
page.on("request", (request) => new URL(request.url()).host !== new URL(url).host && others.add(request.url()));
await page.goto(url);

const link = () => page.$eval("#link", (place) => ({ words: place.textContent, behindMs: Number(place.dataset.behindMs) }));
const received = async () => Number((await link()).words.match(/live, (\d+)/)?.[1] ?? 0);
await page.waitForFunction(() => document.querySelectorAll("#rungs tbody tr").length > 0, undefined, { timeout: 20_000 });
await page.waitForFunction(() => document.querySelectorAll("#lamps .lamp:not([data-state=off])").length > 0, undefined, { timeout: 20_000 });

let worstMs = 0;
const before = await received();
for (let i = 0; i < seconds; ++i) {
  await sleep(1000);
  if (i > 3) worstMs = Math.max(worstMs, (await link()).behindMs);
}
const rate = ((await received()) - before) / seconds;
console.log(`${seconds} s: ${rate.toFixed(0)} messages a second at the viewer, the page ${worstMs} ms behind at most`);
assert.ok(worstMs < MAX_BEHIND_MS, "the page falls behind");
assert.ok(rate > 0);

console.log("restart");
await hear("restart");
await page.waitForFunction(() => document.querySelector("#link").textContent.startsWith("no connection"), undefined, { timeout: 10_000 });
console.log("restarted?");
await hear("restarted");
await page.waitForFunction(() => /^live, [1-9]/.test(document.querySelector("#link").textContent), undefined, { timeout: 15_000 });
assert.deepEqual(errors, []);
assert.deepEqual([...others], [], "the page asked somebody else");
console.log("passed");
await browser.close();
process.exit(0);
