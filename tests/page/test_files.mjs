// SPDX-License-Identifier: BSD-3-Clause
// Files that are dropped on the page, made here: what becomes of them, and the plain word for what is none of them.
import assert from "node:assert/strict";
import fs from "node:fs";
import { after, before, test } from "node:test";
import zlib from "node:zlib";
import { FILE, open, touched, until, value, visit } from "./browser.mjs";

let chromium;
before(async () => { chromium = await open({ offline: true, width: 900, height: 640 }); });
after(() => chromium?.close());

// Really dropped: by the events that a browser sends, with a file in them.
async function drop(page, name, bytes, type = "application/octet-stream") {
  await page.evaluate(({ called, data, kind }) => {
    const held = new DataTransfer();
    held.items.add(new File([Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0))], called, { type: kind }));
    for (const what of ["dragover", "drop"])
      document.getElementById("view").dispatchEvent(new DragEvent(what, { bubbles: true, cancelable: true, dataTransfer: held }));
  }, { called: name, data: Buffer.from(bytes).toString("base64"), kind: type });
}
const titled = (page, title) => until(page, (wanted) => window.nanotouch.seen.world?.title === wanted && window.nanotouch.seen.law, title);
const told = async (page, wanted) => {
  await until(page, (words) => window.nanotouch.seen.notes.some(({ text }) => new RegExp(words, "i").test(text)), wanted);
  await value(page, () => { window.nanotouch.seen.notes = []; });
};

function gsf(columns, rows, unit, pixels, more = "XReal = 1e-6\nYReal = 1e-6\n") {
  const head = `Gwyddion Simple Field 1.0\nXRes = ${columns}\nYRes = ${rows}\n${more}XYUnits = m\nZUnits = ${unit}\n`;
  return Buffer.concat([Buffer.from(head), Buffer.alloc(4 - (head.length % 4)), Buffer.from(Float32Array.from(pixels).buffer)]);
}

// A grey picture of 8 bits.
function png(columns, rows, grey) {
  const chunk = (name, data) => {
    const body = Buffer.concat([Buffer.from(name), data]), made = Buffer.alloc(body.length + 8);
    made.writeUInt32BE(data.length, 0);
    body.copy(made, 4);
    made.writeUInt32BE(zlib.crc32 ? zlib.crc32(body) : crc(body), body.length + 4);
    return made;
  };
  const head = Buffer.alloc(13), lines = Buffer.alloc(rows * (columns + 1));
  head.writeUInt32BE(columns, 0);
  head.writeUInt32BE(rows, 4);
  head[8] = 8;
  for (let j = 0; j < rows; ++j) for (let i = 0; i < columns; ++i) lines[j * (columns + 1) + 1 + i] = grey(i, j);
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk("IHDR", head), chunk("IDAT", zlib.deflateSync(lines)),
    chunk("IEND", Buffer.alloc(0))]);
}
function crc(bytes) { // of Node before 22.2
  let value = -1;
  for (const byte of bytes) {
    value ^= byte;
    for (let bit = 0; bit < 8; ++bit) value = (value >>> 1) ^ (value & 1 ? 0xedb88320 : 0);
  }
  return ~value >>> 0;
}

// Hertz by the height of the base, with a pull-off on the way out: CSV with units in its header.
function curve(lines = []) {
  const radius = 20e-9, modulus = 2e9, spring = 5, rows = (way) => {
    for (let n = 0; n < 300; ++n) {
      const base = (way > 0 ? 60 - 0.25 * n : -15 + 0.25 * n) * 1e-9;
      let low = 0, high = 100e-9;
      for (let k = 0; k < 80; ++k) {
        const depth = (low + high) / 2;
        if (depth + ((4 / 3) * modulus * Math.sqrt(radius) * depth ** 1.5) / spring < -base) low = depth;
        else high = depth;
      }
      const pressed = base < 0 ? (4 / 3) * modulus * Math.sqrt(radius) * low ** 1.5 : 0;
      const pulled = way < 0 && base >= 0 && base < 2e-9 ? -spring * base : 0;
      lines.push(`${(base * 1e9).toFixed(4)};${((pressed + pulled + 1e-11 * Math.sin(12.9898 * n * n)) * 1e9).toFixed(5)}`);
    }
  };
  rows(1);
  rows(-1);
  return ["# spring constant [N/m]: 5", "height (nm);force (nN)", ...lines].join("\n");
}

test("a PNG asks for its lengths, and is the surface; white is high, the top is the top", async () => {
  const { page, requests } = await visit(chromium.context, FILE);
  await touched(page);
  await drop(page, "picture.png", png(64, 32, (i, j) => (j < 8 ? 255 : 0)), "image/png");
  await page.locator("#sheet input[name=width]").fill("2 furlongs");
  await page.locator("#sheet button", { hasText: "Touch it" }).click();
  await told(page, "no such quantity \\(units: ");
  await page.locator("#sheet input[name=width]").fill("2 um");
  await page.locator("#sheet input[name=height]").fill("10 nm");
  await page.locator("#sheet button", { hasText: "Touch it" }).click();
  await titled(page, "picture.png");
  const [size, low, high] = await value(page, () => [window.nanotouch.seen.world.size.map((side) => Math.round(side * 1e9)),
    window.nanotouch.stage.grid.at(1e-6, 1e-7), window.nanotouch.stage.grid.at(1e-6, 9.7e-7)]);
  assert.deepEqual(size, [2000, 1000]);
  assert.ok(Math.abs(low) < 1e-12 && Math.abs(high - 10e-9) < 1e-11, `${low} ${high}`);
  assert.deepEqual(requests.filter((url) => !/^(file|blob|data):/.test(url)), []);
  await page.close();
});

test("a large picture keeps its proportions, and + and - draw it higher and lower", async () => {
  const { page } = await visit(chromium.context, FILE);
  await touched(page);
  await drop(page, "wide.png", png(2048, 512, (i) => (i & 512 ? 255 : 0)), "image/png");
  await page.locator("#sheet input[name=width]").fill("4 um");
  await page.locator("#sheet input[name=height]").fill("10 nm");
  await page.locator("#sheet button", { hasText: "Touch it" }).click();
  await titled(page, "wide.png");
  assert.deepEqual(await value(page, () => window.nanotouch.seen.world.size.map((side) => Math.round(side * 1e9))), [4000, 1000]);
  const factor = () => value(page, () => window.nanotouch.stage.grid.factor), before = await factor();
  const { sent } = await value(page, () => ({ sent: window.nanotouch.stage.rebuilt }));
  await page.focus("#view");
  await page.keyboard.press("-");
  assert.ok((await factor()) < before);
  for (let i = 0; i < 30; ++i) await page.keyboard.press("+");
  const highest = await factor();
  assert.ok(highest > before && highest * 10e-9 <= 0.5 * 4e-6 && highest * 10e-9 > 0.3 * 4e-6, `${highest}`);
  assert.equal(await value(page, () => window.nanotouch.stage.rebuilt), sent); // stretched, not made anew
  await page.close();
});

test("a TOML file is the scene; what is wrong in it is named", async () => {
  const { page } = await visit(chromium.context, FILE);
  await touched(page);
  await drop(page, "scene.toml", "[tip]\nradius_nm = 35\n[probe]\nspring_constant_N_per_m = 5\n");
  await titled(page, "scene.toml");
  assert.deepEqual(await value(page, () => [window.nanotouch.seen.world.scene.tip.radius, window.nanotouch.seen.world.rig.probe.spring_constant]),
    [35e-9, 5]);
  for (const [text, words] of [["[tip]\nradius_nm = -3", "valid is"], ["[tip]\nradius = 3", "no key radius"], ["not toml at all", "wrong.toml: "],
    ["[nothing]\nx = 1", "unknown section"]]) {
    await drop(page, "wrong.toml", text);
    await told(page, words);
    assert.equal(await value(page, () => window.nanotouch.seen.world.title), "scene.toml");
  }
  await page.close();
});

test("a CSV curve gives its card: contact point, pull-off, modulus; then its touch", async () => {
  const { page } = await visit(chromium.context, FILE);
  await touched(page);
  await drop(page, "curve.csv", curve(), "text/csv");
  await page.locator("#sheet table").waitFor();
  const card = await page.locator("#sheet table").innerText();
  for (const row of ["contact point", "pull-off force", "noise", "ruptures"]) assert.match(card, new RegExp(row));
  const pull = Number(/pull-off force\s+([\d.]+) nN/.exec(card)?.[1]), modulus = Number(/modulus.*?([\d.]+) GPa/s.exec(card)?.[1]);
  assert.ok(Math.abs(pull - 10) < 1.5, card); // the last point before the tear is at most a step of 1.25 nN below it
  assert.ok(Math.abs(modulus / 2 - 1) < 0.1, card);
  await page.locator("#sheet button", { hasText: "Touch it" }).click();
  await titled(page, "curve.csv");
  const touchedPull = await value(page, () => window.nanotouch.seen.pullOff);
  assert.ok(Math.abs(touchedPull / (pull * 1e-9) - 1) < 0.1, `${touchedPull}`);
  await page.close();
});

test("a GSF of moduli gives each place its own; K colours by it", async () => {
  const { page } = await visit(chromium.context, FILE);
  await touched(page);
  await page.focus("#view");
  await page.keyboard.press("k");
  await told(page, "properties of the scene");
  await drop(page, "modulus.gsf", gsf(8, 8, "Pa", Array.from({ length: 64 }, (_, at) => (at % 8 < 4 ? 2e9 : 2e10))));
  await until(page, () => window.nanotouch.stage.maps?.youngs_modulus && window.nanotouch.seen.now);
  assert.equal(await value(page, () => window.nanotouch.seen.world?.title ?? "Silicon in air"), "Silicon in air");
  const drawn = async () => { // the middle of the picture, beside the tip
    const { x, y, width, height } = await page.locator("#view").boundingBox();
    return page.screenshot({ clip: { x, y: y + height / 2, width: width / 3, height: height / 4 } });
  };
  await page.keyboard.press("p");
  await until(page, () => window.nanotouch.seen.clock.paused);
  const before = await drawn();
  await page.keyboard.press("k");
  await told(page, "coloured by modulus");
  const ends = await value(page, () => window.nanotouch.stage.ends);
  assert.ok(Math.abs(ends[0] / 2e9 - 1) < 1e-6 && Math.abs(ends[1] / 2e10 - 1) < 1e-6, `${ends}`);
  assert.ok(!(await drawn()).equals(before));
  await page.keyboard.press("k");
  await told(page, "coloured by height");
  await page.keyboard.press("p");
  await until(page, () => window.nanotouch.seen.clock.here?.youngs_modulus > 1.9e9); // what the session has there
  await page.close();
});

test("a wrong file gets a plain word, and the touch goes on", async () => {
  const { page, said } = await visit(chromium.context, FILE);
  await touched(page);
  const cases = [
    ["empty.png", "", "empty.png"], ["broken.png", png(8, 8, () => 0).subarray(0, 40), "broken.png"], ["fake.png", "hello", "fake.png"],
    ["broken.gsf", gsf(64, 64, "m", [0, 1, 2]), "shorter than its header"], ["volts.gsf", gsf(8, 8, "V", Array(64).fill(0)), "holds V"],
    ["nan.gsf", gsf(8, 8, "m", Array(64).fill(NaN)), "without a height"], ["huge.gsf", gsf(99999, 99999, "m", [0]), "99999"],
    ["few.csv", "1,2\n3,4\n", "32 rows"], ["words.txt", "once upon a time\n".repeat(50), "32 rows"],
    ["units.csv", `z (furlong), force (N)\n${"1,2\n".repeat(50)}`, "units"], ["flat.csv", "1e-9,0\n".repeat(50), "flat.csv"],
    ["volts.csv", `z (V), force (V)\n${"1,2\n".repeat(50)}`, "length and a force"], ["swapped.csv", `z (nN), force (nm)\n${"1,2\n".repeat(50)}`, "length and a force"],
    ["rigid.csv", curve().replace("[N/m]: 5", "[N/m]: 0"), "spring constant = 0 N/m: valid is above 0"],
    ["tower.gsf", gsf(8, 8, "m", Array(64).fill(0).fill(1, 0, 8)), "height of the surface = 1 m: valid is"],
    ["deep.toml", `a = ${"[".repeat(5000)}`, "^deep.toml: Invalid TOML document: [^\\n]{0,90}$"],
    ["touch.mcap", "\x89MCAP0", "recording"], ["archive.zip", Buffer.from([80, 75, 3, 4, 0, 1, 2]), "archive.zip"],
  ];
  for (const [name, bytes, words] of cases) {
    await drop(page, name, bytes);
    await told(page, words);
  }
  assert.equal(await value(page, () => window.nanotouch.seen.world.title), "Silicon in air");
  const { sequence } = await value(page, () => window.nanotouch.seen.now);
  await until(page, (old) => window.nanotouch.seen.now.sequence > old, sequence);
  assert.deepEqual(said.filter((line) => !/GL Driver|WebGL/.test(line)), []);
  await page.close();
});

test("the result of a task is a CSV file, as the window writes it", async () => {
  const { page } = await visit(chromium.context, `${FILE}#task=find`);
  await touched(page);
  await until(page, () => window.nanotouch.seen.task.name === "find");
  await page.focus("#view");
  const done = () => "score" in window.nanotouch.seen.task;
  for (let i = 0; i < 900 && !(await value(page, done)); ++i)
    if (!(await value(page, () => window.nanotouch.seen.now.contact > 0))) await page.keyboard.press("Shift+PageDown", { delay: 10 });
    else await page.waitForTimeout(50);
  const [file] = await Promise.all([page.waitForEvent("download"), page.locator("#board button", { hasText: "CSV" }).click()]);
  assert.equal(file.suggestedFilename(), "nanotouch-find.csv");
  const lines = fs.readFileSync(await file.path(), "utf8").trim().split("\n");
  assert.equal(lines[0], "# task: find");
  assert.match(lines[1], /^# passed: (True|False)$/);
  const largest = Number(lines.find((line) => line.startsWith("# largest force [N]: ")).split(": ")[1]);
  const head = lines.findIndex((line) => !line.startsWith("#")), rows = lines.slice(head + 1).map((line) => line.split(",").map(Number));
  assert.equal(lines[head], "time [s],x [m],y [m],gap [m],least force [N],largest force [N],contact");
  assert.ok(rows.length > 10 && rows.every((row) => row.length === 7 && row.every(Number.isFinite)));
  assert.ok(Math.abs(Math.max(...rows.map((row) => row[5])) - largest) <= 1e-6 * largest, "no spike is lost");
  await page.close();
});

test("the work of the hand is told: its parts are the whole", async () => {
  const { page } = await visit(chromium.context, FILE);
  await touched(page);
  await page.focus("#view");
  await page.keyboard.down(" ");
  await until(page, () => window.nanotouch.seen.now.force > 5e-8);
  await page.keyboard.up(" ");
  await until(page, () => window.nanotouch.seen.now.contact === 0 && window.nanotouch.seen.now.gap > 5e-9);
  await until(page, () => window.nanotouch.seen.clock.energies[3] > 0);
  const [hand, stored, tip, heat] = await value(page, () => window.nanotouch.seen.clock.energies);
  assert.ok(Math.abs(hand - stored - tip - heat) <= 1e-9 * heat && hand > 0);
  await page.close();
});
