// SPDX-License-Identifier: BSD-3-Clause
// A sample that keeps dents, in the worker: its law where the tip is, the section, and the surface with what the tip has
// left. All of it is C (page_dented.c), which is told the updates that are seen.

const FACTS = ["relief", "began", "radius", "depth", "stored", "yieldLoad"]; // page_dented_fact

export class Dented {
  constructor(core) { Object.assign(this, { core, farthest: 0, shown: "" }); }

  get facts() { return Object.fromEntries(FACTS.map((name, what) => [name, this.core.c.page_dented_fact(what)])); }

  // The sample that was planned last, under at most this load.
  begin(facts, load, farthest) {
    this.core.c.page_dented_begin(load);
    Object.assign(this, { farthest, shown: "" });
    const dented = this.facts;
    facts.largest_indentation = dented.relief;
    return { curve: this.#curve(), dented };
  }

  #curve() {
    const [apart, attached] = [0, 1].map((part) =>
      this.core.points((at, count) => this.core.c.page_dented_curve(part, this.farthest, at, count)));
    return { apart, attached, unstable: [] };
  }

  section(gap, r) {
    return this.core.profile([gap, 0], r, (at, ...rest) => this.core.c.page_dented_section(gap, ...rest));
  }

  // ground: the surface before any dent; dents: those of the session; rows: updates; draws: the surface, if it is
  // another one now.
  see({ ground, dents, rows, anew, draws }) {
    const { core } = this;
    if (ground) this.#lay(ground);
    if (dents) core.withDoubles(8 * dents.length, dents.flat(), (at) => core.c.page_dented_take(at, dents.length));
    core.withDoubles(4 * rows.length, rows.flat(), (at) => core.c.page_dented_follow(at, rows.length, anew ? 1 : 0));
    const told = { dented: this.facts }, { began, radius } = told.dented, law = `${began} ${radius}`;
    if (law !== this.shown) told.curve = this.#curve();
    this.shown = law;
    if (draws) core.withDoubles(this.count, null, (at) => {
      if (core.c.page_dented_heights(at)) told.heights = Float32Array.from(core.doubles(at, this.count));
    });
    return told;
  }

  #lay({ heights, rows, columns, dx, dy }) {
    this.count = rows * columns;
    this.core.withDoubles(this.count, heights, (at) => this.core.check(this.core.c.page_dented_lay(at, columns, rows, dx, dy)));
  }
}
