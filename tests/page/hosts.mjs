// SPDX-License-Identifier: BSD-3-Clause
// The host of the page in Node, each sample laid and asked: what it tells, as JSON.
// Usage: node hosts.mjs FILE.wasm TABLE.json ASKED.json
import fs from "node:fs";
import { Core } from "../../apps/page/src/core.js";
import { Host } from "../../apps/page/src/host.js";

const [wasm, table, asked] = process.argv.slice(2);
const told = [], worlds = {};
const host = new Host(await Core.load(fs.readFileSync(wasm)), JSON.parse(fs.readFileSync(table, "utf8")), (message) => told.push(message));
for (const [preset, messages] of Object.entries(JSON.parse(fs.readFileSync(asked, "utf8")))) {
  await host.answer({ do: "preset", name: preset });
  worlds[preset] = [host.world()];
  for (const { factor, ...message } of messages) {
    const [section, key] = message.field.split(".");
    await host.answer({ ...message, value: message.value ?? factor * host.world()[message.what][section][key] });
    worlds[preset].push(told.at(-1));
  }
}
// A touch in steps of 10 ms: pressed, then let go.
await host.answer({ do: "preset", name: "silicon_in_air" });
const touch = [];
for (const on of [true, false]) {
  await host.answer({ do: "press", on });
  for (let i = 0; i < 150; ++i) host.turn(0.01);
  touch.push({ energies: host.clock().energies, force: host.now.force, contact: host.now.contact });
}
worlds.touch = touch;

// Properties of each place: half of the surface is softer, and adheres less.
const map = { rows: 1, columns: 2, heights: [1e9, 1e11] };
await host.answer({ do: "property", name: "youngs_modulus", map, title: "a map" });
host.turn(0.01);
const { properties } = told.findLast(({ tell }) => tell === "laid").surface;
worlds.property = { here: host.clock().here, ends: [properties.youngs_modulus[0], properties.youngs_modulus.at(-1)] };
await host.answer({ do: "property", name: "work_of_adhesion", map: { ...map, heights: [0.5, -1] }, title: "a map" });
worlds.property.refused = told.at(-1);

// A ball is pushed, lost, and laid back.
const go = async (way, count) => {
  for (let i = 0; i < count; ++i) {
    await host.answer({ do: "move", way: [way, 0, 0] });
    host.turn(0.02);
  }
  return { laid: host.balls.laid, side: host.now.side[0], tip: host.now.tip[0], undo: host.world().undo };
};
await host.answer({ do: "task", name: "push", lay: true });
worlds.push = [await go(-20e-9, 65), await go(20e-9, 40)];
await host.answer({ do: "undo" });
worlds.push.push(await go(0, 1));
worlds.told = told.filter(({ tell }) => tell === "particles").flatMap(({ events }) => events);

// Dents: two presses in one place, a groove, what is refused meanwhile, undo. Ticks as those of the host in Python.
const [step, steps] = [{ do: "wheel", steps: 1 }, async (count, message) => {
  for (let i = 0; i < count; ++i) {
    await host.answer(message);
    host.turn(0.01);
  }
}];
const dents = () => ({ dents: host.dents.list, undo: host.world().undo, force: host.now.force, tip: host.now.tip });
await host.answer({ do: "task", name: "dent" });
worlds.dents = { refused: told.at(-1), found: [] };
await host.answer({ do: "preset", name: "soft_gold" });
host.turn(0.01);
for (const count of [60, 70]) {
  await steps(count, step);
  await steps(count, { ...step, steps: -1 });
  worlds.dents.found.push(dents());
}
await steps(70, step);
await steps(60, { do: "move", way: [0.5e-9, 0.25e-9, 0] });
await host.answer({ do: "undo" });
worlds.dents.held = told.findLast(({ tell }) => tell === "refused");
await steps(70, { ...step, steps: -1 });
worlds.dents.found.push(dents());
await host.answer({ do: "undo" });
worlds.dents.found.push(dents());
console.log(JSON.stringify(worlds));
