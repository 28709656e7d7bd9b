// SPDX-License-Identifier: BSD-3-Clause
// `nanotouch live --browser` in Chromium: one page touches, others watch; also through a tunnel with another port.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import path from "node:path";
import { after, before, test } from "node:test";
import { open, PAGE, touched, until, value, visit } from "./browser.mjs";
import { tunnel } from "./tunnel.mjs";

const NANOTOUCH = path.resolve(import.meta.dirname, "../../.venv/bin/nanotouch");
let chromium, server, links;

before(async () => {
  chromium = await open();
  server = spawn(NANOTOUCH, ["live", "--browser", "--page", PAGE], { stdio: ["ignore", "pipe", "inherit"] });
  links = await new Promise((done, failed) => {
    let said = "";
    server.stdout.on("data", (data) => {
      said += data;
      const found = said.match(/http:\S+/g) ?? [];
      if (found.length === 2 && said.includes("Ctrl-C")) done(found);
    });
    server.on("exit", () => failed(new Error(`it has ended: ${said}`)));
  });
});
after(async () => {
  server.removeAllListeners("exit");
  server.kill("SIGINT");
  await chromium.close();
});

async function scroll(page, what) {
  const { x, y } = await page.locator("#view").boundingBox();
  await page.mouse.move(x + 300, y + 200);
  for (let i = 0; i < 600 && !(await value(page, what)); ++i) {
    await page.mouse.wheel(0, 60);
    await page.waitForTimeout(30);
  }
}
const pressed = () => window.nanotouch.seen.now.force > 5e-8;
const noted = (page, words) => until(page, (wanted) => window.nanotouch.seen.notes.some(({ text }) => text.includes(wanted)), words);

test("one page touches through a tunnel, the other watches the same", async (context) => {
  const port = Number(new URL(links[0]).port);
  const way = await tunnel(port);
  context.diagnostic(`through ${way.kind}`);
  context.after(() => way.close());
  const through = links[0].replace(/\/\/[^/]+/, `//localhost:${way.port}`);
  const { page, requests } = await visit(chromium.context, through);
  await touched(page);
  const watching = await visit(chromium.context, links[1]);
  await touched(watching.page);
  await page.bringToFront();
  await scroll(page, pressed);
  assert.ok(await value(page, pressed));
  await until(watching.page, pressed);
  const { bytes, updates } = await value(page, () => window.nanotouch.counters);
  assert.ok(bytes / updates <= 200, `${bytes / updates}`);
  assert.deepEqual(requests.filter((url) => !/^(blob|data):|\/\/(localhost|127\.0\.0\.1):/.test(url)), []);
  assert.ok(requests.every((url) => !url.includes("key=") || url.includes("#key="))); // never sent

  await watching.page.bringToFront();
  await watching.page.mouse.move(300, 300);
  await watching.page.mouse.wheel(0, -500);
  await noted(watching.page, "watches");

  const second = await visit(chromium.context, links[0]); // another origin: it has not the token
  await noted(second.page, "operates once");
  const wrong = await visit(chromium.context, links[0].replace(/key=.*/, "key=wrong"));
  await noted(wrong.page, "wrong key");
  await second.page.close();
  await wrong.page.close();

  await page.bringToFront();
  await page.reload(); // the same page may come again
  await touched(page);
  const force = await value(page, () => window.nanotouch.seen.now.sequence);
  await until(page, (old) => window.nanotouch.seen.now.sequence > old, force);
  await page.locator("[data-own=c]").click();
  await page.locator(".cards button", { hasText: "Mica in dry air" }).click();
  await until(watching.page, () => window.nanotouch.seen.world?.title === "Mica in dry air" && window.nanotouch.seen.law);

  server.removeAllListeners("exit");
  server.kill("SIGINT");
  await until(page, () => window.nanotouch.seen.stale && window.nanotouch.seen.force === 0);
  await noted(page, "ended");
});
