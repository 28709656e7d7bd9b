// SPDX-License-Identifier: BSD-3-Clause
// What the page weighs and how soon it can be touched, here; pictures of each sample, light, dark and on a phone. Prints
// JSON; nothing passes or fails.
// Usage: node tests/page/figures.mjs [FOLDER]
import fs from "node:fs";
import path from "node:path";
import zlib from "node:zlib";
import { FILE, later, open, PAGE, touched, until, value, visit } from "./browser.mjs";

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
console.log(JSON.stringify(report, null, 1));
