// SPDX-License-Identifier: BSD-3-Clause
// Gamepad with rumble, SpaceMouse by WebHID, sound. What is felt ends within 100 ms of the last update.

const DEAD = 0.12, ACROSS = 0.25, DOWN = 20; // of a stick; [surface widths/s]; [steps/s]
const BUTTONS = { 0: ["press", { on: true }], 1: ["retract", {}], 2: ["stop", {}], 3: ["arm", {}] };
const live = (value) => (Math.abs(value) < DEAD ? 0 : (value - Math.sign(value) * DEAD) / (1 - DEAD));

export class Hands {
  constructor(ask, note) {
    Object.assign(this, { ask, note, buttons: {}, last: 0, cap: [0, 0, 0], sound: null, woken: false, rumbled: 0 });
  }

  // Some sixty times a second: width of the surface [m], what is felt.
  turn(width, feel, now) {
    const elapsed = Math.min((now - this.last) / 1000, 0.1);
    this.last = now;
    this.#pad(width, feel, elapsed, now);
    if (this.cap.some(Boolean)) this.#go(this.cap, width, elapsed);
    this.#sing(feel);
  }

  #go([x, y, z], width, elapsed) {
    if (x || y) this.ask({ do: "move", way: [x * ACROSS * width * elapsed, y * ACROSS * width * elapsed, 0] });
    if (z) this.ask({ do: "wheel", steps: z * DOWN * elapsed });
  }

  #pad(width, feel, elapsed, now) {
    const pad = [...(navigator.getGamepads?.() ?? [])].find((one) => one?.connected);
    if (!pad) return this.#letGo();
    const [lx, ly, , ry] = pad.axes.map(live);
    if (lx || ly || ry) this.#go([lx ?? 0, -(ly ?? 0), ry ?? 0], width, elapsed);
    for (const [number, [what, more]] of Object.entries(BUTTONS)) {
      const down = pad.buttons[number]?.pressed ?? false;
      if (down !== (this.buttons[number] ?? false)) {
        if (down) this.ask({ do: what, ...more });
        else if (what === "press") this.ask({ do: "press", on: false });
      }
      this.buttons[number] = down;
    }
    this.#rumble(pad, feel, now);
  }

  // A gamepad that is unplugged presses no more.
  #letGo() {
    if (this.buttons[0]) this.ask({ do: "press", on: false });
    this.buttons = {};
  }

  #rumble(pad, feel, now) {
    const strength = feel.event ? 1 : feel.level;
    if (strength > 0.01 && now - this.rumbled > 60) {
      this.rumbled = now;
      pad.vibrationActuator?.playEffect?.("dual-rumble", { duration: 100, strongMagnitude: strength, weakMagnitude: feel.event ? 1 : 0 })
        .catch(() => {});
    }
  }

  async connectSpaceMouse() {
    if (!navigator.hid) return this.note("This browser has no WebHID: a SpaceMouse works in Chromium.");
    const filters = [{ vendorId: 0x046d }, { vendorId: 0x256f }];
    const [device] = await navigator.hid.requestDevice({ filters });
    if (!device) return undefined;
    if (!device.opened) await device.open();
    device.addEventListener("inputreport", ({ reportId, data }) => this.#report(reportId, data));
    navigator.hid.addEventListener("disconnect", (event) => { if (event.device === device) this.#unplugged(device); });
    return this.note(`${device.productName}: move its cap; its buttons press and retract.`);
  }

  // What it said last holds no longer.
  #unplugged(device) {
    this.cap = [0, 0, 0];
    this.ask({ do: "press", on: false });
    this.note(`${device.productName} is unplugged`);
  }

  #report(id, data) {
    if (id === 1 && data.byteLength >= 6) {
      const [x, y, z] = [0, 2, 4].map((at) => live(Math.min(Math.max(data.getInt16(at, true) / 350, -1), 1)));
      this.cap = [x, -y, z];
    } else if (id === 3) {
      const down = data.getUint8(0);
      this.ask({ do: "press", on: Boolean(down & 1) });
      if (down & 2) this.ask({ do: "retract" });
    }
  }

  // The first click or key: browsers let no sound be made before. Then a snap and a tear are heard.
  wake() {
    if (!this.woken) this.#listen();
    this.woken = true;
  }

  #listen() {
    const context = new AudioContext(), tone = context.createOscillator(), level = context.createGain();
    level.gain.value = 0;
    tone.connect(level).connect(context.destination);
    tone.start();
    this.sound = { context, tone, level, sings: false };
  }

  // Snap and tear; the force, too; nothing.
  turnSound() {
    this.woken = true;
    if (!this.sound) {
      this.#listen();
      return this.note("sound: a click at snap and tear");
    }
    if (!this.sound.sings) {
      this.sound.sings = true;
      return this.note("sound: pitch by the force, a click at snap and tear");
    }
    this.sound.context.close();
    this.sound = null;
    return this.note("sound off");
  }

  // Pitch over two octaves; every order ends by itself after 100 ms.
  #sing({ level, event }) {
    if (!this.sound) return;
    const { context, tone, level: gain, sings } = this.sound, now = context.currentTime;
    tone.frequency.setTargetAtTime(220 * 4 ** level, now, 0.01);
    gain.gain.cancelScheduledValues(now);
    gain.gain.setTargetAtTime(event ? 0.4 : sings && level > 0.005 ? 0.12 : 0, now, event ? 0.002 : 0.02);
    gain.gain.setTargetAtTime(0, now + 0.08, 0.01);
  }
}
