// SPDX-License-Identifier: BSD-3-Clause
// `nanotouch live rig.toml --browser` in Chromium: a stage that calls itself real is led from a page, watched from
// another, and recorded meanwhile.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { open, PAGE, touched, until, value, visit } from "./browser.mjs";

const ROOT = path.resolve(import.meta.dirname, "../.."), NANOTOUCH = path.join(ROOT, ".venv/bin/nanotouch");
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "nanotouch-watched-")), record = path.join(folder, "touch.mcap");
let chromium, server, links, said = "";

before(async () => {
  execFileSync("cc", ["-std=c11", "-O1", "-fPIC", "-shared", "-D_POSIX_C_SOURCE=200809L", `-I${ROOT}/libnanotouch/include`, "-o",
    path.join(folder, "stage.so"), path.join(ROOT, "tests/c/real_backend.c")]);
  fs.writeFileSync(path.join(folder, "rig.toml"), "[stage]\naxes = 1\n[slave]\nbackend = 'shared_object'\npath = 'stage.so'\n");
  chromium = await open();
  server = spawn(NANOTOUCH, ["live", path.join(folder, "rig.toml"), "--allow-code", "--browser", "--page", PAGE, "--record", record],
    { stdio: ["ignore", "pipe", "inherit"] });
  links = await new Promise((done, failed) => {
    server.stdout.on("data", (data) => {
      said += data;
      const found = said.match(/http:\S+/g) ?? [];
      if (found.length === 2 && said.endsWith("Ctrl-C ends the session.\n")) done(found);
    });
    server.on("exit", () => failed(new Error(`it has ended: ${said}`)));
  });
});
after(async () => {
  server.kill("SIGINT");
  await chromium.close();
  fs.rmSync(folder, { recursive: true, force: true });
});

test("a real stage is led from one page and watched from another", async () => {
  assert.match(said, /hard pace, for its slave is real: .*; your mouse leads the hand/);
  const { page } = await visit(chromium.context, links[0]);
  await touched(page);
  assert.ok(await value(page, () => document.body.classList.contains("watched") && window.nanotouch.seen.blind));
  assert.equal(await page.locator("[data-own=t]").isVisible(), false);
  const from = await value(page, () => window.nanotouch.seen.now.master[2]);
  const { x, y } = await page.locator("#view").boundingBox();
  await page.mouse.move(x + 300, y + 200);
  for (let i = 0; i < 100 && (await value(page, () => window.nanotouch.seen.now.master[2])) < from + 1e-5; ++i) {
    await page.mouse.wheel(0, 100);
    await page.waitForTimeout(50);
  }
  const watching = await visit(chromium.context, links[1]);
  await touched(watching.page);
  await until(watching.page, (start) => window.nanotouch.seen.now.master[2] > start + 1e-5, from);
  assert.equal(await value(watching.page, () => Number.isFinite(window.nanotouch.seen.now.force)), true); // of the lever
  if (process.env.SHOT) await page.screenshot({ path: process.env.SHOT });
  server.removeAllListeners("exit");
  const ended = new Promise((done) => { server.on("exit", done); });
  server.kill("SIGINT");
  assert.equal(await ended, 130);
  await until(page, () => window.nanotouch.seen.stale);
  assert.ok(fs.statSync(record).size > 10000);
});
