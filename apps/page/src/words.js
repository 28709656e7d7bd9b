// SPDX-License-Identifier: BSD-3-Clause
// What stands in words: title, state, facts, notes, cards, tasks, help. Everything is text to the browser, never markup.

import { unpack } from "./subject.js";
import { digits } from "./units.js";

export const byId = (id) => document.getElementById(id);
export function element(name, about = {}, ...children) {
  const made = Object.assign(document.createElement(name), about);
  made.append(...children);
  return made;
}

function download(name, text) {
  const address = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  element("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

const SMALL = 56; // side of a thumbnail [pixels]

// The surface of a sample, from above, by the colours of heights.
async function thumbnail(surface) {
  const { heights, rows, columns } = await unpack(surface), canvas = element("canvas", { width: SMALL, height: SMALL });
  const table = getComputedStyle(document.documentElement).getPropertyValue("--heights").split("|").map((one) => one.split(",").map(Number));
  const context = canvas.getContext("2d"), image = context.createImageData(SMALL, SMALL), low = surface.low, size = surface.step * 65535;
  for (let at = 0; at < SMALL * SMALL; ++at) {
    const row = Math.floor(((SMALL - 1 - Math.floor(at / SMALL)) * rows) / SMALL), column = Math.floor(((at % SMALL) * columns) / SMALL);
    const place = ((heights[row * columns + column] - low) / size) * (table.length - 1), i = Math.min(Math.floor(place), table.length - 2);
    image.data.set([...table[i].map((part, k) => part + (place - i) * (table[i + 1][k] - part)), 255], 4 * at);
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

const STATES = ["good", "hold", "bad", "bad"];

export class Words {
  constructor(table, ask) { Object.assign(this, { table, ask, told: "", shownTask: "", readAt: null }); }

  // Five times a second at most: the reading is renewed so often.
  draw(seen) {
    byId("age").textContent = `frame ${(1000 * Math.min(seen.age, 9.999)).toFixed(0)} ms old · ${seen.updates} updates`;
    this.#notes(seen);
    document.body.classList.toggle("stale", seen.stale);
    if (!seen.world || !seen.now) return;
    const { clock, world } = seen, slow = clock.slowdown > 1.05 && !clock.paused ? ` · machine slow: ${clock.slowdown.toFixed(1)} times` : "";
    byId("title").textContent = world.title;
    if (byId("guide").textContent !== seen.guide) byId("guide").textContent = seen.guide;
    document.title = `${world.title} · nanotouch`;
    byId("about").textContent = [world.source ?? "simulated", world.felt].filter(Boolean).join("  ·  ");
    byId("clock").textContent = `${clock.paused ? "PAUSED " : ""}${clock.speed}x${slow}${clock.recorded ? " · rec" : ""}`;
    document.querySelector("[data-act=pause]").textContent = clock.paused ? "Go on" : "Pause";
    document.querySelector("[data-act=undo]").disabled = !(clock.undo ?? world.undo); // what the tip leaves can be taken back, too
    const { state, reasons } = seen.now, names = this.table.reasons.filter((_, bit) => (reasons >>> bit) & 1);
    byId("state").textContent = this.table.states[state];
    byId("dot").style.background = `var(--${STATES[state]})`;
    byId("facts").toggleAttribute("data-runs", !state && !seen.stale); // what it is worth to know is among all else
    byId("facts").textContent = seen.stale ? `no frame for ${seen.age.toFixed(1)} s: nothing is felt`
      : state ? `${names.join(", ") || "stopped"}. Enter: go on` : clock.facts ?? "";
  }

  #notes(seen) {
    const last = seen.notes.findLast((note) => performance.now() - note.at < 1000 * this.table.constants.NOTED);
    const words = last?.text ?? "";
    if (words === this.told) return;
    this.told = words;
    Object.assign(byId("note"), { textContent: words, className: !last ? "" : last.bad ? "bad" : "told" });
  }

  // --- tasks ---

  task(seen) {
    const { task } = seen, key = JSON.stringify([task.name, task.words, task.now, task.choices, task.asked]);
    if (key === this.shownTask) return;
    const renew = task.asked && byId("answer");
    this.shownTask = key;
    const board = byId("board");
    board.hidden = !task.name;
    if (!task.name) return;
    if (renew && board.dataset.task === task.name) {
      board.querySelector(".now").textContent = task.now;
      return;
    }
    board.dataset.task = task.name;
    const score = task.scored
      ? [element("p", { textContent: `${task.passed ? "passed" : "not passed"}, ${task.score.toFixed(0)} of 100` })] : [];
    board.replaceChildren(element("h2", { textContent: task.title }), ...score, element("p", { textContent: task.words }),
      element("p", { textContent: task.now, className: "now quiet" }), this.#choices(task.choices), ...this.#answer(task), ...this.#saved(task),
      element("button", { textContent: "End", onclick: () => this.ask({ do: "task", name: "" }) }));
  }

  #choices(choices) {
    return element("div", { className: "choices" }, ...choices.map((words, number) =>
      element("button", { onclick: () => this.ask({ do: "choose", number }) }, element("kbd", { textContent: `F${number + 1}` }), words)));
  }

  // The file of the result: here it is offered, elsewhere it has been written.
  #saved({ name, csv, saved }) {
    if (csv) return [element("button", { textContent: "Save the result (CSV)", onclick: () => download(`nanotouch-${name}.csv`, csv) })];
    return saved ? [element("p", { className: "quiet", textContent: saved })] : [];
  }

  #answer({ asked }) {
    if (!asked) return [];
    const input = element("input", { type: "text", id: "answer", className: "number", size: 10 });
    input.style.border = "1px solid var(--line)";
    input.setAttribute("aria-label", "your answer, with its unit");
    const send = () => this.ask({ do: "say", text: input.value });
    input.addEventListener("keydown", ({ key }) => { if (key === "Enter") send(); });
    return [element("p", {}, "Your answer: ", input, element("button", { textContent: "Say it", onclick: send }))];
  }

  // --- sheets: one at a time ---

  #sheet(name, ...children) {
    const sheet = byId("sheet"), shown = !sheet.hidden && sheet.dataset.name === name;
    for (const button of document.querySelectorAll("[data-own]")) button.setAttribute("aria-expanded", "false");
    sheet.hidden = shown;
    if (shown) return byId("view").focus({ preventScroll: true });
    sheet.dataset.name = name;
    sheet.replaceChildren(...children);
    document.querySelector(`[data-own=${name}]`)?.setAttribute("aria-expanded", "true");
    return sheet.querySelector("button, textarea, input")?.focus({ preventScroll: true });
  }

  close() {
    const open = !byId("sheet").hidden;
    byId("sheet").hidden = true;
    for (const button of document.querySelectorAll("[data-own]")) button.setAttribute("aria-expanded", "false");
    return open;
  }

  cards(current, open) {
    const card = ({ name, title, hint, felt, surface }) => {
      const made = element("button", { onclick: () => { this.close(); this.ask({ do: "preset", name }); } },
        element("b", { textContent: title }), element("i", { textContent: hint }), element("small", { textContent: felt }));
      made.setAttribute("aria-current", String(title === current));
      thumbnail(surface).then((picture) => made.prepend(picture));
      return made;
    };
    this.#sheet("c", element("h2", { textContent: "What to touch" }), element("p", {},
      element("button", { textContent: "Open a file: image, curve, scene", onclick: open })),
      element("div", { className: "cards" }, ...this.table.presets.map(card)));
  }

  tasks() {
    const begin = (name) => () => { this.close(); this.ask({ do: "task", name, lay: true }); };
    const all = [...this.table.tasks.filter((one) => !one.is_page).map(({ name, title }) => [name, title]), ["", "No task"]];
    this.#sheet("t", element("h2", { textContent: "What to learn" }), element("div", { className: "choices" },
      ...all.map(([name, words]) => element("button", { textContent: words, onclick: begin(name) }))));
  }

  help() {
    this.#sheet("h", element("h2", { textContent: "Mouse, touch screen and keys" }),
      element("dl", {}, ...[...this.table.help.filter(([key]) => key !== "Q"), ["one finger, two fingers", "over the surface; down and up"], ["one finger on the bar", "down and up"],
        ["E", "the scene as text and as a link"], ["G", "connect a SpaceMouse"]].flatMap(([key, does]) =>
        [element("dt", { textContent: key }), element("dd", { textContent: does })])));
  }

  scene(text, take, link) {
    const area = element("textarea", { value: text, spellcheck: false });
    area.setAttribute("aria-label", "the scene as TOML");
    this.#sheet("e", element("h2", { textContent: "The scene as text" }),
      element("p", { className: "quiet", textContent: "Every key carries its unit, as radius_nm. What is not named keeps the value of the sample." }), area,
      element("p", {}, element("button", { textContent: "Touch it", onclick: () => take(area.value) }), " ",
        element("button", { textContent: "Copy as a link", onclick: () => link(area.value) })));
  }

  // What must be known of a file before it can be touched: fields with a default; then take({name: text}).
  form(title, lines, fields, take) {
    const inputs = fields.map(([name, words, value]) => {
      const input = element("input", { type: "text", className: "number", value, name });
      input.style.border = "1px solid var(--line)";
      return element("label", {}, `${words} `, input);
    });
    const given = () => Object.fromEntries(inputs.map((label) => [label.lastChild.name, label.lastChild.value]));
    byId("sheet").hidden = true;
    this.#sheet("form", element("h2", { textContent: title }), ...lines,
      ...inputs.map((label) => element("p", {}, label)), element("button", { textContent: "Touch it", onclick: () => take(given()) }));
  }

  facts(rows) {
    return element("table", {}, element("tbody", {}, ...rows.map(([name, value]) =>
      element("tr", {}, element("td", { textContent: name }), element("td", { textContent: value })))));
  }
}
