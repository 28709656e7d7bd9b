// SPDX-License-Identifier: BSD-3-Clause
// The hand of a person without a haptic device: it moves a point, the proxy; the tip follows through a spring. The same
// as nanotouch_app/live/hand.py, with its numbers.

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

export class Hand {
  // session: what host.js knows of it (settings, rig, scene, facts, start, size, own numbers)
  constructor(session, constants, hold) {
    Object.assign(this, { session, constants, hold, presses: false });
    const { alpha_p } = session.settings.gains;
    const reach = 0.5 * session.rig.master.travel;
    this.low = [-reach, -reach, -reach];
    this.high = [reach, reach, reach];
    session.start.forEach((start, axis) => {
      this.low[axis] = Math.max(this.low[axis], -start / alpha_p);
      this.high[axis] = Math.min(this.high[axis], (session.size[axis] - start) / alpha_p);
    });
    this.place = [0, 0, session.masterStart];
    this.height = session.startHeight;
    this.zero = this.height + alpha_p * session.masterStart;
    const load = session.scene.range.maximum_load;
    this.step = (session.facts.largest_indentation + load / this.stiffness) / constants.STEPS;
    this.limit = constants.LOAD_SHARE * session.settings.limits.force;
    this.pressForce = constants.PRESS_SHARE * load;
    this.reachDown = session.sunk(this.limit) + this.limit / this.stiffness;
  }

  // Between proxy and tip: coupling and lever, one after the other [N/m].
  get stiffness() {
    const { gains } = this.session.settings, lever = this.session.rig.probe.spring_constant;
    const spring = gains.coupling_stiffness / (gains.alpha_p * gains.alpha_f);
    return spring > 0 ? (spring * lever) / (spring + lever) : lever;
  }

  // What an arm does by itself: it presses, yields, and stays by a stopped tip.
  follow(now, elapsed) {
    const force = now.force, tip = now.tip[2];
    if (!Number.isFinite(force) || !Number.isFinite(tip)) return;
    if (now.state !== 0) {
      this.height = tip - force / this.stiffness;
      this.presses = false;
    } else if (force > 1.1 * this.limit) {
      this.#shift([0, 0, -(force - this.limit) / this.stiffness]);
    } else if (this.presses) {
      let way = (4 * elapsed * (this.pressForce - force)) / this.stiffness;
      if (!(now.contact > 0)) way = elapsed * Math.max(this.constants.STEPS * this.step, 2 * now.gap);
      this.move([0, 0, way], now);
    }
  }

  // Draw back by the clearance, and by what adhesion stretches the springs before it lets go.
  lift(now) {
    const stretch = this.session.facts.pull_off_force / this.stiffness;
    const up = now.tip[2] + this.session.clearance + 1.2 * stretch - this.height;
    this.#shift([0, 0, -Math.max(up, 0)]);
  }

  // Down by steps of the wheel, longer ones far from the surface; up if below 0.
  stepDown(steps, now) {
    const far = now.contact > 0 ? 0 : Math.max(now.gap, 0) / this.constants.APPROACH;
    return this.move([0, 0, steps * Math.max(this.step, far)], now);
  }

  // By lengths at the tip [m], the third + down. False where the force limit has cut the way.
  move(way, now) {
    const room = this.height - (now.tip[2] - now.gap) + this.reachDown;
    const down = Number.isFinite(room) ? Math.min(way[2], Math.max(room, 0)) : Math.min(way[2], 0);
    this.#shift([way[0], way[1], down]);
    return down === way[2];
  }

  // Begin anew from where the tip is.
  rest(now) {
    if (Number.isFinite(now.tip[2])) this.height = now.tip[2]; // a slave that has failed does not say
  }

  // After a rewind: where the master is now.
  resume(now) {
    this.place = [...now.master];
    this.height = now.tip[2] - now.force / this.stiffness;
    this.move([0, 0, 0], now);
  }

  #shift(way) {
    if (!way.every(Number.isFinite)) return; // where the tip is nobody knows
    const scale = 1 / this.session.settings.gains.alpha_p;
    const before = this.place[2];
    this.place = this.place.map((at, axis) => clamp(at + scale * way[axis], this.low[axis], this.high[axis]));
    this.height -= (this.place[2] - before) / scale; // no further than the hand has gone
    this.hold(this.place, this.constants.GLIDE);
  }
}
