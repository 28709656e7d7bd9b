// SPDX-License-Identifier: BSD-3-Clause
// The session that a person touches in this page, and what the front end may ask of it by a message with "do". It is
// told messages with "tell": the same as nanotouch_app/live/host.py, so that the front end does not know which it has.

import { KINDS, Refused, readUpdate, UPDATE_BYTES } from "./core.js";
import { Hand } from "./hand.js";
import { Balls, Dents } from "./left.js";
import { inWords } from "./refusals.js";
import { edged, extremes, ofPreset, PROPERTIES, stretched } from "./subject.js";
import { Trainer } from "./trainer.js";
import { digits } from "./units.js";

const INDENTATION = 0.3e-6, ATTRACTION = 0.6e-6, USUAL_CLEARANCE = 0.1e-6; // Eq. 21 and the paper's ranges [m], [N], [m]
const FELT = 0.3, SEEN = 0.93; // a force at the hand that nobody misses [N]; of a pull-off that a loop shows at least
const LEAST_CLEARANCE = 20e-9; // [m]
const USUAL_ACCURACY = 0.01, SCALES = ["gains.alpha_p", "gains.alpha_f"];
const HIGHEST = 1e-3; // relief of a surface [m]
const MARGIN = 1.5;
const LONGEST = 0.03; // of session time that one turn may run [s]: behind that, it slows down visibly
const OWN = { margin: 0, force: 1, start: 2, master: 3, alpha: 4, bound: 5 };

export class Host {
  constructor(core, table, tell) {
    Object.assign(this, { core, table, tell, speed: 1, paused: false, slowdown: 1, changes: 0, trainer: null });
    this.constants = table.constants;
    this.balls = new Balls(core, table.constants.ASIDE);
    this.dents = new Dents(core, tell);
    this.subject = null;
    this.now = null;
  }

  // --- opening ---

  async layPreset(name) { this.lay(await ofPreset(this.table, name)); }

  // Another sample under another tip: a session of its own.
  lay(subject) {
    const before = [this.subject, this.scene, this.rig, this.overrides, this.clearance];
    this.subject = subject;
    this.scene = structuredClone(subject.scene);
    this.rig = structuredClone(subject.rig);
    this.overrides = {};
    this.clearance = null; // that of the sample as it is laid
    try {
      this.#open();
    } catch (error) {
      [this.subject, this.scene, this.rig, this.overrides, this.clearance] = before;
      throw error;
    }
    this.meant = this.opened;
    this.done = [];
    this.undone = [];
    this.#endTask();
    const { heights, rows, columns, dx, dy } = subject.map, properties = {};
    for (const [name, values] of Object.entries(subject.properties ?? {})) properties[name] = Float32Array.from(values);
    this.tell({ tell: "laid", surface: { heights: Float32Array.from(heights), rows, columns, dx, dy, properties } });
    this.tell(this.world());
  }

  get keepsDents() { return this.opened.sample.dents === "yes"; }

  // What forces are planned for: a little less is asked where a slider leads to what is less well known.
  get accuracy() { return this.subject.accuracy ?? USUAL_ACCURACY; }

  #usual() {
    const { core, constants } = this, { map } = this.subject;
    core.c.page_defaults();
    core.take("scene", this.scene);
    core.take("rig", this.rig);
    core.c.page_accuracy(this.accuracy);
    const facts = core.plan();
    const load = this.scene.range.maximum_load, pull = facts.pull_off_force;
    const [low, high] = extremes(map.heights);
    if (!(high - low <= HIGHEST)) throw new Refused(`the surface is ${digits(high - low, "m")} high: valid is up to ${digits(HIGHEST, "m")}`);
    core.c.page_usual_settings(USUAL_CLEARANCE + INDENTATION + high - low, ATTRACTION);
    const settings = core.get("settings"), { master, probe } = core.get("rig");
    const reach = master.gauge === "yes" ? Math.min(master.gauge_range, master.max_force) : master.max_force;
    const wanted = pull > 0 ? FELT / (SEEN * pull) : Infinity;
    const { gains, limits } = settings;
    gains.alpha_f = Math.max(gains.alpha_f, Math.min(wanted, (2 * reach) / (load + pull)));
    gains.force_gain = 0;
    gains.coupling_stiffness = constants.COUPLING * probe.spring_constant * gains.alpha_p * gains.alpha_f;
    gains.coupling_damping = (gains.coupling_stiffness * constants.SETTLING) / constants.COUPLING;
    const deepest = constants.INDENTATION_SHARE * facts.largest_indentation;
    limits.indentation = Math.max(limits.indentation, deepest);
    this.clearance ??= this.#clearance(facts);
    core.take("settings", settings);
    for (const [name, value] of Object.entries(this.overrides)) core.set("settings", name, value);
    const extent = Math.max(map.columns * map.dx, map.rows * map.dy);
    const { gains: { alpha_p }, limits: { force } } = core.get("settings");
    const soft = (constants.COUPLING / (1 + constants.COUPLING)) * probe.spring_constant, down = this.clearance + high - low + deepest;
    const far = Math.max(constants.LATERAL_REACH * extent, constants.DOWN_REACH * (down + force / soft));
    core.take("rig", { master: { motor: "no", gauge: "no", axes: 3, resolution: 1e-7,
      travel: Math.min(10, Math.max(master.travel, (2 * far) / alpha_p)) } });
    core.checkAll();
    return facts;
  }

  #clearance(facts) {
    const load = Math.max(this.scene.range.maximum_load, facts.pull_off_force);
    const reach = this.core.c.page_cutoff_gap(0.002 * load), { release_gap: release } = facts;
    return Math.max(LEAST_CLEARANCE, 1.5 * Math.min(reach, 1e-6), Number.isFinite(release) ? 2 * release : 0);
  }

  #open() {
    const facts = this.#usual(), { map } = this.subject, { core } = this;
    const rows = map.rows + 1, columns = map.columns + 1; // the extent is that of the pixels
    const padded = edged(map.heights, map);
    this.size = [map.columns * map.dx, map.rows * map.dy];
    this.start = [0.5 * this.size[0], 0.5 * this.size[1]];
    const line = Array.from({ length: 200 }, (_, i) => padded[(map.rows >> 1) * columns +
      Math.floor((0.5 + (0.1 * i) / 199) * map.columns)]);
    const rise = Math.max(...line) - line[0];
    this.#giveProperties(rows, columns);
    this.balls.give(this.subject.particles, this.scene.tip);
    core.withDoubles(padded.length + 8, null, (at) => {
      const all = core.doubles(at, padded.length + 8);
      all.set([...this.start, this.clearance, rise, map.dx, map.dy, 1, MARGIN]);
      all.set(padded, 8);
      core.check(core.c.page_open(at + 64, columns, rows, at));
    });
    this.#learn(facts);
    this.dents.forget();
    this.debt = 0;
    ++this.changes;
    core.check(core.c.page_run(1));
    this.#look();
  }

  #giveProperties(rows, columns) {
    const { core, subject: { map, properties = {} } } = this, count = rows * columns;
    const given = PROPERTIES.map((name) => properties[name] && edged(properties[name], map));
    core.withDoubles(2 * count, null, (at) => {
      given.forEach((values, i) => { if (values) core.doubles(at + 8 * count * i, count).set(values); });
      core.check(core.c.page_properties(...given.map((values, i) => (values ? at + 8 * count * i : 0)), columns, rows));
    });
  }

  // What hand and front end need of the session as it is now.
  #learn(facts) {
    const own = (what) => this.core.c.page_own(what);
    Object.assign(this, { facts, settings: this.core.get("settings"), opened: this.core.get("scene"),
      openedRig: this.core.get("rig") });
    const law = (limit) => this.#sunk(limit), { alpha_p } = this.settings.gains;
    this.hand = new Hand({ scene: this.opened, rig: this.openedRig, settings: this.settings, facts, start: this.start,
      size: this.size, clearance: this.clearance, startHeight: own(OWN.start), masterStart: own(OWN.master),
      sunk: law }, this.constants, (place, duration) => this.core.check(this.core.c.page_hold(...place, duration)));
    this.core.c.page_weigh(this.hand.stiffness, this.hand.zero, alpha_p, this.opened.range.maximum_load);
  }

  // How deep a force presses [m].
  #sunk(limit) {
    const deepest = this.facts.largest_indentation;
    const gaps = Float64Array.from({ length: 400 }, (_, i) => (-1.2 * deepest * (399 - i)) / 399);
    const { F } = this.core.law(gaps, true);
    let at = gaps.length - 1;
    while (at > 0 && F[at] < limit) --at;
    return -gaps[at];
  }

  // --- what happens by itself ---

  // Run what is due; `elapsed` on the clock since the last turn [s].
  turn(elapsed) {
    if (!this.subject) return;
    if (!this.paused) {
      const wanted = elapsed * this.speed, run = Math.min(wanted, LONGEST);
      this.slowdown += 0.05 * (wanted / Math.max(run, 1e-9) - this.slowdown);
      this.debt += run * this.settings.gains.rate;
      const ticks = Math.floor(this.debt);
      this.debt -= ticks;
      if (ticks > 0) this.core.check(this.core.c.page_run(ticks));
      this.#look();
      this.hand.follow(this.now, run);
    }
    if (this.subject.particles) this.balls.look(this.now.time);
    if (this.keepsDents) this.dents.look(this.now);
    if (this.trainer) this.trainer.see(this.now);
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

  world() {
    const own = (what) => this.core.c.page_own(what);
    const { subject } = this;
    return { tell: "world", title: subject.title, felt: subject.felt, hint: subject.hint, preset: subject.name,
      scene: this.opened, rig: this.openedRig, settings: this.settings, stiffness: this.hand.stiffness,
      bound: own(OWN.bound), warnings: this.facts.warnings, terms: this.facts.terms, margin: own(OWN.margin),
      force: own(OWN.force), relative_accuracy: this.accuracy,
      undo: this.undoable, redo: this.undone.length, start: this.start, size: this.size, clearance: this.clearance, zero: this.hand.zero, changes: this.changes, source: "simulated in this page" };
  }

  get undoable() { return this.done.length || this.dents.list.length || this.balls.pushes.length; }

  clock() {
    const { core } = this, given = this.subject.properties ?? {};
    const [, radius, ...places] = core.withDoubles(4, null, (at) => {
      core.c.page_place(this.now.tip[0], this.now.tip[1], at);
      return [...core.doubles(at, 4)];
    });
    const here = { radius };
    PROPERTIES.forEach((name, i) => { if (given[name]) here[name] = places[i]; });
    const energies = core.withDoubles(4, null, (at) => {
      core.c.page_energies(at);
      return [...core.doubles(at, 4)];
    });
    return { tell: "clock", speed: this.speed, paused: this.paused, slowdown: this.slowdown, recorded: false, undo: this.undoable,
      height: this.hand.height, here, energies };
  }

  // --- what is asked ---

  async answer(message) {
    try {
      const act = this[`do_${message.do}`];
      if (!act) throw new Refused(`this page cannot ${message.do}`);
      await act.call(this, message);
    } catch (error) {
      if (!(error instanceof Refused)) console.warn(error);
      this.tell({ tell: "refused", why: error.message, field: message.field });
    }
  }

  #checkUnlocked() {
    if (this.trainer?.locked) throw new Refused("first say what you expect; then you may touch");
  }

  do_move({ way }) {
    this.#checkUnlocked();
    if (!this.hand.move(way, this.now))
      this.tell({ tell: "note", text: "The hand stops here: the force limit is near." });
  }

  do_wheel({ steps }) {
    this.#checkUnlocked();
    this.hand.presses = false;
    this.hand.stepDown(steps, this.now);
  }

  do_press({ on }) {
    if (on) this.#checkUnlocked();
    this.hand.presses = Boolean(on);
    if (!on) this.hand.lift(this.now);
  }

  do_retract() { this.do_press({ on: false }); }
  do_stop() { this.core.c.page_stop(); }
  do_arm() {
    this.core.check(this.core.c.page_arm());
    this.hand.rest(this.now);
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
  do_rewind() {
    if (this.core.c.page_rewind(this.constants.REWIND))
      throw new Refused(`nothing is kept from ${this.constants.REWIND} s ago: the touch, or what was changed last, is younger`);
    this.#look();
    this.balls.rewound(this.now.time);
    this.hand.resume(this.now);
  }
  async do_preset({ name }) { await this.layPreset(name); }
  do_lay({ subject }) { this.lay(subject); }
  // A map of a property is stretched over the surface that is shown.
  do_property({ name, map, title }) {
    const properties = { ...this.subject.properties, [name]: stretched(map, this.subject.map) };
    this.lay({ ...this.subject, properties, hint: `${title}: K colours by it. Drag from a low place to a high one at a steady force.` });
  }

  // --- tasks ---

  async do_task({ name, lay, seed }) {
    this.#endTask();
    if (!name) return;
    const wanted = Trainer.presetOf(this.table, name);
    const isMeant = wanted === this.subject.name && JSON.stringify(this.opened) === JSON.stringify(this.meant);
    const lacks = Trainer.lays(this.table, name) && !this.subject.particles;
    if (lacks || (lay && !isMeant)) await this.layPreset(wanted);
    this.trainer = new Trainer(this, name, seed);
    try {
      if (this.trainer.act.lays) this.balls.lay(this.trainer.act.lays);
    } catch (error) {
      this.#endTask();
      throw error;
    }
  }
  async do_choose({ number }) {
    const follows = this.trainer?.follows;
    if (follows) await this.do_task({ name: follows, lay: true });
    else this.trainer?.choose(number);
  }
  do_say({ text }) { this.trainer?.say(text); }
  #endTask() {
    if (this.trainer?.act.lays) this.tell({ tell: "particles", radius: 0, places: [], targets: [], events: [] });
    if (this.trainer) this.tell({ tell: "task", name: "" });
    this.trainer = null;
  }

  // A task changes the world; that is no entry of the person's history.
  changeForTask(what, field, value) {
    const [section, key] = field.split(".");
    if (what === "scaled") this.#change("settings", field, value * this.settings[section][key]);
    else this.#change(what, field, value);
    this.tell(this.world());
  }

  // --- changes and their history ---

  do_change({ what, field, value }) {
    const [section, key] = field.split(".");
    const old = (what === "scene" ? this.opened : what === "rig" ? this.openedRig : this.settings)[section]?.[key];
    if (old === undefined || !Number.isFinite(value)) throw new Refused(`${field} = ${value}: no such number`);
    if (old !== value) {
      try {
        this.#change(what, field, value);
      } catch (error) {
        throw error instanceof Refused ? new Refused(inWords(this, { field, old, value }, error.message)) : error;
      }
      this.done.push([what, field, old, value]);
      this.undone = [];
    }
    this.tell(this.world());
  }
  do_undo() {
    if (!this.done.length && this.dents.list.length) this.dents.undo();
    else if (!this.done.length) this.balls.undo();
    this.#again(this.done, this.undone, 2);
  }
  do_redo() { this.#again(this.undone, this.done, 3); }
  #again(from, to, which) {
    const entry = from.at(-1);
    if (entry) {
      this.#change(entry[0], entry[1], entry[which]);
      to.push(from.pop());
    }
    this.tell(this.world());
  }

  get leastMargin() { return MARGIN; }
  marginWith(field, value) { return this.core.c.page_margin_with(this.core.field("settings", field).number, value); }

  #change(what, field, value) {
    const described = this[what === "rig" ? "rig" : "scene"], [section, key] = field.split(".");
    if (what === "rig" || field === "tip.radius" || field === "tip.half_angle") {
      if (this.trainer) throw new Refused("another tip or lever: not while a task runs");
      const old = described[section][key];
      described[section][key] = value;
      try {
        this.#open();
      } catch (error) {
        described[section][key] = old;
        throw error;
      }
      return;
    }
    const row = this.core.field(what, field);
    this.core.check(this.core.c.page_change(KINDS.indexOf(what), row.number, value));
    if (what === "scene") described[section][key] = value;
    else if (!SCALES.includes(field)) this.overrides[field] = value; // scales are made for the instrument
    ++this.changes;
    const { place, height, presses } = this.hand;
    this.#learn(this.core.plan());
    Object.assign(this.hand, { place, height, presses });
  }
}
