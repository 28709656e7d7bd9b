// SPDX-License-Identifier: BSD-3-Clause
// The worker: the C library with the session at the pace of the clock, and what is drawn. Updates go out one at a time,
// the next when the last was taken: a slow page drops none of the spikes and delays nothing.

import { Core } from "./core.js";
import { Drawn } from "./drawn.js";
import { Host } from "./host.js";
import { fitCard } from "./fitcard.js";

const TURN = 4; // [ms]
const CLOCK = 200; // between two reports of the clock [ms]
let host = null, drawn = null, begun = null, asked = Promise.resolve(), free = true, last = 0, told = 0;

const tell = (message) => postMessage(message);

function turn() {
  const now = performance.now();
  try {
    host.turn((now - last) / 1000);
    last = now;
    if (free && host.now) {
      free = false;
      const update = host.take();
      postMessage({ update, at: now }, [update]);
    }
    if (host.now && now - told > CLOCK) {
      told = now;
      tell(host.clock());
    }
  } catch (error) {
    tell({ tell: "refused", why: `the session has stopped: ${error.message}` });
    clearInterval(timer);
  }
}
let timer = 0;

async function begin({ wasm, table, own }) {
  drawn = new Drawn(await Core.load(wasm));
  if (own) {
    host = new Host(await Core.load(wasm), table, tell);
    last = performance.now();
    timer = setInterval(turn, TURN);
  }
  tell({ tell: "ready", fields: drawn.core.fields });
}

function draw(message) {
  const reply = { drawn: message.draw, number: message.number };
  try {
    if (message.draw === "plan") Object.assign(reply, drawn.plan(message));
    else if (message.draw === "section") Object.assign(reply, drawn.section(message));
    else if (message.draw === "dented") Object.assign(reply, drawn.dented.see(message));
    else if (message.draw === "curve") Object.assign(reply, { card: fitCard(drawn.core, message) });
  } catch (error) {
    reply.error = error.message;
  }
  postMessage(reply);
}

onmessage = async ({ data }) => {
  if (data.begin) {
    begun = begin(data.begin);
    try {
      await begun;
    } catch (error) {
      tell({ tell: "refused", why: `the library could not be started: ${error.message}` });
    }
  } else if (data.draw) {
    await begun; // it may be asked earlier
    draw(data);
  } else if (data.ack) free = true;
  else if (data.do && host) {
    asked = asked.then(() => host.answer(data)); // one after the other
  }
};
