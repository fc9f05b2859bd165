// SPDX-License-Identifier: BSD-3-Clause
// A picture of a running viewer:  node shot.mjs URL OUT.png [SECONDS]
import { chromium } from "./chromium.mjs";

const [url, out, seconds = "8"] = process.argv.slice(2);
const browser = await chromium();
const page = await browser.newPage({ viewport: { width: 1440, height: 860 } });
page.on("console", (message) => message.type() === "error" && console.error(message.text()));
page.on("pageerror", (error) => console.error(error.message));
await page.goto(url);
await page.waitForTimeout(1000 * Number(seconds));
await page.screenshot({ path: out, ...(out.endsWith(".jpg") ? { quality: 85 } : {}) });
await browser.close();
