// SPDX-License-Identifier: BSD-3-Clause
// Debian's Chromium without a screen; WebGL in software.
import { chromium as playwright } from "playwright-core";

const OPTIONS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];

export const chromium = () => playwright.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: OPTIONS });
