// SPDX-License-Identifier: BSD-3-Clause
// Two down, one up: settles where 70.7 % of the answers are right (Levitt 1971); as training/staircase.py.

export class Staircase {
  constructor(start = 3, least = 1.02, most = 10, needed = 8) {
    Object.assign(this, { log: Math.log(start), least: Math.log(least), most: Math.log(most), needed, reversals: [],
      inARow: 0, lastWay: 0, trials: 0, atTheFloor: 0 });
  }

  get ratio() { return Math.exp(this.log); }
  get done() { return this.reversals.length >= this.needed || this.atTheFloor >= 2; }

  take(right) {
    ++this.trials;
    this.inARow = right ? this.inARow + 1 : 0;
    const way = !right ? 1 : this.inARow === 2 ? -1 : 0;
    if (!way) return;
    this.inARow = 0;
    if (way === -1 && this.log <= this.least) ++this.atTheFloor;
    if (this.lastWay && way !== this.lastWay) this.reversals.push(this.log);
    this.lastWay = way;
    const factor = this.reversals.length ? 0.75 : 0.5;
    this.log = Math.min(Math.max(this.log * (way < 0 ? factor : 1 / factor), this.least), this.most);
  }

  get threshold() {
    if (this.atTheFloor >= 2 || !this.reversals.length) return this.ratio;
    const last = this.reversals.slice(-6);
    return Math.exp(last.reduce((sum, one) => sum + one, 0) / last.length);
  }
}
