// SPDX-License-Identifier: BSD-3-Clause
// Pointer, wheel, touch screen and keys: what live/window.py does with mouse and keys.

const FINE = 0.1, ARROW = 6; // with shift; [pixels] of an arrow
const CLICK = 100, KEY_STEPS = 3; // of the wheel to a step [pixels]; of the key that magnifies [steps]
const PLAIN = { r: "retract", Escape: "stop", Enter: "arm", p: "pause", Pause: "pause", ".": "step", "[": "slower", "]": "faster",
  Backspace: "rewind" };
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Input {
  // own: what the page itself does by a key (views, light, sound, ...); reach(pixels): the way that a drag means;
  // by(device): what the hand is moved with; lifts(): whether it leads the height
  constructor(place, { ask, reach, turn, magnify, lifts, own, by }) {
    Object.assign(this, { place, ask, reach, turn, magnify, lifts, own, by, pointers: new Map(), presses: false });
    place.addEventListener("pointerdown", (event) => this.#down(event));
    place.addEventListener("pointermove", (event) => this.#move(event));
    for (const name of ["pointerup", "pointercancel"]) place.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    place.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    place.addEventListener("contextmenu", (event) => event.preventDefault());
    window.addEventListener("keydown", (event) => this.#key(event));
    window.addEventListener("keyup", (event) => { if (event.key === " ") this.#release(); });
    window.addEventListener("blur", () => this.#release());
  }

  #down(event) {
    if (event.target.closest(".panel")) return; // a sheet that lies over the view
    this.place.focus({ preventScroll: true });
    this.place.setPointerCapture(event.pointerId);
    if (event.pointerType === "touch") this.by("finger");
    const what = event.button === 2 || event.target.closest("#rail") ? "height" : event.button === 1 || event.ctrlKey ? "camera" : "tip";
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY, what });
    event.preventDefault();
  }

  // One finger or the left button: over the surface. Two fingers or the right button: down and up.
  #move(event) {
    const held = this.pointers.get(event.pointerId);
    if (!held) return;
    const way = [event.clientX - held.x, event.clientY - held.y], fine = event.shiftKey ? FINE : 1;
    Object.assign(held, { x: event.clientX, y: event.clientY });
    const what = this.pointers.size > 1 ? "height" : held.what;
    if (what === "camera") this.turn(...way);
    else if (what === "height") this.ask({ do: "wheel", steps: (fine * way[1]) / 4 / this.pointers.size });
    else this.#drag(way, fine);
  }

  #drag([x, y], fine) {
    const [dx, dy] = this.reach([fine * x, fine * y]);
    if (dx || dy) this.ask({ do: "move", way: [dx, dy, 0] });
  }

  #wheel(event) {
    if (event.target.closest(".panel")) return;
    event.preventDefault();
    const turned = (event.deltaY || event.deltaX) * (event.deltaMode === 1 ? 33 : 1); // shift turns it sideways
    const steps = Math.min(Math.max(turned / CLICK, -4), 4) * (event.shiftKey ? FINE : 1);
    if (event.ctrlKey || !this.lifts()) return this.magnify(-steps); // two fingers on a track pad that part, too
    this.by("wheel");
    return this.ask({ do: "wheel", steps });
  }

  #stepped(steps) {
    this.by("keys");
    this.ask({ do: "wheel", steps });
  }

  #release() {
    if (!this.presses) return;
    this.presses = false;
    this.ask({ do: "press", on: false });
  }

  #key(event) {
    const { key, target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (target.matches?.("input[type=text], textarea, select") && !this.#left(key, target)) return;
    const control = target.matches?.("button, a, input, summary");
    if (control && [" ", "Enter", ...Object.keys(ARROWS), "PageUp", "PageDown"].includes(key)) return;
    if (!this.#act(key.length === 1 ? key.toLowerCase() : key, event)) return;
    event.preventDefault();
  }

  // A field of text keeps all keys but Escape, which leaves it: and the sheet that it is on, if it is on one.
  #left(key, field) {
    if (key !== "Escape") return false;
    this.place.focus({ preventScroll: true });
    return Boolean(field.closest("#sheet"));
  }

  #act(key, event) {
    const fine = event.shiftKey ? FINE : 1;
    if (PLAIN[key]) this.ask({ do: PLAIN[key] });
    else if (ARROWS[key]) this.#drag(ARROWS[key].map((part) => ARROW * part), fine);
    else if (key === "PageUp" || key === "PageDown") this.#stepped(key === "PageDown" ? fine : -fine);
    else if (key === " ") {
      if (!this.presses) this.ask({ do: "press", on: true });
      this.presses = true;
    } else if (key === "v") this.magnify(event.shiftKey ? -KEY_STEPS : KEY_STEPS);
    else if (key === "z") this.ask({ do: event.shiftKey ? "redo" : "undo" });
    else return this.own(key, event);
    return true;
  }
}
