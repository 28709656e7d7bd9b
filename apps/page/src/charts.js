// SPDX-License-Identifier: BSD-3-Clause
// Force against gap with the law behind it, and the force at the hand over the last ten seconds (live/charts.py).

import { Axes } from "./painter.js";
import { digits, stepUp } from "./units.js";

const HELD = 3; // an axis becomes narrower no earlier than after this [s]

// The end of an axis that follows in steps: at once outwards, late inwards, so that it never wobbles.
class Follower {
  end = 0;
  since = 0;
  of(wanted, now) {
    const step = stepUp(Math.max(wanted, 1e-15));
    if (step >= this.end || now < this.since) [this.end, this.since] = [step, now];
    else if (step > 0.45 * this.end) this.since = now;
    else if (now - this.since > HELD) [this.end, this.since] = [step, now];
    return this.end;
  }
}

export class ForceGap {
  constructor(painter) {
    Object.assign(this, { painter, up: new Follower(), down: new Follower(), out: new Follower() });
  }

  draw(seen, palette) {
    const { painter } = this, { now, law } = seen;
    if (!painter.begin(palette.panel) || !now || !law || !seen.world) return;
    const gap = seen.blind ? 0 : now.gap; // an axis does not follow what is not known
    const { facts, curve } = law, pull = facts.pull_off_force, { load } = seen;
    const recent = seen.tail.map((row) => row.force), most = Math.max(0, ...recent), least = Math.min(0, ...recent);
    const top = this.up.of(Math.max(1.3 * pull, 1.15 * most, 0.02 * load), now.time);
    const reach = this.out.of(Math.max(law.reach, 1.1 * Math.min(gap, 3.9 * law.reach)), now.time);
    let deep = 0;
    for (let i = 0; i < curve.attached.length; i += 2) if (curve.attached[i + 1] >= top) deep = -curve.attached[i];
    const inner = -Math.max(0.25 * reach, 1.2 * Math.min(deep, 1.5 * facts.largest_indentation), -1.1 * gap);
    const low = -this.down.of(Math.max(1.3 * pull, -1.15 * least, 0.1 * top), now.time);
    const axes = new Axes(painter, [inner, reach], [low, top]);
    axes.draw(palette, ["gap", "force on the tip"], ["m", "N"]);
    const rows = seen.world.measured ?? [], { slow } = seen.world; // a curve that was fitted; the law in the end over that at once
    painter.line(axes.mapped(rows.flatMap(([gap, , fitted]) => [gap, fitted])), palette.quiet, 1.2);
    for (const [gap, force] of rows) if (axes.holds(gap, force)) painter.dot(...axes.at(gap, force), 3, palette.quiet);
    painter.line(axes.mapped(curve.unstable), palette.quiet, 1.5, true);
    if (slow < 1) painter.line(axes.mapped(curve.attached.map((value, i) => (i % 2 ? slow * value : value))), palette.ink, 1.5, true);
    painter.line(axes.mapped(curve.attached), palette.ink, 2);
    painter.line(axes.mapped(curve.apart), palette.accent, 2);
    this.#spring(axes, seen, palette);
    for (let i = 1; i < seen.tail.length; ++i) {
      const pair = seen.tail.slice(i - 1, i + 1), colour = pair[1].force >= 0 ? palette.repulsion : palette.attraction;
      painter.line(pair.map((row) => axes.at(row.gap, row.force)), colour, 2.5);
    }
    const colour = seen.force >= 0 ? palette.repulsion : palette.attraction;
    painter.dot(...axes.at(now.gap, now.force), 5, colour, palette.panel);
    painter.text(painter.width - 14, 16, pull > 1e-3 * load ? `pull-off ${digits(pull, "N")}` : "nothing pulls", palette.ink, { align: "right" });
    let left = 58;
    const names = slow < 1 ? ["no force", "at once, and in the end (dashed)"] : ["approach", "retraction"];
    for (const [name, one] of [[names[0], palette.accent], [names[1], palette.ink], ["spring", palette.hold]]) {
      painter.text(left, painter.height - 12, name, one);
      left += painter.widthOf(name) + 12;
    }
  }

  // F = K (h - h_proxy): the spring that holds the tip, through the point that is now.
  #spring(axes, { world, now }, palette) {
    const at = (force) => now.gap + (force - now.force) / world.stiffness;
    const ends = [at(axes.y[0]), at(axes.y[1])].map((gap) => Math.min(Math.max(gap, axes.x[0]), axes.x[1]));
    if (ends[0] === ends[1]) return;
    this.painter.line(ends.map((gap) => axes.at(gap, now.force + world.stiffness * (gap - now.gap))), palette.hold, 1.2);
  }
}

// Where the work of the hand has gone in this touch: parts of a sum, each to the third digit of the largest.
export function balance(energies) {
  const most = Math.max(Math.abs(energies[0]), Math.abs(energies[1])), [unit, factor] = most > 1e-15 ? ["fJ", 1e15] : ["aJ", 1e18];
  const scaled = energies.map((value) => value * factor), largest = Math.max(...scaled.map(Math.abs));
  const step = largest > 0 ? 10 ** (Math.floor(Math.log10(largest)) - 2) : 1;
  const [hand, ...parts] = scaled.map((value) => `${Number((Math.round(value / step) * step).toPrecision(3)) + 0}`);
  const told = ["spring", "tip", "heat"].map((name, i) => `${name} ${parts[i]}`).join(" + ");
  return `work of the hand ${hand} ${unit} = ${told}`.replaceAll(/\+ (\w+) -/g, "- $1 ");
}

// What has yielded gives nothing back.
const yielded = ([hand, stored, tip, heat], dented) => (dented ? [hand, stored, dented.stored, heat + tip - dented.stored] : [hand, stored, tip, heat]);

export class History {
  constructor(painter, constants) {
    Object.assign(this, { painter, constants, high: new Follower(), low: new Follower() });
  }

  draw(seen, palette) {
    const { painter } = this, { HISTORY } = this.constants;
    if (!painter.begin(palette.panel) || !seen.slices.length || !seen.world) return;
    const scale = seen.world.settings.gains.alpha_f, now = seen.now.time;
    const rows = seen.slices.filter((row) => row.time > now - HISTORY);
    if (!rows.length) return;
    const most = Math.max(...rows.map((row) => row.high), 0.05 * seen.load, 0.3 * seen.pullOff);
    const high = this.high.of(1.1 * most * scale, now);
    const low = this.low.of(1.1 * Math.max(-Math.min(...rows.map((row) => row.low)) * scale, 0.05 * high), now);
    const axes = new Axes(painter, [-HISTORY, 0], [-low, high]);
    axes.draw(palette, ["time", "force at the hand"], ["s", "N"]);
    if (seen.clock.energies) painter.text(painter.width < 520 ? 58 : painter.width - 14, painter.width < 520 ? painter.height - 12 : 16,
      balance(yielded(seen.clock.energies, seen.dented)), palette.ink, { align: painter.width < 520 ? "left" : "right" });
    const least = axes.width / this.constants.SLICES;
    rows.forEach((row, i) => { // each sums up all since the one before
      const start = i ? axes.at(rows[i - 1].time - now, 0)[0] : 0;
      const part = (from, to, colour, opacity) => {
        const [x, y] = axes.at(row.time - now, from * scale), [, other] = axes.at(row.time - now, to * scale);
        const left = (i ? start : x - least) - 0.5;
        painter.area([[left, y - 0.8], [x + 0.5, y - 0.8], [x + 0.5, other + 0.8], [left, other + 0.8]], colour, opacity);
      };
      if (row.high > 0) {
        part(row.high, 0, palette.repulsion, 0.24);
        part(row.high, Math.max(row.low, 0), palette.repulsion);
      }
      if (row.low < 0) {
        part(0, row.low, palette.attraction, 0.24);
        part(Math.min(row.high, 0), row.low, palette.attraction);
      }
    });
  }
}
