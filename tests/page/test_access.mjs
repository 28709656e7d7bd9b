// SPDX-License-Identifier: BSD-3-Clause
// Whom the page leaves out: contrast by WCAG 2.2 AA from the styles as they are computed, each control by Tab and by
// name, and a system that asks for less motion.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { all, FILE, open, touched, until, value, visit } from "./browser.mjs";

const TEXT = 4.5, PARTS = 3; // contrast of text (1.4.3), of controls and what is drawn (1.4.11)
let chromium;
before(async () => { chromium = await open({ offline: true }); });
after(() => chromium?.close());

// In the page: all texts that are seen, with their colour over what lies behind them.
function texts() {
  const parts = (colour) => (colour.match(/[\d.]+/g) ?? [0, 0, 0, 0]).map(Number);
  const over = ([r, g, b, a = 1], below) => [r, g, b].map((part, i) => a * part + (1 - a) * below[i]);
  const behind = (node) => {
    if (!node) return [255, 255, 255];
    const own = parts(getComputedStyle(node).backgroundColor);
    return own.length === 4 && own[3] === 0 ? behind(node.parentElement) : over(own, own.length === 4 ? behind(node.parentElement) : own);
  };
  const light = (colour) => colour.map((part) => part / 255).map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4))
    .reduce((sum, part, i) => sum + part * [0.2126, 0.7152, 0.0722][i], 0);
  const contrast = (a, b) => (Math.max(light(a), light(b)) + 0.05) / (Math.min(light(a), light(b)) + 0.05);
  const found = [];
  for (const node of document.querySelectorAll("body *")) {
    const words = node.matches("input[type=text], textarea") ? node.value
      : [...node.childNodes].filter(({ nodeType }) => nodeType === 3).map(({ data }) => data.trim()).join("");
    if (!words || node.disabled || !node.checkVisibility({ visibilityProperty: true }) || node.closest("script, style")) continue;
    const ground = behind(node), style = getComputedStyle(node);
    found.push({ words: words.slice(0, 40), size: parseFloat(style.fontSize), contrast: contrast(over(parts(style.color), ground), ground) });
  }
  const root = getComputedStyle(document.documentElement);
  const named = Object.fromEntries(["paper", "panel", "ink", "quiet", "accent", "attraction", "repulsion", "good", "hold", "bad"]
    .map((name) => [name, parts(root.getPropertyValue(`--${name}`))]));
  const { paper, panel, ...others } = named; // what is drawn lies on a panel
  const drawn = Object.entries(others).map(([pair, colour]) => ({ pair, contrast: contrast(colour, panel) }));
  return { found, drawn };
}

for (const colorScheme of ["light", "dark"])
  test(`contrast in ${colorScheme}`, async () => {
    const { page } = await visit(chromium.context, "about:blank");
    await page.emulateMedia({ colorScheme });
    await page.goto(FILE);
    await touched(page);
    assert.equal(await value(page, () => document.body.dataset.look), colorScheme);
    const first = (await value(page, texts)).found; // one sentence, one slider, three buttons
    assert.ok(first.length >= 7 && first.length <= 10, JSON.stringify(first));
    assert.deepEqual(first.filter(({ contrast }) => contrast < TEXT), []);
    await all(page);
    for (const sheet of ["", "c", "t", "e", "h"]) {
      if (sheet) await page.locator(`[data-own=${sheet}]`).click();
      if (sheet === "c") await until(page, () => document.querySelectorAll(".cards canvas").length === document.querySelectorAll(".cards button").length);
      const { found, drawn } = await value(page, texts);
      assert.ok(found.length > 20, `${found.length}`);
      assert.deepEqual(found.filter(({ contrast }) => contrast < TEXT), [], `sheet ${sheet}`);
      assert.deepEqual(found.filter(({ size }) => size < 12), []);
      // text that is drawn on a canvas is ink, quiet, accent or hold; lines and bars are the rest
      assert.deepEqual(drawn.filter(({ pair, contrast }) => contrast < (/^(ink|quiet|accent|hold|good|bad)/.test(pair) ? TEXT : PARTS)), []);
    }
    for (const bad of [true, false]) {
      await value(page, (wrong) => window.nanotouch.seen.note("something to be read", wrong), bad);
      await until(page, () => document.getElementById("note").textContent === "something to be read");
      assert.deepEqual((await value(page, texts)).found.filter(({ contrast }) => contrast < TEXT), []);
    }
    await page.close();
  });

const shown = "button, a[href], input:not([type=file]), select, textarea, [tabindex='0']";

test("each control that is seen is reached by Tab, with a name and a ring around it", async () => {
  const { page } = await visit(chromium.context, FILE);
  await touched(page);
  for (const sheet of ["first", "", "c", "t", "e", "h"]) { // as it begins, and with all that there is
    if (sheet === "") await all(page);
    else if (sheet !== "first") await page.locator(`[data-own=${sheet}]`).click();
    const wanted = await value(page, (what) => [...document.querySelectorAll(what)]
      .filter((one) => !one.disabled && one.checkVisibility({ visibilityProperty: true })).map((one, i) => (one.dataset.walked = `${i}`)), shown);
    await value(page, () => document.activeElement.blur());
    const reached = new Set();
    for (let i = 0; i < 2 * wanted.length + 4 && reached.size < wanted.length; ++i) { // it may begin in the middle
      await page.keyboard.press("Tab");
      const at = await value(page, () => {
        const one = document.activeElement, style = getComputedStyle(one);
        return { walked: one.dataset.walked, ring: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2,
          name: one === document.body ? "" : one.getAttribute("aria-label") || one.labels?.[0]?.textContent || one.textContent };
      });
      if (!at.walked) continue; // between the last one and the first: the browser's own
      assert.ok(at.name?.trim(), `control ${at.walked} of sheet ${sheet} has a name`);
      assert.ok(at.ring, `${at.name} shows that it has the focus`);
      reached.add(at.walked);
    }
    assert.deepEqual([...reached].sort(), wanted.sort(), `sheet ${sheet}`);
    if (sheet.length === 1) { // and a sheet is left by the keyboard, without a stop of the session
      await page.keyboard.press("Escape");
      await until(page, () => document.getElementById("sheet").hidden);
      assert.equal(await value(page, () => window.nanotouch.seen.now.state), 0);
    }
    await value(page, () => { for (const one of document.querySelectorAll("[data-walked]")) delete one.dataset.walked; });
  }
  await page.close();
});

test("on a phone view, first slider and force curve are whole on the first screen", async () => {
  const { page } = await visit(chromium.context, FILE);
  for (const size of [{ width: 390, height: 844 }, { width: 360, height: 640 }]) {
    await page.setViewportSize(size);
    await touched(page);
    await page.waitForTimeout(300);
    const [law, view, footer, sliders] = await value(page, () => ["law", "view", "facts", "sliders"].map((id) => {
      const { left, right, top, bottom } = (id === "facts" ? document.querySelector("footer") : document.getElementById(id)).getBoundingClientRect();
      return { left, right, top, bottom };
    }));
    assert.ok(law.bottom <= footer.top && view.bottom <= sliders.top && sliders.bottom <= law.top, JSON.stringify({ law, view, footer, sliders }));
    assert.ok(footer.bottom <= size.height && [law, view, footer].every(({ left, right }) => left >= 0 && right <= size.width));
    assert.ok(law.bottom - law.top >= 140 && view.bottom - view.top >= 180, JSON.stringify({ law, view }));
  }
  await page.close();
});

test("what is seen is said, too: state, notes and what the session tells have a role", async () => {
  const { page } = await visit(chromium.context, FILE);
  await touched(page);
  for (const id of ["clock", "note"]) assert.equal(await page.locator(`#${id}`).getAttribute("role"), "status");
  assert.equal(await page.locator("#view").getAttribute("role"), "application");
  assert.match(await page.locator("#view").getAttribute("aria-label"), /arrows/);
  assert.equal(await value(page, () => document.documentElement.lang), "en");
  await page.close();
});

test("where less motion is asked for, nothing glides: the magnified contact is at its scale at once", async () => {
  const scales = {};
  for (const reducedMotion of ["reduce", "no-preference"]) {
    const { page } = await visit(chromium.context, "about:blank");
    await page.emulateMedia({ reducedMotion });
    await page.goto(FILE);
    await touched(page);
    await page.focus("#view");
    const widths = new Set();
    for (let i = 0; i < 400 && !(await value(page, () => window.nanotouch.seen.now.force > 2e-8)); ++i) {
      await page.keyboard.press("PageDown");
      widths.add(await value(page, () => window.nanotouch.lens.contact.halfWidth));
    }
    widths.delete(0);
    const least = Math.min(...widths);
    scales[reducedMotion] = [...widths].map((width) => Math.log2(width / least));
    const glides = await value(page, () => getComputedStyle(document.getElementById("view")).transitionDuration);
    assert.equal(glides, reducedMotion === "reduce" ? "0s" : "0.1s");
    await page.close();
  }
  const between = (steps) => steps.filter((step) => Math.abs(step - Math.round(step)) > 1e-9).length;
  assert.equal(between(scales.reduce), 0, `${scales.reduce}`);
  assert.ok(between(scales["no-preference"]) > 0, `${scales["no-preference"]}`);
});
