// SPDX-License-Identifier: BSD-3-Clause
// The session that a person touches in this page. What a hand, sliders, tasks and words are is the C library's
// (nanotouch/host.h, docs/host.md); here are the session itself and its pace.

import { KINDS, Refused, readUpdate, UPDATE_BYTES } from "./core.js";
import { edged, extremes, ofPreset, PROPERTIES, stretched } from "./subject.js";
import { parseQuantity } from "./units.js";

const MARGIN = 1.5, USUAL_ACCURACY = 0.01;
const LONGEST = 0.03; // of session time that one turn may run [s]: behind that, it slows down visibly
const PUSHED = ["", "particles", "rod"];

export class Host {
  constructor(core, table, tell) {
    Object.assign(this, { core, table, tell, speed: 1, paused: false, slowdown: 1, changes: 0, subject: null, now: null });
    this.constants = table.constants;
  }

  // --- opening ---

  async layPreset(name) { this.lay(await ofPreset(this.table, name)); }

  // Another sample under another tip: a session of its own.
  lay(subject) {
    const { core } = this, { map } = subject, scene = structuredClone(subject.scene), rig = structuredClone(subject.rig);
    const size = [map.columns * map.dx, map.rows * map.dy];
    this.#open(subject, scene, rig, size, null);
    Object.assign(this, { subject, scene, rig, size });
    core.withTexts([subject.name, subject.title, subject.hint, "simulated in this page"], (texts) =>
      core.withDoubles(2, size, (at) => core.c.page_host_lay(texts, at, PUSHED.indexOf(subject.pushed ?? ""))));
    this.#begin();
    const { heights, rows, columns, dx, dy } = map, properties = {};
    for (const [name, values] of Object.entries(subject.properties ?? {})) properties[name] = Float32Array.from(values);
    this.tell({ tell: "laid", surface: { heights: Float32Array.from(heights), rows, columns, dx, dy, properties } });
  }

  // Scene, rig and heights as they shall be; clearance null: chosen for this sample.
  #open(subject, scene, rig, size, clearance) {
    const { core } = this, { map } = subject, [low, high] = extremes(map.heights);
    core.c.page_defaults();
    core.take("scene", scene);
    core.take("rig", rig);
    core.c.page_accuracy(subject.accuracy ?? USUAL_ACCURACY);
    core.withDoubles(5, [...size, high - low, clearance ?? 0, clearance === null ? 0 : 1],
      (at) => core.check(core.c.page_compose(at)));
    core.checkAll();
    const rows = map.rows + 1, columns = map.columns + 1; // the extent is that of the pixels
    const padded = edged(map.heights, map);
    const line = Array.from({ length: 200 }, (_, i) => padded[(map.rows >> 1) * columns +
      Math.floor((0.5 + (0.1 * i) / 199) * map.columns)]);
    this.#giveProperties(subject, rows, columns);
    this.#givePushed("page_particles", subject.particles, scene.tip);
    this.#givePushed("page_rod", subject.rod, scene.tip);
    core.withDoubles(padded.length + 8, null, (at) => {
      const all = core.doubles(at, padded.length + 8);
      all.set([0.5 * size[0], 0.5 * size[1], core.c.page_clearance(), Math.max(...line) - line[0], map.dx, map.dy, 1, MARGIN]);
      all.set(padded, 8);
      core.check(core.c.page_open(at + 64, columns, rows, at));
    });
  }

  #begin() {
    const { core } = this;
    this.clearance = core.c.page_clearance();
    core.check(core.c.page_host_open());
    this.debt = 0;
    ++this.changes;
    core.check(core.c.page_run(1));
    this.#look();
  }

  #giveProperties({ map, properties = {} }, rows, columns) {
    const { core } = this, count = rows * columns;
    const given = PROPERTIES.map((name) => properties[name] && edged(properties[name], map));
    core.withDoubles(2 * count, null, (at) => {
      given.forEach((values, i) => { if (values) core.doubles(at + 8 * count * i, count).set(values); });
      core.check(core.c.page_properties(...given.map((values, i) => (values ? at + 8 * count * i : 0)), columns, rows));
    });
  }

  // What can be pushed; what depends on the tip follows it.
  #givePushed(give, pushed, { radius, half_angle: halfAngle }) {
    const values = [...(pushed?.values ?? [])];
    for (const [names, now] of [["radius", radius], ["half_angle", halfAngle]]) {
      const [first] = pushed?.with_tip[names] ?? [], factor = now / values[first];
      for (const number of pushed?.with_tip[names] ?? []) values[number] *= factor;
    }
    this.core.withDoubles(values.length, values, (at) => this.core.check(this.core.c[give](at, values.length)));
  }

  // --- what happens by itself ---

  // Run what is due; `elapsed` on the clock since the last turn [s].
  turn(elapsed) {
    if (!this.subject) return;
    const { core } = this;
    if (!this.paused) {
      const wanted = elapsed * this.speed, run = Math.min(wanted, LONGEST);
      this.slowdown += 0.05 * (wanted / Math.max(run, 1e-9) - this.slowdown);
      this.debt += run * core.get("settings").gains.rate;
      const ticks = Math.floor(this.debt);
      this.debt -= ticks;
      if (ticks > 0) core.check(core.c.page_run(ticks));
      this.#look();
      core.c.page_host_follow(run);
    }
    this.#tellAll();
  }

  #look() {
    const at = this.core.c.page_update_of();
    new DataView(this.core.c.memory.buffer).setUint32(at + 8, this.changes, true);
    this.now = readUpdate(this.core.c.memory.buffer, at);
  }

  // The update since the last one that was taken, as its bytes.
  take() {
    const at = this.core.c.page_update_of();
    const bytes = this.core.c.memory.buffer.slice(at, at + UPDATE_BYTES);
    this.core.c.page_taken();
    return bytes;
  }

  // What C has to tell.
  #tellAll() {
    const { core } = this;
    for (let at = core.c.page_host_tell(); at; at = core.c.page_host_tell()) {
      const message = JSON.parse(core.text(at));
      if (message.tell === "world") {
        const key = JSON.stringify([message.scene, message.settings]);
        if (key !== this.key) core.c.page_changed(); // a snapshot belongs to the world that it was taken in
        Object.assign(this, { key, scene: message.scene });
        message.changes = ++this.changes;
        this.world = message;
      }
      if (message.tell === "task" && "passed" in message) message.csv = this.#result();
      this.tell(message);
    }
  }

  #result() {
    const { core } = this;
    let made = "";
    for (let at = core.c.page_host_result(1); at; at = core.c.page_host_result(0)) made += core.text(at);
    return made;
  }

  clock() {
    const { core } = this, given = this.subject.properties ?? {};
    const [, radius, ...places] = core.withDoubles(4, null, (at) => {
      core.c.page_place(this.now.tip[0], this.now.tip[1], at);
      return [...core.doubles(at, 4)];
    });
    const here = { radius };
    PROPERTIES.forEach((name, i) => { if (given[name]) here[name] = places[i]; });
    const [height, undo, ...energies] = core.withDoubles(6, null, (at) => {
      core.c.page_host_state(at);
      return [...core.doubles(at, 6)];
    });
    return { tell: "clock", speed: this.speed, paused: this.paused, slowdown: this.slowdown, recorded: false, undo, height, here, energies,
      facts: core.text(core.c.page_host_facts()) };
  }

  // --- what is asked ---

  async answer(message) {
    try {
      const own = this[`do_${message.do}`];
      await (own ? own.call(this, message) : this.#ask(message));
    } catch (error) {
      if (!(error instanceof Refused)) console.warn(error);
      this.core.withTexts([error.message], (texts) => this.core.c.page_host_refuse(this.core.pointer(texts)));
    }
    this.#tellAll();
  }

  // Left to C; another session is opened where it wants one.
  async #ask(message) {
    const { core } = this, { VALUES } = this.constants;
    const given = message.do === "task" ? [Number(message.lay ?? false), message.seed ?? Date.now()]
      : message.way ?? VALUES.filter((name) => name in message).map((name) => Number(message[name]));
    const known = core.withTexts([message.do, message.field ?? message.name ?? ""], (texts) =>
      core.withDoubles(3, [...given, 0, 0, 0].slice(0, 3), (at) =>
        core.c.page_host_ask(core.pointer(texts), core.pointer(texts + 4), at)));
    if (!known) throw new Refused(`this page cannot ${message.do}`);
    const wants = core.c.page_host_wants(), reopens = core.c.page_host_reopens();
    if (wants) await this.layPreset(core.text(wants));
    if (reopens) this.#reopen(core.text(reopens), core.c.page_host_reopens_to());
  }

  // Lever and tip are the instrument itself: another one is mounted, and the touch begins above the surface.
  #reopen(field, value) {
    const [section, key] = field.split("."), scene = structuredClone(this.scene), rig = structuredClone(this.rig);
    (section in scene ? scene : rig)[section][key] = value;
    this.#open(this.subject, scene, rig, this.size, this.clearance);
    Object.assign(this, { scene, rig });
    this.#begin();
  }

  do_say({ text }) {
    const running = this.core.text(this.core.c.page_host_task()), unit = this.table.tasks.find(({ name }) => name === running)?.asked;
    let value = 0;
    try {
      if (unit) value = parseQuantity(text, unit, this.table.units);
    } catch (error) {
      throw new Refused(error.message);
    }
    return this.#ask({ do: "say", value });
  }
  do_stop() { this.core.c.page_stop(); }
  async do_arm() {
    this.core.check(this.core.c.page_arm());
    await this.#ask({ do: "rest" });
  }
  do_pause() { this.paused = !this.paused; }
  do_step() {
    this.paused = true;
    this.core.check(this.core.c.page_run(this.constants.STEP_TICKS));
    this.#look();
  }
  do_slower() { this.#setSpeed(-1); }
  do_faster() { this.#setSpeed(1); }
  #setSpeed(way) {
    const { SPEEDS } = this.constants, at = SPEEDS.indexOf(this.speed) + way;
    this.speed = SPEEDS[Math.min(Math.max(at, 0), SPEEDS.length - 1)];
  }
  async do_rewind() {
    if (this.core.c.page_rewind(this.constants.REWIND))
      throw new Refused(`nothing is kept from ${this.constants.REWIND} s ago: the touch, or what was changed last, is younger`);
    this.#look();
    await this.#ask({ do: "resume" });
  }
  async do_preset({ name }) { await this.layPreset(name); }
  do_lay({ subject }) { this.lay(subject); }
  // A map of a property is stretched over the surface that is shown.
  do_property({ name, map, title }) {
    const properties = { ...this.subject.properties, [name]: stretched(map, this.subject.map) };
    this.lay({ ...this.subject, properties, hint: `${title}: K colours by it. Drag from a low place to a high one at a steady force.` });
  }
}
