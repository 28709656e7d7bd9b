// SPDX-License-Identifier: BSD-3-Clause
// The C library as JavaScript sees it: text, arrays, the field tables, one problem in words. No layout of a struct is
// known here but that of an update (page.h).

export const KINDS = ["scene", "rig", "settings"];
const text = new TextDecoder();

// What WASI asks of its host: a clock, nothing else. No file, no network, no random number.
function host(memory) {
  const view = () => new DataView(memory().buffer);
  const known = {
    clock_time_get: (id, precision, at) => {
      view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    proc_exit: (status) => { throw new Error(`the library has ended with status ${status}`); },
  };
  const refused = () => 52; // ENOSYS
  return new Proxy(known, { get: (of, name) => of[name] ?? refused, has: () => true });
}

export class Refused extends Error {}

export class Core {
  static async load(bytes) {
    const module = await WebAssembly.compile(bytes);
    let memory;
    const given = host(() => memory);
    const imports = {};
    for (const one of WebAssembly.Module.imports(module)) {
      imports[one.module] ??= {};
      imports[one.module][one.name] = given[one.name];
    }
    const instance = await WebAssembly.instantiate(module, imports);
    memory = instance.exports.memory;
    instance.exports._initialize?.();
    return new Core(instance.exports);
  }

  constructor(exports) {
    this.c = exports;
    this.fields = {};
    this.c.page_defaults();
    KINDS.forEach((kind, number) => { this.fields[kind] = this.#table(number); });
  }

  text(at) {
    const bytes = new Uint8Array(this.c.memory.buffer);
    let end = at;
    while (bytes[end]) ++end;
    return text.decode(bytes.subarray(at, end));
  }

  doubles(at, count) { return new Float64Array(this.c.memory.buffer, at, count); }

  // Memory for so many doubles during a call; what is in `values` is copied there.
  withDoubles(count, values, call) {
    const at = this.c.page_alloc(8 * Math.max(count, 1));
    if (!at) throw new Refused("out of memory");
    try {
      if (values) this.doubles(at, count).set(values);
      return call(at);
    } finally {
      this.c.page_free(at);
    }
  }

  // Texts during a call, as an array of pointers to them.
  withTexts(texts, call) {
    const bytes = texts.map((one) => new TextEncoder().encode(`${one}\0`)), head = 4 * texts.length;
    const at = this.c.page_alloc(head + bytes.reduce((sum, one) => sum + one.length, 0));
    if (!at) throw new Refused("out of memory");
    try {
      let place = at + head;
      bytes.forEach((one, i) => {
        new DataView(this.c.memory.buffer).setUint32(at + 4 * i, place, true);
        new Uint8Array(this.c.memory.buffer).set(one, place);
        place += one.length;
      });
      return call(at);
    } finally {
      this.c.page_free(at);
    }
  }

  pointer(at) { return new DataView(this.c.memory.buffer).getUint32(at, true); }

  #table(kind) {
    const rows = [];
    for (let i = 0; i < this.c.page_field_count(kind); ++i) {
      const [name, unit, doc] = [0, 1, 2].map((part) => this.text(this.c.page_field_text(kind, i, part)));
      rows.push({ number: i, name, unit, doc, minimum: this.c.page_field_minimum(kind, i),
        maximum: this.c.page_field_maximum(kind, i), choices: unit.includes("|") ? unit.split("|") : null });
    }
    return rows;
  }

  field(kind, name) {
    const found = this.fields[kind].find((row) => row.name === name);
    if (!found) throw new Refused(`there is no field ${name}`);
    return found;
  }

  // { section: { key: value } }, choices by their names, as the Python package writes it.
  get(kind) {
    const made = {};
    for (const row of this.fields[kind]) {
      const [section, key] = row.name.split(".");
      const value = this.c.page_get(KINDS.indexOf(kind), row.number);
      (made[section] ??= {})[key] = row.choices ? row.choices[value] : value;
    }
    return made;
  }

  set(kind, name, value) {
    const row = this.field(kind, name);
    const number = row.choices && typeof value !== "number" ? row.choices.indexOf(String(value)) : Number(value);
    if (!(number >= row.minimum && number <= row.maximum))
      throw new Refused(`${name} = ${value} ${row.unit} (${row.doc}): valid is ` +
        (row.choices ? row.choices.join(", ") : `${row.minimum} .. ${row.maximum} ${row.unit}`));
    this.c.page_set(KINDS.indexOf(kind), row.number, number);
  }

  take(kind, tables) {
    for (const [section, values] of Object.entries(tables))
      for (const [key, value] of Object.entries(values)) this.set(kind, `${section}.${key}`, value);
  }

  check(status) {
    if (status) throw new Refused(this.text(this.c.page_problem(status)));
  }

  checkAll() {
    KINDS.forEach((_, number) => this.check(this.c.page_check(number)));
  }

  // --- the plan of the scene that was set ---

  plan() {
    this.check(this.c.page_plan());
    const facts = { terms: [], warnings: [] };
    for (let i = 0; this.text(this.c.page_fact_name(i)); ++i)
      facts[this.text(this.c.page_fact_name(i))] = this.c.page_fact(i);
    for (let i = 0; i < this.c.page_term_count(); ++i) {
      const force = this.c.page_term_value(i, 0);
      if (force > 0)
        facts.terms.push({ title: this.text(this.c.page_term_text(i, 0)), words: this.text(this.c.page_term_text(i, 1)),
          force, error: this.c.page_term_value(i, 1) });
    }
    for (let i = 0; i < this.c.page_warning_count(); ++i) facts.warnings.push(this.text(this.c.page_warning(i)));
    return facts;
  }

  curve(nearest, farthest) {
    return [0, 1, 2].map((part) => this.points((at, count) => this.c.page_curve(part, nearest, farthest, at, count)));
  }

  // Rows of gap and force that `draw` writes at an address, and counts.
  points(draw, count = 200) {
    return this.withDoubles(2 * count, null, (at) => Array.from(this.doubles(at, 2 * draw(at, count))));
  }

  // Rows of tip, sample, rigid tip at the distances r, with a, c and whether it holds.
  section(gap, force, r) {
    return this.profile([gap, force], r, (at, ...rest) => this.c.page_section(at, ...rest));
  }

  // What `draw` makes of a pose: its address, that of r, of rows, how many, and that of what is found.
  profile(pose, r, draw) {
    return this.withDoubles(4 * r.length + 5, [...pose, 0, 0, 0, ...r], (at) => {
      draw(at, at + 40, at + 40 + 8 * r.length, r.length, at + 16);
      const found = this.doubles(at, 4 * r.length + 5);
      return { r, rows: Array.from(found.subarray(5 + r.length)), a: found[2], c: found[3], attached: found[4] !== 0 };
    });
  }

  // --- a curve that was measured ---

  readCurve(z, force, approach, retract, springConstant) {
    const count = approach + retract;
    return this.withDoubles(2 * count, [...z, ...force], (at) => {
      this.check(this.c.page_read_curve(at, at + 8 * count, approach, retract, springConstant));
      const found = [];
      for (let i = 0; this.text(this.c.page_reading_name(i)); ++i)
        found.push([this.text(this.c.page_reading_name(i)), this.c.page_reading(i)]);
      return { found, branches: [0, 1].map((which) => this.#branch(which)) };
    });
  }

  #branch(which) {
    return this.withDoubles(1, null, (at) => {
      const count = this.c.page_branch(which, at, at + 4);
      const [z, force] = new Uint32Array(this.c.memory.buffer, at, 2);
      return { z: Array.from(this.doubles(z, count)), force: Array.from(this.doubles(force, count)) };
    });
  }
}

// One update of page.h.
export const UPDATE_BYTES = 128;
export function readUpdate(buffer, offset = 0) {
  const view = new DataView(buffer, offset, UPDATE_BYTES);
  const f64 = (at) => view.getFloat64(at, true), f32 = (at) => view.getFloat32(at, true);
  if (view.getUint8(0) !== 1) throw new Refused("this page and its session are of different versions");
  return {
    state: view.getUint8(1), phase: view.getUint8(2), events: view.getUint8(3), reasons: view.getUint32(4, true),
    changes: view.getUint32(8, true), ticks: view.getUint32(12, true), sequence: Number(view.getBigUint64(16, true)),
    time: f64(24), tip: [f64(32), f64(40), f64(48)], gap: f64(56), force: f64(64), side: [f32(72), f32(76)],
    least: f32(80), largest: f32(84), base: f32(88), deflection: f32(92), contact: f32(96), cohesive: f32(100),
    neck: f32(104), motor: f32(108), master: [f32(112), f32(116), f32(120)],
  };
}
