// SPDX-License-Identifier: BSD-3-Clause
// What the page weighs and how soon it can be touched, here, and how much of that is the processor's own work: the rest
// is waiting for others on a busy machine (divide by "waits"). Pictures of each sample, light, dark and on a phone. Prints
// JSON; nothing passes or fails.
// Usage: node tests/page/figures.mjs [FOLDER]
import fs from "node:fs";
import path from "node:path";
import zlib from "node:zlib";
import { Core } from "../../apps/page/src/core.js";
import { Host } from "../../apps/page/src/host.js";
import { FILE, later, open, PAGE, touched, until, value, visit } from "./browser.mjs";

const folder = process.argv[2], html = fs.readFileSync(PAGE);
const report = { "size [MB]": html.length / 1e6, "compressed [MB]": zlib.gzipSync(html).length / 1e6, "first touch [ms]": {},
  "laid, processor [ms]": {}, waits: NaN };
const { context, close } = await open();
const first = await visit(context, FILE);
await touched(first.page);
const names = await value(first.page, () => JSON.parse(document.getElementById("table").textContent).presets.map(({ name }) => name));
await first.page.close();
for (const name of names) {
  const { page } = await visit(context, `${FILE}#preset=${name}`);
  await touched(page);
  report["first touch [ms]"][name] = Math.round((await value(page, () => window.nanotouch.counters)).firstTouch);
  if (folder) {
    await page.focus("#view");
    await page.keyboard.down(" "); // presses with a steady force
    await until(page, () => window.nanotouch.seen.now.force > 0.2 * window.nanotouch.seen.load);
    const shot = (kind) => page.screenshot({ path: path.join(folder, `${name}_${kind}.png`) });
    await shot("light");
    await page.keyboard.press("l");
    await later(page, 3);
    await shot("dark");
    await page.setViewportSize({ width: 390, height: 844 });
    await later(page, 3);
    await shot("phone");
    await page.keyboard.up(" ");
  }
  await page.close();
}
await close();

// To lay each sample by the same code in Node: processor time, and how much longer it took by the clock.
const table = JSON.parse(/<script[^>]*id="table"[^>]*>([\s\S]*?)<\/script>/.exec(html.toString())[1]);
const host = new Host(await Core.load(fs.readFileSync(path.join(path.dirname(PAGE), "nanotouch.wasm"))), table, () => {});
const began = [process.cpuUsage(), performance.now()];
for (const name of names) {
  const before = process.cpuUsage();
  await host.answer({ do: "preset", name });
  const { user, system } = process.cpuUsage(before);
  report["laid, processor [ms]"][name] = Math.round((user + system) / 1e3);
}
const { user, system } = process.cpuUsage(began[0]);
report.waits = Number(((1e3 * (performance.now() - began[1])) / (user + system)).toFixed(1));
console.log(JSON.stringify(report, null, 1));
