// SPDX-License-Identifier: BSD-3-Clause
// The contact, magnified: a section through tip and sample as they are deformed, at one scale in both directions
// (live/contact.py). The section comes from C in the worker; the newest one is drawn, in a panel and in the lens.

import { digits, stepUp } from "./units.js";

const POINTS = 90, HEADING = 30, MENISCUS = 2, MORE = 1.4; // beyond the frame, which zooms meanwhile
const LEVEL = 0.58; // of the undeformed sample in its frame, from above
const BLIND = "not known of a real slave, which measures a force alone";

const inDent = ({ depth, radius, yieldLoad }) => (depth > 0
  ? `dent ${digits(depth, "m")} deep, ${digits(2 * radius, "m")} wide` : `elastic up to ${digits(yieldLoad, "N")}`);

export const stateOf = (section, world) => (section.a > 0 ? (world.scene.medium.brush_thickness > 0 ? "pressed, the brush between" : "touching")
  : section.attached ? "held" : `gap ${digits(section.gap, "m")}`);

// Of a sample that relaxes: it touches as far as the session says, and beyond is what has not yet recovered.
const relaxed = (made, { now, recovery }) => {
  const a = now.contact, rows = [...made.rows];
  made.r.forEach((r, i) => {
    const rigid = rows[3 * i + 2] ?? Infinity;
    rows[3 * i] = rigid;
    rows[3 * i + 1] = a > 0 && r <= a ? rigid : Math.min(between(recovery, r), rigid);
  });
  return { ...made, rows, a, c: a, attached: a > 0 };
};
const between = (of, r) => {
  const j = of ? of.r.findIndex((at) => at > r) : -1;
  if (j < 1) return j === 0 ? of.z[0] : 0;
  return of.z[j - 1] + (r - of.r[j - 1]) / (of.r[j] - of.r[j - 1]) * (of.z[j] - of.z[j - 1]);
};

export class Contact {
  // shown: how many times the zone of action
  constructor(draw, shown = 3) { Object.assign(this, { ask: draw, shown, halfWidth: 0, section: null, asked: false }); }

  forget() { Object.assign(this, { halfWidth: 0, section: null }); }

  async #renew(seen) {
    if (this.asked || !Number.isFinite(seen.now.gap)) return;
    this.asked = true;
    const r = Array.from({ length: POINTS }, (_, i) => (i / (POINTS - 1)) ** 1.5 * MORE * this.halfWidth);
    const { gap, force } = seen.now, made = await this.ask({ draw: "section", gap, force, r });
    this.asked = false;
    if (!made.error && seen.now) this.section = { ...(seen.world?.scene.rheology.kind === "elastic" ? made : relaxed(made, seen)), gap, force };
  }

  // The zone of action fills its part of the frame; the gap is seen, too. Zoom by smooth factors of 2.
  #zoom(seen, still, aspect) {
    const { facts } = seen.law, zone = this.section ? Math.max(this.section.a, this.section.c) : 0;
    const least = 1.5 * Math.sqrt(facts.radius * Math.max(facts.largest_indentation, 0.3e-9));
    const wanted = Math.max(this.shown * zone, 1.1 * aspect * Math.max(seen.now.gap, 0), least);
    const target = least * 2 ** Math.ceil(Math.log2(wanted / least) - 0.2);
    this.halfWidth = this.halfWidth && !still ? this.halfWidth * (target / this.halfWidth) ** 0.15 : target;
  }

  // Into a frame; where it lies: [pixels per m], the middle, the undeformed sample. Nothing while nothing is known.
  draw(painter, { left, top, width, height }, seen, palette, still) {
    if (!seen.now || !seen.law || !seen.world || seen.blind) return null;
    this.#zoom(seen, still, width / height);
    this.#renew(seen);
    if (!this.section) return null;
    const scale = width / 2 / this.halfWidth, middle = left + width / 2, level = top + LEVEL * height, bottom = top + height;
    const view = { scale, middle, level, left, right: left + width, top, bottom, y: (z) => Math.min(Math.max(level - scale * z, top), bottom) };
    this.#between(painter, seen, palette, view);
    this.#bodies(painter, palette, view);
    return view;
  }

  #both(column, map) {
    const { r, rows } = this.section, right = r.map((at, i) => map(at, rows[3 * i + column]));
    const left = r.map((at, i) => map(-at, rows[3 * i + column])).reverse();
    return [...left, ...right];
  }

  #bodies(painter, palette, { scale, middle, level, left, right, top, bottom, y }) {
    const place = (r, z) => [middle + scale * r, y(z)];
    const ground = this.#both(1, place), edge = this.#both(0, (r, z) => place(r, Number.isFinite(z) ? z : 1));
    painter.area([[left, bottom], ...ground, [right, bottom]], palette.sample);
    painter.area([[left, top], ...edge, [right, top]], palette.tip);
    painter.line(ground, palette.ink);
    painter.line(edge.filter(([, at]) => at > top), palette.ink);
    painter.line([[left, level], [right, level]], palette.quiet, 1, true);
    const rigid = this.#both(2, place).filter(([, at]) => at > top);
    painter.line(rigid, palette.panel, 1, true);
  }

  // What is between the bodies, below them: neck of water, hollow to the outside; the zone that pulls; brush.
  #between(painter, seen, palette, { scale, middle, y }) {
    const { a, c, r, rows } = this.section, brush = seen.world.scene.medium.brush_thickness;
    const zone = r.map((at, i) => [at, rows[3 * i + 1], rows[3 * i]]);
    const strip = (part, sign, fill, opacity) => painter.area([...part.map(([at, low]) => [middle + sign * scale * at, y(low)]),
      ...part.map(([at, , high]) => [middle + sign * scale * at, y(high)]).reverse()], fill, opacity);
    for (const sign of [-1, 1]) {
      if (brush > 0)
        for (let share = 0.2; share <= 1; share += 0.2)
          strip(zone.map(([at, low, high]) => [at, low, low + share * Math.max(Math.min(brush, high - low), 0)]), sign, palette.water, 0.16);
      const held = zone.filter(([at]) => at >= a && at <= c);
      if (!(c > a) || !held.length) continue;
      if (seen.law.facts.source === MENISCUS) {
        strip(held, sign, palette.water);
        const [at, low, high] = held.at(-1);
        painter.dot(middle + sign * scale * at, (y(low) + y(high)) / 2, 0.48 * (y(low) - y(high)), palette.panel);
      } else for (const [at, low, high] of held.filter((_, i) => i % 3 === 0))
        painter.line([[middle + sign * scale * at, y(low)], [middle + sign * (scale * at + 4), y(high)]], palette.attraction, 1);
    }
  }
}

// With a scale, and what the contact is like.
export class ContactPanel {
  constructor(painter, draw) { Object.assign(this, { painter, contact: new Contact(draw) }); }

  forget() { this.contact.forget(); }

  draw(seen, palette, still) {
    const { painter } = this;
    if (!painter.begin(palette.panel)) return;
    const frame = { left: 0, top: HEADING, width: painter.width, height: painter.height - HEADING };
    const view = this.contact.draw(painter, frame, seen, palette, still);
    if (view) this.#words(seen, palette, view);
    else if (seen.blind) painter.text(painter.width / 2, painter.height / 2, BLIND, palette.quiet, { align: "center" });
  }

  #words(seen, palette, { scale, level, middle }) {
    const { painter } = this, { section, halfWidth } = this.contact, { facts } = seen.law;
    painter.text(12, 16, "The contact, magnified", palette.ink, { bold: true, size: 13 });
    const length = stepUp(0.25 * halfWidth), right = painter.width - 16, left = right - length * scale;
    painter.scale(left, right, 16, digits(length, "m", 1), palette.ink);
    if (section.a > 0) {
      const deepest = level - scale * section.rows[1]; // below what is pressed in
      const at = Math.min(Math.max(level, deepest) + 22, painter.height - 34), half = section.a * scale;
      painter.line([[middle - half, at], [middle + half, at]], palette.ink);
      painter.text(middle, at + 12, `2a = ${digits(2 * section.a, "m")}`, palette.ink, { align: "center" });
    }
    const lambda = facts.lambda, none = !Number.isFinite(lambda) || facts.pull_off_force < 1e-3 * seen.load;
    const kind = lambda < 0.1 ? "like DMT" : lambda > 5 ? "like JKR" : "between DMT and JKR";
    const law = none ? "no adhesion: like Hertz" : `${kind}, lambda ${digits(lambda, "", 2)}`;
    painter.text(12, painter.height - 12, seen.dented ? inDent(seen.dented) : law, palette.ink);
    painter.text(painter.width - 14, painter.height - 12, stateOf(section, seen.world), palette.ink, { align: "right" });
  }
}
