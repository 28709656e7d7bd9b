// SPDX-License-Identifier: BSD-3-Clause
// The page: what is seen and heard of a session in its worker, behind a socket or in a notebook's kernel.

import { ForceGap, History } from "./charts.js";
import { ContactPanel } from "./contact.js";
import { Drop } from "./drop.js";
import { Hands } from "./hands.js";
import { Input } from "./input.js";
import { Lens } from "./lens.js";
import { Framed, Socketed, Worked } from "./link.js";
import { Overlay } from "./overlay.js";
import { Painter } from "./painter.js";
import { fromFragment, toToml } from "./scenefile.js";
import { Seen } from "./seen.js";
import { Sliders } from "./sliders.js";
import { Stage } from "./stage.js";
import { byId, Words } from "./words.js";

const FRAMED = "nanotouch-framed"; // the name of a frame in a notebook
const table = JSON.parse(byId("table").textContent);
const FIRST = table.presets[0].name; // where nothing is named
const fragment = (() => {
  try {
    return fromFragment(location.hash);
  } catch (error) {
    return new URLSearchParams({ wrong: error.message });
  }
})();
const framed = window.name === FRAMED && window.parent !== window;
const served = /^https?:$/.test(location.protocol), key = served && fragment.get("key"); // a session is where the page came from
const state = { own: !framed && !key, fields: null, note: (text) => seen.note(text, true) };
const counters = { draws: 0, updates: 0, bytes: 0, messages: 0, firstTouch: NaN };
const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
const KEPT = 200, asked = []; // of what was asked last
let dirty = true, palette = null, task = fragment.get("task");

// --- the parts ---

const handed = { hear, take };
const worked = new Worked(byId("worker").textContent, handed);
const link = state.own ? worked : framed ? new Framed(handed) : new Socketed(key, handed);
const seen = new Seen(table.constants, (message) => worked.draw(message), (heights, dent) => {
  stage.reshape(heights, dent);
  dirty = true;
});
const stage = new Stage(byId("view").insertBefore(document.createElement("div"), byId("overlay")), table.constants);
const painter = (id) => new Painter(byId(id));
const drawnBy = (message) => worked.draw(message), lens = new Lens(drawnBy);
const overlay = new Overlay(painter("overlay"), lens, table.constants);
const contact = new ContactPanel(painter("contact"), drawnBy);
const law = new ForceGap(painter("law")), chart = new History(painter("history"), table.constants);
const words = new Words(table, ask), sliders = new Sliders(byId("sliders"), table, ask);
const drop = new Drop(table, words, { ask, draw: (message) => worked.draw(message),
  open: link.open && ((file) => link.open(file)) }, state);
if (link.open) byId("file").removeAttribute("accept"); // all formats are read where the session is
const hands = new Hands((message) => { by("pad"); ask(message); }, (text) => seen.note(text, false));
const device = matchMedia("(pointer: coarse)").matches ? "finger" : "wheel";

function ask(message) {
  if (message.note) return seen.note(message.note, true);
  seen.asks(message.do);
  if (message.do === "change") seen.waiting.add(message.field);
  asked.push(message);
  if (asked.length > KEPT) asked.shift();
  return link.ask(message);
}

// What the hand is moved with: hints follow it.
function by(name) {
  if (name === document.body.dataset.device) return;
  document.body.dataset.device = name;
  ask({ do: "device", name });
}

function take(now, bytes) {
  counters.updates += 1;
  counters.bytes += bytes;
  seen.take(now);
  if (!(counters.firstTouch >= 0) && seen.world) counters.firstTouch = performance.now();
  dirty = true;
}

function hear(message) {
  counters.messages += 1;
  if (message.tell === "ready") return begin(message);
  seen.hear(message);
  if (message.tell === "laid") {
    state.given = false;
    lay(message.surface);
  }
  if (message.tell === "particles" && stage.grid) stage.balls.show(message, stage.grid);
  if (message.tell === "sliders") sliders.lay(message.sliders);
  if (message.tell === "world") {
    sliders.take(message);
    stage.mount(message.scene.tip);
    document.body.classList.toggle("watched", "leads" in message); // no samples, tasks or pauses of another program
    if (task && state.own) ask({ do: "task", name: task, lay: true });
    task = null;
  }
  if (message.tell === "granted") {
    if (message.operates) ask({ do: "device", name: document.body.dataset.device ?? device });
    else seen.note("You watch: another one holds the hand.", false);
  }
  if (message.tell === "refused") {
    sliders.refused(message.field);
    if (state.given) ask({ do: "preset", name: FIRST }); // what the link names cannot be opened
    state.given = false;
  }
  dirty = true;
  return undefined;
}

function lay(surface) {
  stage.lay(surface);
  contact.forget();
  lens.forget();
}

// The library is there: the first sample, or what the link says.
function begin({ fields }) {
  state.fields = fields;
  by(device);
  if (!state.own) return;
  const preset = fragment.get("preset") ?? FIRST, scene = fragment.get("scene");
  let laid = false;
  try {
    if (fragment.has("wrong")) throw new Error(fragment.get("wrong"));
    if (scene) {
      drop.scene(scene, "The scene of this link", preset);
      laid = state.given = true;
    }
  } catch (error) {
    seen.note(`the scene of this link is refused: ${error.message}`, true);
  }
  const known = table.presets.some((one) => one.name === preset);
  if (!known) seen.note(`there is no sample ${preset.slice(0, 40)}: this is ${table.presets[0].title}`, true);
  if (!laid) ask({ do: "preset", name: known ? preset : FIRST });
  if (!served && fragment.get("key")) seen.note("a key opens a running session where its link leads; this is the page alone", true);
}

// --- light, keys ---

function dress(name) {
  palette = table.palettes[name];
  for (const [part, colour] of Object.entries(palette))
    if (part !== "heights") document.documentElement.style.setProperty(`--${part}`, `rgb(${colour.join(",")})`);
  document.documentElement.style.setProperty("--heights", palette.heights.map(String).join("|"));
  document.documentElement.style.colorScheme = name;
  document.body.dataset.look = name;
  stage.paint(palette);
  dirty = true;
}

const OWN = {
  c: () => words.cards(seen.world?.title, () => byId("file").click()),
  t: () => words.tasks(),
  d: () => showAll(!showsAll()),
  h: () => words.help(),
  l: () => dress(document.body.dataset.look === "light" ? "dark" : "light"),
  "+": () => stage.grid && stage.raiseHeights(true),
  "-": () => stage.grid && stage.raiseHeights(false),
  m: () => hands.turnSound(),
  g: () => hands.connectSpaceMouse().catch((error) => seen.note(error.message, true)),
  s: savePicture,
  k: () => {
    if (stage.grid) seen.note(stage.colourByNext() === "height" && Object.keys(stage.maps).length === 1
      ? "each place has the properties of the scene: drop a GSF of Pa or J/m^2 to give them others" : `coloured by ${named(stage.shown)}`, false);
  },
  n: () => byId("answer")?.focus(),
  e: () => seen.world && words.scene(sceneText(), (text) => taken(text), copyLink),
};

// It begins with one sentence, one slider, one chart; all else by one button.
const showsAll = () => document.body.classList.contains("all");
function showAll(on) {
  document.body.classList.toggle("all", on);
  const button = document.querySelector("[data-own=d]");
  button.setAttribute("aria-expanded", String(on));
  button.textContent = on ? "Less" : "More";
}

const named = (what) => table.constants.PROPERTY_NAMES[what]?.[0] ?? what;

function own(name, event) {
  if (/^[0-5]$/.test(name)) stage.camera(name, seen.now && stage.apex(seen.now));
  else if (/^F[1-7]$/.test(name) && seen.task.name) ask({ do: "choose", number: Number(name[1]) - 1 });
  else if (OWN[name]) OWN[name](event);
  else return false;
  dirty = true;
  return true;
}

function sceneText() {
  const usual = table.presets.find((one) => one.title === seen.world.title) ?? table.presets[0];
  const { scene, rig } = seen.world, written = { scene, rig: { ...rig } };
  delete written.rig.master; // the hand of this page
  return toToml(written, usual, state.fields, table.units);
}

function taken(text) {
  try {
    drop.scene(text, "Your scene", seen.world.preset);
  } catch (error) {
    seen.note(error.message, true);
  }
}

async function copyLink(text) {
  const parts = new URLSearchParams({ preset: seen.world.preset || FIRST });
  if (text.trim()) parts.set("scene", text);
  location.hash = parts.toString();
  try {
    await navigator.clipboard.writeText(location.href);
    seen.note("the link is copied; it holds the whole scene", false);
  } catch {
    seen.note("the link stands in the address line; it holds the whole scene", false);
  }
}

async function savePicture() {
  stage.render();
  const made = document.createElement("canvas"), below = byId("view").querySelector("canvas"), above = byId("overlay");
  Object.assign(made, { width: below.width, height: below.height });
  const context = made.getContext("2d");
  for (const canvas of [below, above]) context.drawImage(canvas, 0, 0, made.width, made.height);
  Object.assign(document.createElement("a"), { href: made.toDataURL("image/png"), download: "nanotouch.png" }).click();
}

const reach = (pixels) => (seen.now && stage.grid ? stage.dragged(stage.apex(seen.now), pixels) : [0, 0]);
const turn = (dx, dy) => { stage.turn(dx, dy); dirty = true; };
const magnify = (steps) => { if (stage.grid) seen.note(`${Number(stage.magnify(steps).toPrecision(3))} times as large`, false); };
const lifts = () => (seen.world?.leads ?? "xyz").includes("z");
new Input(byId("view"), { ask: (message) => {
  if (message.do === "stop" && words.close()) return;
  ask(message);
}, reach, turn, magnify, lifts, own, by });
for (const gesture of ["pointerdown", "keydown"]) window.addEventListener(gesture, () => hands.wake(), { once: true, capture: true });
for (const button of document.querySelectorAll("[data-act]")) button.onclick = () => ask({ do: button.dataset.act });
for (const button of document.querySelectorAll("[data-own]")) button.onclick = (event) => own(button.dataset.own, event);
new ResizeObserver(() => { stage.resize(); dirty = true; }).observe(byId("view"));

// --- drawing: only what is new ---

let worded = 0;
function draw(now) {
  requestAnimationFrame(draw);
  hands.turn(seen.world?.size?.[0] ?? 0, seen.feel(), now);
  if (now - worded > 200) {
    worded = now;
    words.draw(seen);
    words.task(seen);
  }
  if (!dirty || document.hidden) return;
  dirty = false;
  const { hides } = seen;
  if (seen.now && seen.world) stage.update(seen.now, seen);
  stage.lights(!hides.has("surface"));
  byId("lights").hidden = stage.works && !hides.has("surface");
  for (const [name, id] of [["contact", "contact"], ["law", "law"], ["sliders", "sliders"]])
    byId(id).style.visibility = hides.has(name) ? "hidden" : "visible";
  if (stage.grid) stage.render();
  dirty = overlay.draw(seen, stage, palette, { still, all: showsAll() });
  contact.draw(seen, palette, still);
  law.draw(seen, palette);
  chart.draw(seen, palette);
  counters.draws += 1;
}

// --- begin ---

if (!stage.works) byId("lights").textContent = "This browser gives no WebGL 2: the surface is not drawn. The hand and the charts work.";
dress(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
const wasm = Uint8Array.from(atob(byId("wasm").textContent), (letter) => letter.charCodeAt(0));
worked.begin({ wasm, own: state.own, table: { ...table, palettes: null, help: null } });
window.nanotouch = { seen, counters, stage, lens, asked }; // to look at, as the tests do
requestAnimationFrame(draw);
