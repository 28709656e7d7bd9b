// SPDX-License-Identifier: BSD-3-Clause
// A Chromium of its own with an empty profile, driven by playwright-core; WebGL in software.
import fs from "node:fs";
import { createRequire } from "node:module";
import os from "node:os";
import path from "node:path";

const ROOT = path.resolve(import.meta.dirname, "../..");
const require = createRequire(path.join(ROOT, "build/page/npm/package.json"));
const { chromium } = require("playwright-core");
const FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const PROGRAMS = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

export const PAGE = path.join(ROOT, "build/page/nanotouch-touch.html");
export const FILE = `file://${PAGE}`;

export async function open({ width = 1440, height = 900, offline = false, touch = false } = {}) {
  const program = PROGRAMS.find((one) => fs.existsSync(one));
  if (!program) throw new Error("there is no chromium");
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), "nanotouch-page-"));
  const context = await chromium.launchPersistentContext(profile, { executablePath: program, headless: true, args: FLAGS,
    viewport: { width, height }, offline, hasTouch: touch });
  const close = async () => {
    await context.close();
    fs.rmSync(profile, { recursive: true, force: true });
  };
  return { context, close };
}

// A page with what it says and asks for on the way.
export async function visit(context, address) {
  const page = await context.newPage(), said = [], requests = [];
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) said.push(message.text()); });
  page.on("pageerror", (error) => said.push(String(error)));
  context.on("request", (request) => requests.push(request.url()));
  page.on("websocket", (socket) => requests.push(socket.url()));
  await page.goto(address);
  return { page, said, requests };
}

// Until something that the page counts is so; on a loaded machine that may take long.
export function until(page, what, argument) {
  const broken = page.waitForEvent("pageerror", { timeout: 0 }).then((error) => { throw error; }); // a page that fails is not waited for
  broken.catch(() => {});
  return Promise.race([page.waitForFunction(what, argument, { timeout: 120000, polling: 100 }), broken]);
}
export const touched = (page) => until(page, () => window.nanotouch?.seen.now && window.nanotouch.seen.law && window.nanotouch.counters.draws > 2);
// The page has drawn again, so many times.
export async function later(page, draws) {
  const before = await value(page, () => window.nanotouch.counters.draws);
  await until(page, (wanted) => window.nanotouch.counters.draws >= wanted, before + draws);
}
// It begins with one slider and one chart; this shows all sliders, charts and buttons.
export async function all(page) {
  await page.focus("#view");
  await page.keyboard.press("d");
  await until(page, () => document.body.classList.contains("all"));
}
export const value = (page, what, argument) => page.evaluate(what, argument);
