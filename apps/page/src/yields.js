// SPDX-License-Identifier: BSD-3-Clause
// What is seen of a sample that keeps dents: updates and dents go to C in the worker, one question at a time; law, dent
// and surface come back.

const EACH = 100; // between two surfaces while a dent grows [ms]

export class Yields {
  // draw: asks the worker; take: is given what it says
  constructor(draw, take) {
    Object.assign(this, { draw, take, surface: null });
    this.forget();
  }

  forget() { Object.assign(this, { rows: [], anew: true, dents: null, ground: null, asked: false, drawnAt: -Infinity, keeps: false }); }

  lay(surface) {
    this.forget();
    this.surface = surface;
  }

  // A world is there: from now on, if its sample keeps dents.
  begin(keeps) {
    if (keeps && !this.keeps) this.ground = this.surface;
    this.keeps = keeps;
  }

  // The tip is elsewhere now, or at another time.
  leap() { Object.assign(this, { rows: [], anew: true }); }

  see({ tip: [x, y], gap, contact }) {
    if (!this.keeps) return;
    this.rows.push([x, y, gap, contact]);
    this.#renew();
  }

  hear(dents) {
    this.dents = dents;
    if (this.keeps) this.#renew();
  }

  async #renew() {
    if (this.asked || !this.keeps) return;
    const { rows, anew, dents, ground } = this, now = performance.now(), draws = Boolean(dents || ground) || now > this.drawnAt + EACH;
    Object.assign(this, { rows: [], anew: false, dents: null, ground: null, asked: true });
    if (draws) this.drawnAt = now;
    const surface = this.surface, told = await this.draw({ draw: "dented", ground, dents, rows, anew, draws });
    if (surface !== this.surface) return; // another one lies there meanwhile
    this.asked = false;
    if (!told.error) this.take(told);
    if (this.dents) this.#renew();
  }
}
