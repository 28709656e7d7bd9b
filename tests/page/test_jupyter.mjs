// SPDX-License-Identifier: BSD-3-Clause
// The widget in a JupyterLab as people have it: a cell shows the page, a hand touches, the kernel is restarted, and the
// same cell touches again. JUPYTER names the program (jupyter-lab of an environment with nanotouch[notebook]); without
// one the test is skipped.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import fs from "node:fs";
import net from "node:net";
import os from "node:os";
import path from "node:path";
import { test } from "node:test";
import { open, PAGE } from "./browser.mjs";

const LONG = { timeout: 180000 }, TOKEN = "touch";

function program() {
  const here = path.resolve(import.meta.dirname, "../../.venv/bin/jupyter-lab");
  if (process.env.JUPYTER) return process.env.JUPYTER;
  if (fs.existsSync(here)) return here;
  try {
    return execFileSync("which", ["jupyter-lab"], { encoding: "utf8" }).trim();
  } catch {
    return "";
  }
}

const freePort = () => new Promise((done) => {
  const server = net.createServer().listen(0, "127.0.0.1", () => {
    const { port } = server.address();
    server.close(() => done(port));
  });
});

test("a cell shows the page, a hand touches, a restarted kernel touches again", { skip: program() ? false : "there is no jupyter-lab" }, async (context) => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "nanotouch-jupyter-")), port = await freePort();
  const source = ["from nanotouch_app.browser.widget import Touch\n", `touch = Touch("silicon_in_air", page=${JSON.stringify(PAGE)})\n`, "touch"];
  fs.writeFileSync(path.join(folder, "touch.ipynb"), JSON.stringify({ nbformat: 4, nbformat_minor: 5, cells: [{ cell_type: "code", id: "a",
    execution_count: null, metadata: {}, outputs: [], source }],
    metadata: { kernelspec: { display_name: "Python 3", language: "python", name: "python3" } } }));
  const jupyter = spawn(program(), ["--no-browser", "--allow-root", "--ip=127.0.0.1", `--port=${port}`, `--IdentityProvider.token=${TOKEN}`,
    `--ServerApp.root_dir=${folder}`], { stdio: ["ignore", "ignore", "pipe"], env: { ...process.env, JUPYTER_CONFIG_DIR: folder, JUPYTER_DATA_DIR: folder } });
  const chromium = await open();
  context.after(async () => {
    await chromium.close();
    const ended = new Promise((done) => jupyter.on("exit", done));
    jupyter.kill("SIGTERM");
    await ended;
    fs.rmSync(folder, { recursive: true, force: true });
  });
  await new Promise((done, failed) => {
    let said = "";
    jupyter.stderr.on("data", (data) => {
      said += data;
      if (said.includes(`127.0.0.1:${port}/lab`)) done();
    });
    jupyter.on("exit", () => failed(new Error(said)));
  });
  const page = await chromium.context.newPage(), server = `http://127.0.0.1:${port}`, heard = { headers: { Authorization: `token ${TOKEN}` } };
  await page.goto(`${server}/doc/tree/touch.ipynb?token=${TOKEN}`);
  await page.locator(".jp-Notebook-cell").first().waitFor(LONG);
  const run = async () => {
    await page.locator(".jp-Notebook-cell .jp-InputArea-editor").first().click();
    await page.keyboard.press("Control+Enter");
  };
  // The newest frame that hears of a session.
  const touched = async (old) => {
    for (const end = Date.now() + LONG.timeout; Date.now() < end; await page.waitForTimeout(200))
      for (const frame of page.frames().filter((one) => one !== page.mainFrame() && one !== old))
        if (await frame.evaluate(() => Boolean(window.nanotouch?.seen.now && window.nanotouch.seen.world)).catch(() => false)) return frame;
    throw new Error("no frame has come to a touch");
  };
  const press = async (frame) => {
    await frame.locator("#view").scrollIntoViewIfNeeded();
    const { x, y } = await frame.locator("#view").boundingBox();
    await page.mouse.move(x + 200, y + 150);
    const pressed = () => frame.evaluate(() => window.nanotouch.seen.now.force > 5e-8);
    for (const end = Date.now() + LONG.timeout; Date.now() < end && !(await pressed()); await page.waitForTimeout(50))
      await page.mouse.wheel(0, 60);
    assert.ok(await pressed());
  };
  await page.waitForFunction(() => document.querySelector(".jp-Notebook"), undefined, LONG);
  for (let kernels = [], end = Date.now() + LONG.timeout; Date.now() < end && !kernels.length; await page.waitForTimeout(200))
    kernels = await (await fetch(`${server}/api/kernels`, heard)).json();
  await run();
  const first = await touched(null);
  await press(first);
  const { bytes, updates } = await first.evaluate(() => window.nanotouch.counters);
  assert.ok(bytes / updates <= 200, `${bytes / updates}`);
  await page.locator("[data-jp-item-name=restart]").click(); // as people do
  await page.locator(".jp-Dialog .jp-mod-accept").click();
  await first.waitForFunction(() => window.nanotouch.seen.stale && window.nanotouch.seen.force === 0, undefined, LONG); // nothing is felt of a dead one
  await run();
  await press(await touched(first));
});
