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
console.log(JSON.stringify(worlds));
