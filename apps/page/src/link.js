// SPDX-License-Identifier: BSD-3-Clause
// Where the session is: in the worker of this page, behind a socket of `nanotouch live --browser`, or in a notebook's
// kernel. All give updates and messages, and take what is asked. An update is taken before the next one is sent.

import { readUpdate } from "./core.js";
import { PROPERTIES } from "./subject.js";

// The worker: always there for what is drawn; with `own` the session runs in it, too.
export class Worked {
  constructor(source, { hear, take }) {
    Object.assign(this, { hear, take, waiting: new Map(), number: 0 });
    this.worker = new Worker(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
    this.worker.onmessage = ({ data }) => this.#hear(data);
    this.worker.onerror = (event) => hear({ tell: "refused", why: `the session has stopped: ${event.message}` });
  }

  begin(begin) { this.worker.postMessage({ begin }); }

  #hear(data) {
    if (data.update) {
      this.take(readUpdate(data.update), data.update.byteLength);
      this.worker.postMessage({ ack: 1 });
    } else if (data.drawn) {
      this.waiting.get(data.number)?.(data);
      this.waiting.delete(data.number);
    } else this.hear(data);
  }

  ask(message) { this.worker.postMessage(message); }

  // What C says of a scene, later.
  draw(message) {
    const number = ++this.number;
    return new Promise((done) => {
      this.waiting.set(number, done);
      this.worker.postMessage({ ...message, number });
    });
  }
}

const LAID = 2; // first byte of a binary message that holds heights; an update begins with 1

// Binary: an update of 128 bytes, or a surface. Text: messages in JSON. Each update is acknowledged.
export function hearBytes(buffer, { hear, take, ack }) {
  if (new Uint8Array(buffer)[0] !== LAID) {
    take(readUpdate(buffer), buffer.byteLength);
    return ack();
  }
  const view = new DataView(buffer), rows = view.getUint32(4, true), columns = view.getUint32(8, true);
  const part = (number) => new Float32Array(buffer.slice(32 + 4 * rows * columns * number, 32 + 4 * rows * columns * (number + 1)));
  const heights = part(0), properties = {}, held = PROPERTIES.filter((_, bit) => (view.getUint32(12, true) >>> bit) & 1);
  held.forEach((name, i) => { properties[name] = part(i + 1); });
  return hear({ tell: "laid", surface: { heights, properties, rows, columns, dx: view.getFloat64(16, true), dy: view.getFloat64(24, true) } });
}

export class Socketed {
  constructor(key, { hear, take }) {
    this.socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/session`);
    this.socket.binaryType = "arraybuffer";
    const kept = sessionStorage.getItem("nanotouch-token") ?? ""; // so that this page may be loaded again
    this.socket.onopen = () => this.socket.send(JSON.stringify({ key, token: kept }));
    this.socket.onmessage = ({ data }) => {
      if (typeof data !== "string") return hearBytes(data, { hear, take, ack: () => this.socket.send("{}") });
      const message = JSON.parse(data);
      if (message.tell === "granted" && message.token) sessionStorage.setItem("nanotouch-token", message.token);
      return hear(message);
    };
    this.socket.onclose = ({ reason }) => hear({ tell: "refused", why: reason || "the session has ended, or the connection is lost" });
  }

  // A file, to be read where the session is.
  async open(file) {
    const headers = { "X-Nanotouch-Token": sessionStorage.getItem("nanotouch-token") ?? "", "X-Nanotouch-File": encodeURIComponent(file.name) };
    const answer = await fetch("/open", { method: "POST", body: file, headers });
    if (!answer.ok) throw new Error(await answer.text());
  }

  ask(message) { if (this.socket.readyState === 1) this.socket.send(JSON.stringify(message)); }
}

// Inside a notebook: the widget around this frame passes messages on; it is the parent of this window, no other.
export class Framed {
  constructor({ hear, take }) {
    window.addEventListener("message", ({ source, data }) => {
      if (source !== window.parent || data?.nanotouch !== 1) return;
      if (data.bytes) hearBytes(data.bytes, { hear, take, ack: () => this.ask({}) });
      else hear(data.message);
    });
    this.ask({ do: "hello" });
  }

  ask(message) { window.parent.postMessage({ nanotouch: 1, message }, "*"); }
}
