// SPDX-License-Identifier: BSD-3-Clause
// What a tip leaves in the session of this page: dents in a sample that keeps them, and particles where it has pushed
// them; both can be taken back (nanotouch_app/live/left.py, tasks.py).

import { Refused } from "./core.js";

const LAID = 8, MOST = 6; // numbers of each (page.h), and how many there may be
const MOVED = 1e-10; // less is no push [m]

const DENT = 8, DENTS = 128; // numbers of each (page.h), and how many there may be
const APART = 0.3; // for so long, until the next contact is another touch [s]

export class Dents {
  constructor(core, tell) {
    Object.assign(this, { core, tell });
    this.forget();
  }

  // Rows of start, end, radius, depth, load, and the dent that it has grown from, the oldest first.
  get list() {
    return this.core.withDoubles(DENT * DENTS, null, (at) => {
      const count = this.core.c.page_dents(at), rows = this.core.doubles(at, DENT * count);
      return Array.from({ length: count }, (_, i) => Array.from(rows.subarray(DENT * i, DENT * (i + 1))));
    });
  }

  // Tells of others than before: the list changes at its end.
  look({ time, contact }) {
    const { list } = this, now = `${list.length} ${list.at(-1) ?? ""}`;
    if (contact > 0 || list.length > this.known) { // a tap may be over already
      if (!(time >= this.touchedAt && time < this.touchedAt + APART)) this.began.push(this.known);
      this.touchedAt = time;
    }
    this.known = list.length;
    if (now === this.told) return;
    this.told = now;
    this.tell({ tell: "dents", dents: list });
    if (list.length === DENTS) this.tell({ tell: "note", text: `${DENTS} dents are kept, no more: take some back (Z), or lay the sample anew (C)` });
  }

  // Of another session: they are told in any case.
  forget() { Object.assign(this, { told: "", known: 0, began: [], touchedAt: -Infinity }); } // began: how many there were before each touch

  // All that the last touch has left that is there still.
  undo() {
    const { length } = this.list, before = this.began.findLast((count) => count < length) ?? length - 1;
    for (let count = length; count > before; --count)
      if (this.core.c.page_undent()) throw new Refused("the tip presses: lift it first, then take the dent back");
    this.began = this.began.filter((count) => count < before);
  }
}

export class Balls {
  constructor(core, aside) { Object.assign(this, { core, aside, rested: [], pushes: [] }); }

  // For the session that is opened next. What depends on the tip follows it.
  give(particles, { radius, half_angle: halfAngle }) {
    const values = [...(particles?.values ?? [])];
    for (const [names, now] of [["radius", radius], ["half_angle", halfAngle]]) {
      const [first] = particles?.with_tip[names] ?? [], factor = now / values[first];
      for (const number of particles?.with_tip[names] ?? []) values[number] *= factor;
    }
    this.core.withDoubles(values.length, values, (at) => this.core.check(this.core.c.page_particles(at, values.length)));
    Object.assign(this, { rested: [], pushes: [] });
  }

  get laid() {
    return this.core.withDoubles(LAID * MOST, null, (at) => {
      const count = this.core.c.page_laid(at), rows = [...this.core.doubles(at, LAID * MOST)];
      return Array.from({ length: count }, (_, i) => {
        const [x, y, z, fx, fy, fz, touches, losses] = rows.slice(LAID * i, LAID * (i + 1));
        return { place: [x, y, z], force: [fx, fy, fz], touches, losses };
      });
    });
  }

  // Anew: those that lie there are put aside first.
  lay(places) {
    try {
      this.laid.forEach((_, i) => this.#lay(i, [this.aside * (i + 1), this.aside]));
      places.forEach((place, i) => this.#lay(i, place));
    } catch {
      throw new Refused("the tip is where a particle shall lie, or touches one: move it away first");
    }
    this.pushes = [];
  }

  #lay(number, [x, y]) {
    this.core.check(this.core.c.page_lay(number, x, y));
    this.rested[number] = [x, y];
  }

  // What has happened since: a push is done when nothing is touched any more.
  look(time) {
    const { laid } = this;
    if (laid.some(({ touches, losses }) => touches > losses)) return;
    const moved = [];
    laid.forEach(({ place: [x, y] }, i) => {
      const [left, low] = this.rested[i] ?? [x, y];
      if (Math.abs(x - left) + Math.abs(y - low) > MOVED) moved.push([i, [left, low]]);
      this.rested[i] = [x, y];
    });
    if (moved.length) this.pushes.push({ time, moved });
  }

  // The last push: all that it has moved goes back.
  undo() {
    try {
      for (const [number, place] of this.pushes.at(-1)?.moved ?? []) this.#lay(number, place);
    } catch {
      throw new Refused("the tip touches a particle, or is where it lay: take it away first");
    }
    this.pushes.pop();
  }

  // The session went back to a time.
  rewound(time) {
    this.pushes = this.pushes.filter((one) => one.time < time);
    this.rested = this.laid.map(({ place: [x, y] }) => [x, y]);
  }
}
