// SPDX-License-Identifier: BSD-3-Clause
// The host of the page in Node, each sample laid and asked, each task solved by its ideal operator: what it tells, as
// JSON. Usage: node hosts.mjs FILE.wasm TABLE.json ASKED.json
import fs from "node:fs";
import { Core } from "../../apps/page/src/core.js";
import { Host } from "../../apps/page/src/host.js";

const [wasm, table, asked] = process.argv.slice(2), names = JSON.parse(fs.readFileSync(table, "utf8"));
const told = [], worlds = {}, solved = {};
const host = new Host(await Core.load(fs.readFileSync(wasm)), names, (message) => told.push(message));
const last = (kind) => told.findLast(({ tell }) => tell === kind);
for (const [preset, messages] of Object.entries(JSON.parse(fs.readFileSync(asked, "utf8")))) {
  told.length = 0;
  await host.answer({ do: "preset", name: preset });
  worlds[preset] = [last("world"), last("sliders")];
  for (const { factor, ...message } of messages) {
    const [section, key] = message.field.split(".");
    await host.answer({ ...message, value: message.value ?? factor * host.world[message.what][section][key] });
    worlds[preset].push(told.findLast(({ tell }) => tell === "refused" || tell === "world"));
    told.length = 0;
  }
}

// A touch in steps of 10 ms: pressed, then let go.
await host.answer({ do: "preset", name: names.presets[0].name });
const touch = [];
for (const on of [true, false]) {
  await host.answer({ do: "press", on });
  for (let i = 0; i < 150; ++i) host.turn(0.01);
  touch.push({ energies: host.clock().energies, force: host.now.force, contact: host.now.contact });
}

// Properties of each place: half of the surface is softer, and adheres less.
const map = { rows: 1, columns: 2, heights: [1e9, 1e11] };
await host.answer({ do: "property", name: "youngs_modulus", map, title: "a map" });
host.turn(0.01);
const { properties } = last("laid").surface;
const property = { here: host.clock().here, ends: [properties.youngs_modulus[0], properties.youngs_modulus.at(-1)] };
await host.answer({ do: "property", name: "work_of_adhesion", map: { ...map, heights: [0.5, -1] }, title: "a map" });
property.refused = last("refused");

for (const { name } of names.tasks) {
  await host.answer({ do: "task", name, lay: true, seed: 1 });
  const status = host.core.c.page_host_solve();
  await host.answer({ do: "report" });
  const { csv, ...task } = last("task");
  solved[name] = { status, ...task, lines: csv?.split("\n").length ?? 0, undo: host.clock().undo };
}
console.log(JSON.stringify({ worlds, touch, property, solved }));
