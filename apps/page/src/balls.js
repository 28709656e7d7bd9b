// SPDX-License-Identifier: BSD-3-Clause
// Particles that a task lays, and rings where they shall lie, as nanotouch_app/live/balls.py draws them.

import { ring, rod } from "./shapes.js";

const unit = (colour) => colour.map((part) => part / 255);

export class DrawnBalls {
  // make: an actor of a mesh { points, normals, cells }; drop: takes one away
  constructor(constants, make, drop) { Object.assign(this, { constants, make, drop, balls: [], rings: [] }); }

  get actors() { return [...this.balls, ...this.rings]; }

  // In lengths of the map.
  show({ radius, places, targets, length = 0, angles = [] }, map) {
    if (this.balls.length !== places.length || this.rings.length !== targets.length)
      this.#renew(radius / map.unit, length / map.unit, places, targets);
    const ground = -map.low * map.scale;
    places.forEach(([x, y, z], i) => this.balls[i].setPosition(x / map.unit, y / map.unit, ground + z / map.unit));
    angles.forEach((angle, i) => this.balls[i]?.setOrientation(0, 0, (180 * angle) / Math.PI));
    targets.forEach(([x, y], i) => this.rings[i].setPosition(x / map.unit, y / map.unit, ground + 0.004));
  }

  #renew(radius, length, places, targets) {
    this.forget();
    const made = (mesh, colour) => {
      const actor = this.make(mesh);
      actor.getProperty().setColor(...unit(colour));
      return actor;
    };
    const { PARTICLE, RING, THICK } = this.constants;
    this.balls = places.map(() => made(rod(radius, length), PARTICLE));
    this.rings = targets.map(() => made(ring((1 - THICK) * radius, radius), RING));
    for (const actor of this.balls) actor.getProperty().setSpecular(0.3);
    for (const actor of this.rings) actor.getProperty().setLighting(false);
  }

  forget() {
    this.actors.forEach(this.drop);
    Object.assign(this, { balls: [], rings: [] });
  }
}
