// SPDX-License-Identifier: BSD-3-Clause
// The first minute in Chromium: on a phone by one synthetic finger, and where the system asks for less motion.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { FILE, open, touched, until, value, visit } from "./browser.mjs";

const WIDTH = 390, HEIGHT = 844;
let chromium;
before(async () => { chromium = await open({ offline: true, touch: true, width: WIDTH, height: HEIGHT }); });
after(() => chromium?.close());

const seen = (page, name) => value(page, (key) => window.nanotouch.seen[key], name);
const told = (page, words) => until(page, (wanted) => new RegExp(wanted).test(document.getElementById("guide").textContent), words);
const picture = (page, name) => process.env.NANOTOUCH_PICTURES && page.screenshot({ path: `${process.env.NANOTOUCH_PICTURES}/${name}.png` });

// One finger along the bar of height, again and again, until a condition of the page holds.
async function slide(page, screen, way, what) {
  const { x, y, height } = await page.locator("#rail").boundingBox(), steps = 20;
  const at = (share) => [{ x: x + 20, y: y + height * (way > 0 ? 0.1 + 0.8 * share : 0.9 - 0.8 * share), id: 0 }];
  const finger = (type, touchPoints) => screen.send("Input.dispatchTouchEvent", { type, touchPoints });
  for (let i = 0; i < 30 && !(await value(page, what)); ++i) {
    await finger("touchStart", at(0));
    for (let step = 1; step <= steps && !(await value(page, what)); ++step) {
      await finger("touchMove", at(step / steps));
      await page.waitForTimeout(15);
    }
    await finger("touchEnd", []);
  }
  assert.ok(await value(page, what), "it did not come to that");
}

test("a phone and one finger: down until it snaps, the neck is seen, up until it tears, dry, and again", async () => {
  const page = (await visit(chromium.context, "about:blank")).page;
  await page.addInitScript(() => {
    const Whole = window.AudioContext;
    window.heard = 0;
    window.AudioContext = class extends Whole { constructor() { super(); ++window.heard; } };
  });
  await page.goto(FILE);
  await touched(page);
  const screen = await chromium.context.newCDPSession(page);
  await told(page, "bar at the left until the water snaps"); // as a finger does it
  const places = await value(page, () => ["#guide", "#view", "#rail", "[data-field='medium.relative_humidity'] input[type=range]", "#law"]
    .map((what) => { const { left, right, top, bottom } = document.querySelector(what).getBoundingClientRect(); return { what, left, right, top, bottom }; }));
  for (const one of places) assert.ok(one.left >= 0 && one.right <= WIDTH && one.top >= 0 && one.bottom <= HEIGHT, JSON.stringify(one));
  const { radius } = await value(page, () => window.nanotouch.lens);
  assert.equal(await value(page, () => window.heard), 0); // browsers let no sound be made before a click
  await slide(page, screen, 1, () => window.nanotouch.seen.event?.kind === "snap");
  assert.match((await seen(page, "event")).text, /^[\d.]+ nN, [\d.]+ N at your hand$/);
  await until(page, (small) => window.nanotouch.lens.radius > 1.4 * small, radius); // it grows
  await picture(page, "phone_snap");
  const { section, halfWidth } = await value(page, () => window.nanotouch.lens.contact);
  assert.ok(section.c > 1.5 * section.a && section.c > 0.2 * halfWidth && section.c < halfWidth, `${section.a} ${section.c} ${halfWidth}`); // the neck
  assert.equal(await value(page, () => window.heard), 1);
  await told(page, "up on the bar until it tears");
  await slide(page, screen, -1, () => window.nanotouch.seen.event?.kind === "tear");
  await picture(page, "phone_tear");
  const wet = await seen(page, "pullOff"), { text } = await seen(page, "event");
  assert.ok(Math.abs(parseFloat(text) / (1e9 * wet) - 1) < 0.3, `${text} ${wet}`);
  const slider = await page.locator("[data-field='medium.relative_humidity'] input[type=range]").boundingBox();
  await page.touchscreen.tap(slider.x + 1, slider.y + slider.height / 2);
  await until(page, (old) => window.nanotouch.seen.world.scene.medium.relative_humidity === 0 && window.nanotouch.seen.pullOff < old, wet);
  await slide(page, screen, 1, () => window.nanotouch.seen.now.contact > 0);
  await slide(page, screen, -1, () => window.nanotouch.seen.now.contact === 0);
  await until(page, (old) => window.nanotouch.seen.event.text !== old, text);
  assert.ok(parseFloat((await seen(page, "event")).text) < 0.9 * parseFloat(text));
  await picture(page, "phone_dry");
  await page.close();
});

test("no line speaks of water where there is none", async () => {
  const { page } = await visit(chromium.context, `${FILE}#${new URLSearchParams({ scene: "[medium]\nrelative_humidity_percent = 0" })}`);
  await touched(page);
  await told(page, "until");
  await page.focus("#view");
  await page.keyboard.press("d");
  await until(page, () => document.getElementById("about").textContent);
  const lines = await value(page, () => ["guide", "about", "facts"].map((id) => document.getElementById(id).textContent));
  assert.deepEqual(lines.filter((line) => /water/.test(line)), []);
  await page.close();
});

test("where less motion is asked for the lens is large at once, and its light stands still", async () => {
  const { page } = await visit(chromium.context, "about:blank");
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto(FILE);
  await touched(page);
  await value(page, () => {
    window.radii = new Set();
    const watch = () => { window.radii.add(window.nanotouch.lens.radius); requestAnimationFrame(watch); };
    watch();
  });
  await page.focus("#view");
  for (let i = 0; i < 400 && !(await seen(page, "event")); ++i) await page.keyboard.press("PageDown", { delay: 15 });
  await until(page, () => window.radii.size > 1);
  await until(page, () => performance.now() - window.nanotouch.seen.event.at > 5000);
  assert.equal(await value(page, () => window.radii.size), 2);
  await page.close();
});
