// SPDX-License-Identifier: BSD-3-Clause
// What the page knows of a session: its updates so far, its world, and the law of that world (live/seen.py).

import { Yields } from "./yields.js";

const PLACE = { radius: ["tip", "radius"], youngs_modulus: ["sample", "youngs_modulus"],
  work_of_adhesion: ["adhesion", "work_of_adhesion"] };
const DIFFERS = 0.03, REPLACED = 500; // relative; [ms]

export class Seen {
  // draw: asks the worker; reshape: draws a surface that the tip has changed
  constructor(constants, draw, reshape) {
    this.yields = new Yields(draw, ({ dented, curve, heights }) => {
      this.dented = dented;
      if (curve && this.law) this.law.curve = curve;
      if (heights) reshape(heights, dented.relief);
    });
    Object.assign(this, { constants, draw, dented: null, world: null, clock: { speed: 1, paused: false, slowdown: 1 }, task: {}, notes: [],
      waiting: new Set(), now: null, reading: null, readAt: 0, arrived: -Infinity, updates: 0, law: null, place: {},
      placedAt: 0, load: 1, pullOff: 0, event: null, guide: "" });
    this.forget();
  }

  forget() {
    Object.assign(this, { slices: [], tail: [], trace: [], events: [], peak: 0 });
  }

  // --- messages ---

  hear(message) {
    switch (message.tell) {
      case "world": this.#settle(message); break;
      case "laid":
        this.forget();
        Object.assign(this, { world: null, now: null, reading: null, law: null, dented: null, recovery: null });
        this.yields.lay(message.surface);
        break;
      case "clock":
        this.clock = message;
        this.#stand(message.here ?? {});
        break;
      case "dents": this.yields.hear(message.dents); break;
      case "recovery": this.recovery = message.r.length ? message : null; break;
      case "particles": this.events.push(...message.events); break;
      case "event": this.event = { at: performance.now(), text: message.text, kind: message.kind }; break;
      case "guide": this.guide = message.text; break;
      case "task": this.task = message.name ? message : {}; break;
      case "refused":
        this.waiting.delete(message.field);
        this.note(message.why, true);
        break;
      case "note": if (this.notes.at(-1)?.text !== message.text) this.note(message.text, false); break;
    }
  }

  note(text, bad) {
    this.notes = [...this.notes.slice(-3), { at: performance.now(), text, bad }];
  }

  // The hand asks again: no refusal of its last answer stays beside a good one.
  asks(what) {
    if (this.constants.ANSWERS.includes(what)) this.notes = this.notes.filter(({ bad }) => !bad);
  }

  #settle(world) {
    const key = (of) => JSON.stringify([of?.scene, of?.rig]), fresh = key(world) !== key(this.world);
    this.world = world;
    this.waiting.clear();
    this.load = world.scene.range.maximum_load;
    if (!fresh) return;
    this.place = {};
    this.#planFor({});
  }

  // Law and section are those of the place under the tip: anew where it differs, twice a second at most.
  #stand(here) {
    const now = performance.now();
    if (!this.world || !this.law || now - this.placedAt < REPLACED) return;
    const differs = Object.entries(here).some(([name, value]) => {
      const [section, key] = PLACE[name] ?? [], drawn = this.place[name] ?? this.world.scene[section]?.[key];
      return section && Math.abs(value - drawn) > DIFFERS * Math.abs(drawn);
    });
    if (!differs) return;
    this.place = here;
    this.#planFor(here);
  }

  async #planFor(here) {
    this.placedAt = performance.now();
    const { scene, rig, relative_accuracy, bound } = this.world, accuracy = Math.max(relative_accuracy, this.constants.LAXER * bound);
    const made = await this.draw({ draw: "plan", scene, rig, here, accuracy });
    if (made.error || this.world?.scene !== scene) return;
    this.law = made;
    this.dented = made.dented ?? null;
    this.yields.begin(Boolean(made.dented));
    this.pullOff = made.facts.pull_off_force;
  }

  // --- updates ---

  take(now) {
    const { constants } = this, at = performance.now();
    this.arrived = at;
    ++this.updates;
    if (this.now && now.time < this.now.time) { // rewound
      this.forget();
      this.yields.leap();
    }
    this.yields.see(now);
    this.now = now;
    if (!this.reading || at - this.readAt > 1000 * constants.READINGS) {
      this.readAt = at;
      this.reading = now;
    }
    if (!Number.isFinite(now.force)) return;
    this.#slice(now);
    if (now.events) this.events.push(now.events & 2 ? "tear" : "snap");
    this.tail.push({ time: now.time, gap: now.gap, force: now.force });
    while (this.tail.length && this.tail[0].time < now.time - constants.TAIL) this.tail.shift();
    const last = this.trace.at(-1);
    if (!last || now.time - last.time >= constants.TRACE_STEP) {
      this.trace.push({ time: now.time, x: now.tip[0], y: now.tip[1], force: now.force });
      if (this.trace.length > constants.TRACE / constants.TRACE_STEP) this.trace.shift();
    }
  }

  #slice({ time, least, largest }) {
    if (!(least <= largest)) return;
    const width = this.constants.HISTORY / this.constants.SLICES, slot = Math.floor(time / width), last = this.slices.at(-1);
    if (last?.slot === slot) {
      last.low = Math.min(last.low, least);
      last.high = Math.max(last.high, largest);
    } else this.slices.push({ slot, time, low: least, high: largest });
    while (this.slices.length > this.constants.SLICES) this.slices.shift();
  }

  get hides() { return new Set(this.task.hides ?? []); }
  // The gap is not known: the slave is a real one.
  get blind() { return Boolean(this.now) && !Number.isFinite(this.now.gap); }
  get age() { return (performance.now() - this.arrived) / 1000; }
  get stale() { return this.age > this.constants.STALE && !this.clock.paused; }
  get force() {
    return this.now && !this.stale && Number.isFinite(this.now.force) ? this.now.force : 0;
  }

  // On the tip, x and y [N]; 0 where nothing may be felt.
  get sideways() {
    return this.now && !this.stale ? this.now.side.map((part) => (Number.isFinite(part) ? part : 0)) : [0, 0];
  }

  // What a hand is to feel now; each snap and tear once. Nothing where the newest update is too old.
  feel() {
    const event = this.events.at(-1) ?? "";
    this.events = [];
    if (this.stale || this.clock.paused || !this.world) return { level: 0, event: "" };
    return { level: Math.min(Math.hypot(this.force, ...this.sideways) / Math.max(this.load, 1e-15), 1), event };
  }
}
