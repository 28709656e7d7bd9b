// SPDX-License-Identifier: BSD-3-Clause
// The widget's frame in Chromium, with the kernel's end played here: what the kernel sends is seen, what the page asks
// reaches the kernel, and nothing else is asked of anybody.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { open, PAGE } from "./browser.mjs";

const WIDGET = path.resolve(import.meta.dirname, "../../apps/nanotouch_app/browser/widget.js");
let chromium;
before(async () => { chromium = await open({ offline: true }); });
after(() => chromium?.close());

test("messages and updates pass through the frame, both ways", async () => {
  const page = await chromium.context.newPage(), requests = [];
  page.on("request", (request) => requests.push(request.url()));
  await page.goto("about:blank");
  await page.evaluate((html) => { window.html = html; }, fs.readFileSync(PAGE, "utf8"));
  const script = fs.readFileSync(WIDGET, "utf8").replace("export default { render };", "") + `
    window.sent = [];
    window.model = { get: (name) => (name === "page" ? window.html : 700), send: (message) => window.sent.push(message),
      on: (_, hear) => { window.kernel = hear; }, off: () => {} };
    render({ model: window.model, el: document.body });`;
  await page.addScriptTag({ content: script });
  const long = { timeout: 120000 };
  await page.waitForFunction(() => window.sent.some((message) => message.do === "hello"), undefined, long);
  await page.evaluate(() => window.kernel({ message: { tell: "note", text: "from the kernel" } }, []));
  const frame = page.frames().find((one) => one !== page.mainFrame());
  await frame.waitForFunction(() => window.nanotouch.seen.notes.some(({ text }) => text === "from the kernel"), undefined, long);
  await frame.waitForFunction(() => window.nanotouch.counters.messages >= 2, undefined, long); // its own library is there, too
  await page.evaluate(() => {
    const update = new DataView(new ArrayBuffer(136), 8); // as a kernel's buffers come: a view into more
    update.setUint8(0, 1);
    update.setFloat64(24, 1.5, true);
    update.setFloat64(64, 3e-9, true);
    window.kernel({}, [update]);
  });
  await frame.waitForFunction(() => window.nanotouch.seen.now?.time === 1.5 && window.nanotouch.seen.now.force === 3e-9, undefined, long);
  await page.waitForFunction(() => window.sent.some((message) => Object.keys(message).length === 0), undefined, long); // taken
  await frame.locator("#view").focus();
  await page.keyboard.press("PageDown");
  await page.waitForFunction(() => window.sent.some((message) => message.do === "wheel" && message.steps === 1), undefined, long);
  assert.deepEqual(requests.filter((url) => !/^(about|blob|data):/.test(url)), []);
});
