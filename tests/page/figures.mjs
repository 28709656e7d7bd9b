// SPDX-License-Identifier: BSD-3-Clause
// What the page weighs and how soon it can be touched, here; a picture of each sample. Prints JSON; nothing passes or fails.
// Usage: node tests/page/figures.mjs [FOLDER]
import fs from "node:fs";
import path from "node:path";
import zlib from "node:zlib";
import { FILE, open, PAGE, touched, value, visit } from "./browser.mjs";

const folder = process.argv[2], html = fs.readFileSync(PAGE);
const report = { "size [MB]": html.length / 1e6, "compressed [MB]": zlib.gzipSync(html).length / 1e6, "first touch [ms]": {} };
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
    await page.mouse.move(400, 300);
    for (let i = 0; i < 14; ++i) {
      await page.mouse.wheel(0, 250);
      await page.waitForTimeout(100);
    }
    await page.waitForTimeout(1500);
    await page.screenshot({ path: path.join(folder, `${name}.png`) });
  }
  await page.close();
}
await close();
console.log(JSON.stringify(report, null, 1));
