// SPDX-License-Identifier: BSD-3-Clause
// The reference session (reference.c) in WebAssembly, beside what the native build printed.
// Usage: node reference.mjs FILE.wasm NATIVE.txt. It tells the largest relative difference of the force as JSON.
import fs from "node:fs";
import { Core } from "../../apps/page/src/core.js";

const [wasm, native] = process.argv.slice(2);
const core = await Core.load(fs.readFileSync(wasm));
const { c } = core;

// C's %a
function hexadecimal(words) {
  const found = /^(-?)0x([01])(?:\.([0-9a-f]+))?p([+-]?\d+)$/.exec(words);
  if (!found) return Number(words);
  const [, sign, lead, rest = "", power] = found;
  const mantissa = Number(lead) + (rest ? parseInt(rest, 16) / 16 ** rest.length : 0);
  return (sign ? -1 : 1) * mantissa * 2 ** Number(power);
}

const PIXELS = 65, size = 500e-9, pixel = size / PIXELS;
const heights = c.page_alloc(8 * PIXELS * PIXELS), opening = c.page_alloc(64);
c.page_defaults();
core.check(c.page_dots(heights, PIXELS, size));
core.doubles(opening, 8).set([0.5 * size, 0.5 * size, 0.1e-6, 30e-9, pixel, pixel, 1.0, 1.5]);
core.check(c.page_open(heights, PIXELS, PIXELS, opening));
const rows = [];
const began = performance.now();
[[0.2, 3.0], [0.8, 3.0], [-0.4, 3.0]].forEach(([push, duration], part) => {
  core.check(c.page_push(push, (0.5 + 0.05 * part) * size, 0.5 * size, duration));
  for (let i = 0; i < 300; ++i) {
    core.check(c.page_run(100));
    const now = new DataView(c.memory.buffer, c.page_update_of(), 128);
    rows.push([24, 64, 56].map((at) => now.getFloat64(at, true)));
    c.page_taken();
  }
});
const cycle = (1e6 * (performance.now() - began)) / 90000;

const wanted = fs.readFileSync(native, "utf8").trim().split("\n").map((line) => line.split(" ").map(hexadecimal));
const largest = (column) => Math.max(...wanted.map((row) => Math.abs(row[column])));
const difference = [0, 1, 2].map((column) =>
  Math.max(...wanted.map((row, i) => Math.abs(row[column] - rows[i][column]))) / largest(column));
console.log(JSON.stringify({ rows: rows.length, wanted: wanted.length, time: difference[0], force: difference[1],
  gap: difference[2], largest: largest(1), contacts: wanted.filter((row) => row[2] < 0).length, cycle }));
