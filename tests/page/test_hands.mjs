// SPDX-License-Identifier: BSD-3-Clause
// Gamepad, SpaceMouse, touch screen and sound in Chromium: the devices are played here, by what the browser would say.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { all, FILE, later, open, touched, until, value, visit } from "./browser.mjs";

let chromium;
before(async () => { chromium = await open({ offline: true, touch: true, width: 900, height: 640 }); });
after(() => chromium?.close());

const tip = (page) => value(page, () => window.nanotouch.seen.now.tip);
const asked = (page, wanted) => until(page, (what) => window.nanotouch.asked.some((one) => one.do === what), wanted);

// A gamepad, a SpaceMouse and an ear, before the page begins.
function devices() {
  const pad = { connected: true, axes: [0, 0, 0, 0], buttons: Array.from({ length: 4 }, () => ({ pressed: false })), rumbles: [],
    vibrationActuator: { playEffect: (kind, how) => { pad.rumbles.push({ kind, ...how }); return Promise.resolve("complete"); } } };
  window.pad = pad;
  navigator.getGamepads = () => [null, pad];
  const cap = new EventTarget();
  Object.assign(cap, { productName: "SpaceMouse", opened: false, opens: 0, open: async () => { cap.opened = true; cap.opens += 1; } });
  window.cap = cap;
  window.report = (reportId, numbers, bytes = 2) => {
    const data = new DataView(new ArrayBuffer(bytes * numbers.length));
    numbers.forEach((number, i) => (bytes === 2 ? data.setInt16(2 * i, number, true) : data.setUint8(i, number)));
    cap.dispatchEvent(Object.assign(new Event("inputreport"), { reportId, data }));
  };
  const wanted = [];
  window.wanted = wanted;
  const hid = Object.assign(new EventTarget(), { requestDevice: async (what) => { wanted.push(what); return [cap]; } });
  Object.defineProperty(navigator, "hid", { value: hid });
  const ear = { levels: [], pitches: [], closed: 0 };
  window.ear = ear;
  window.AudioContext = class {
    currentTime = 0;
    destination = {};
    createOscillator() {
      return { start() {}, connect: (to) => to, frequency: { setTargetAtTime: (pitch) => ear.pitches.push(pitch) } };
    }
    createGain() {
      return { connect: (to) => to, gain: { value: 1, cancelScheduledValues() {}, setTargetAtTime: (level, at) => ear.levels.push([level, at]) } };
    }
    close() { ear.closed += 1; }
  };
}

const times = (page) => value(page, () => window.nanotouch.asked.length);
async function ready() {
  const { page, said } = await visit(chromium.context, "about:blank");
  await page.addInitScript(devices);
  await page.goto(FILE);
  await touched(page);
  return { page, said };
}

test("a gamepad moves, presses, retracts, stops and arms; it rumbles by the force and is silent without one", async () => {
  const { page, said } = await ready();
  const start = await tip(page);
  assert.equal(await value(page, () => window.pad.rumbles.length), 0); // nothing is felt in the air
  await value(page, () => { window.pad.axes = [0.9, 0.9, 0, 0]; });
  await until(page, ([x, y]) => window.nanotouch.seen.now.tip[0] > x + 1e-8 && window.nanotouch.seen.now.tip[1] < y - 1e-8, start);
  await value(page, () => { window.pad.axes = [0.05, -0.1, 0, 0]; }); // it does not rest at 0: that is no wish
  await later(page, 1);
  const rests = await times(page);
  await later(page, 6);
  assert.equal(await times(page), rests);
  await value(page, () => { window.pad.buttons[0].pressed = true; });
  await until(page, () => window.nanotouch.seen.now.force > 5e-8);
  await until(page, () => window.pad.rumbles.length > 3);
  const rumbles = await value(page, () => window.pad.rumbles);
  assert.ok(rumbles.every(({ kind, duration, strongMagnitude, weakMagnitude }) => kind === "dual-rumble" && duration <= 100 &&
    strongMagnitude > 0 && strongMagnitude <= 1 && weakMagnitude >= 0 && weakMagnitude <= 1));
  assert.ok(rumbles.some(({ weakMagnitude }) => weakMagnitude === 1), "the snap is a pulse");
  await value(page, () => { window.pad.buttons[0].pressed = false; window.pad.buttons[1].pressed = true; });
  await asked(page, "retract");
  await until(page, () => window.nanotouch.seen.now.contact === 0 && window.nanotouch.seen.now.gap > 5e-9);
  await value(page, () => { window.pad.buttons[1].pressed = false; window.pad.buttons[2].pressed = true; });
  await until(page, () => window.nanotouch.seen.now.state !== 0);
  await value(page, () => { window.pad.buttons[2].pressed = false; window.pad.buttons[3].pressed = true; });
  await until(page, () => window.nanotouch.seen.now.state === 0);
  await value(page, () => { window.pad.buttons[3].pressed = false; window.pad.buttons[0].pressed = true; });
  await until(page, () => window.nanotouch.asked.at(-1).do === "press" && window.nanotouch.asked.at(-1).on);
  await value(page, () => { window.pad.connected = false; window.pad.axes = [1, 1, 1, 1]; }); // unplugged while it presses
  await until(page, () => window.nanotouch.asked.at(-1).on === false);
  const [last, silent] = [await times(page), await value(page, () => window.pad.rumbles.length)];
  await later(page, 6);
  assert.deepEqual([await times(page), await value(page, () => window.pad.rumbles.length)], [last, silent]);
  assert.deepEqual(said.filter((words) => !/GL Driver|WebGL/.test(words)), []);
  await page.close();
});

test("a SpaceMouse is asked for by G, moves the tip by its cap, presses and retracts by its buttons", async () => {
  const { page } = await ready();
  await page.focus("#view");
  await page.keyboard.press("g");
  await until(page, () => window.cap.opens === 1);
  assert.deepEqual((await value(page, () => window.wanted))[0].filters.map(({ vendorId }) => vendorId), [0x046d, 0x256f]);
  const [x] = await tip(page);
  await value(page, () => window.report(1, [200, 0, 0]));
  await until(page, (old) => window.nanotouch.seen.now.tip[0] > old + 1e-8, x);
  await value(page, () => window.report(1, [0, 0, 350])); // pressed down
  await until(page, () => window.nanotouch.seen.now.contact > 0);
  await value(page, () => window.report(1, [0, 0, 0]));
  await value(page, () => window.report(1, [1, 2], 1)); // a report that is too short
  await value(page, () => window.report(3, [1], 1));
  await until(page, () => window.nanotouch.asked.some((one) => one.do === "press" && one.on));
  await value(page, () => window.report(3, [0], 1));
  await value(page, () => window.report(3, [2], 1));
  await asked(page, "retract");
  await until(page, () => window.nanotouch.seen.now.contact === 0 && window.nanotouch.seen.now.gap > 5e-9);
  await value(page, () => window.report(1, [200, 0, 0]));
  await later(page, 1);
  await value(page, () => navigator.hid.dispatchEvent(Object.assign(new Event("disconnect"), { device: window.cap })));
  await until(page, () => window.nanotouch.seen.notes.some(({ text }) => /unplugged/.test(text)));
  await later(page, 1);
  const last = await times(page);
  await later(page, 6);
  assert.equal(await times(page), last, "its last word holds no longer");
  await page.close();
});

test("a browser without WebHID says so", async () => {
  const { page } = await visit(chromium.context, "about:blank");
  await page.addInitScript(() => Object.defineProperty(navigator, "hid", { value: undefined }));
  await page.goto(FILE);
  await touched(page);
  await page.focus("#view");
  await page.keyboard.press("g");
  await until(page, () => window.nanotouch.seen.notes.some(({ text }) => /no WebHID/.test(text)));
  await page.close();
});

test("one finger moves over the surface, two go down and up", async () => {
  const { page } = await ready();
  const box = await page.locator("#view").boundingBox();
  const screen = await chromium.context.newCDPSession(page);
  const at = (x, y, id) => ({ x: box.x + x, y: box.y + y, id });
  const fingers = (type, touchPoints) => screen.send("Input.dispatchTouchEvent", { type, touchPoints });
  const [x] = await tip(page);
  await fingers("touchStart", [at(300, 200, 0)]);
  for (let i = 1; i <= 12; ++i) await fingers("touchMove", [at(300 + 8 * i, 200, 0)]);
  await fingers("touchEnd", []);
  await until(page, (old) => window.nanotouch.seen.now.tip[0] > old + 5e-9, x);
  assert.ok(await value(page, () => window.nanotouch.asked.every((one) => one.do !== "wheel")), "one finger never goes down");
  await fingers("touchStart", [at(300, 150, 0)]);
  await fingers("touchStart", [at(300, 150, 0), at(360, 150, 1)]);
  for (let i = 0; i < 400 && !(await value(page, () => window.nanotouch.seen.now.force > 2e-8)); ++i) {
    const y = 150 + 5 * (i % 40);
    if (i % 40 === 0 && i > 0) { // let go and begin above again
      await fingers("touchEnd", []);
      await fingers("touchStart", [at(300, y, 0)]);
      await fingers("touchStart", [at(300, y, 0), at(360, y, 1)]);
    } else await fingers("touchMove", [at(300, y, 0), at(360, y, 1)]);
    await page.waitForTimeout(20);
  }
  await fingers("touchEnd", []);
  assert.ok(await value(page, () => window.nanotouch.seen.now.force > 2e-8));
  await page.close();
});

test("sound: silent in the air, higher with the force, off again; each order ends by itself within 100 ms", async () => {
  const { page } = await ready();
  await page.focus("#view");
  await page.keyboard.press("m");
  await until(page, () => window.ear.pitches.length > 3);
  assert.ok(await value(page, () => window.ear.levels.every(([level]) => level === 0)));
  await page.keyboard.down(" ");
  await until(page, () => window.nanotouch.seen.now.force > 5e-8 && window.ear.levels.some(([level]) => level > 0.3));
  await page.keyboard.up(" ");
  const { levels, pitches } = await value(page, () => window.ear);
  assert.ok(Math.max(...pitches) > 1.2 * Math.min(...pitches) && Math.max(...pitches) <= 4 * 220, `${Math.max(...pitches)}`);
  levels.forEach(([level], i) => { if (level > 0) assert.ok(levels[i + 1][0] === 0 && levels[i + 1][1] <= 0.1, `${levels[i + 1]}`); });
  await all(page);
  await page.locator("[data-own=m]").click();
  await until(page, () => window.ear.closed === 1);
  await page.close();
});
