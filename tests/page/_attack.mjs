import zlib from "node:zlib";
import { FILE, open, until, value, visit } from "./browser.mjs";
const { context, close } = await open({ offline: true, width: 900, height: 640 });
const crcT = Array.from({ length: 256 }, (_, n) => { let c = n; for (let k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1; return c >>> 0; });
const crc = (b) => { let c = ~0 >>> 0; for (const x of b) c = crcT[(c ^ x) & 255] ^ (c >>> 8); return ~c >>> 0; };
function png(w, h, bits, lines) {
  const chunk = (n, d) => { const body = Buffer.concat([Buffer.from(n), d]), m = Buffer.alloc(body.length + 8); m.writeUInt32BE(d.length, 0); body.copy(m, 4); m.writeUInt32BE(crc(body), body.length + 4); return m; };
  const head = Buffer.alloc(13); head.writeUInt32BE(w, 0); head.writeUInt32BE(h, 4); head[8] = bits;
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk("IHDR", head), chunk("IDAT", zlib.deflateSync(lines, { level: 1 })), chunk("IEND", Buffer.alloc(0))]);
}
const flatPng = (w, h, bits = 8) => png(w, h, bits, Buffer.alloc(h * (Math.ceil(w * bits / 8) + 1)));
function gsf(head, pixels) {
  const text = `Gwyddion Simple Field 1.0\n${head}`;
  return Buffer.concat([Buffer.from(text), Buffer.alloc(4 - (text.length % 4)), Buffer.from(Float32Array.from(pixels).buffer)]);
}
const field = (unit, v, more = "XReal = 1e-6\nYReal = 1e-6\n") => gsf(`XRes = 16\nYRes = 16\n${more}ZUnits = ${unit}\n`, Array.from({ length: 256 }, (_, i) => (typeof v === "function" ? v(i) : v)));
const curve = (row, head = "z (m), force (N)") => `${head}\n${Array.from({ length: 400 }, (_, i) => row(i)).join("\n")}`;
const good = (i) => `${1e-9 * (100 - (i < 200 ? i : 400 - i))},${1e-10 * Math.max(0, (i < 200 ? i : 400 - i) - 100)}`;
const files = [
  ["bomb.png", () => flatPng(30000, 30000, 1)], ["wide.png", () => flatPng(65535, 4)], ["tiny.png", () => flatPng(1, 1)], ["three.png", () => flatPng(3, 3)],
  ["noise.png", () => Buffer.from(Array.from({ length: 5000 }, (_, i) => (i * 7919) & 255))], ["png.jpg", () => flatPng(16, 16)],
  ["xreal.gsf", () => field("m", (i) => 1e-9 * i, "XReal = 1e300\nYReal = 1e300\n")], ["small.gsf", () => field("m", (i) => 1e-9 * i, "XReal = 1e-300\nYReal = 1e-300\n")],
  ["tall.gsf", () => field("m", (i) => 1e30 * i)], ["metre.gsf", () => field("m", (i) => i)], ["tower.gsf", () => field("m", (i) => (i === 100 ? 1e-3 : 0))],
  ["flat.gsf", () => field("m", 0)], ["deep.gsf", () => field("m", -1e25)], ["kilometre.gsf", () => field("m", (i) => 1e-9 * i, "XReal = 1e3\nYReal = 1e3\n")],
  ["half.gsf", () => gsf("XRes = 4.5\nYRes = 8\n", Array(64).fill(0))], ["minus.gsf", () => gsf("XRes = -8\nYRes = 8\n", Array(64).fill(0))],
  ["nonul.gsf", () => Buffer.from(`Gwyddion Simple Field 1.0\n${"a=b\n".repeat(100000)}`)], ["odd.gsf", () => gsf("XRes = 16\nYRes = 16\nXReal = nan\nYReal = -3\n__proto__ = 4\n", Array(256).fill(0))],
  ["soft.gsf", () => field("Pa", 0)], ["neg.gsf", () => field("Pa", -1e9)], ["hard.gsf", () => field("Pa", 1e30)], ["glue.gsf", () => field("J/m^2", 1e6)],
  ["inf.csv", () => curve((i) => `${i}e307,${i}e307`)], ["si.csv", () => curve((i) => `${400 - i},${i}`)], ["ragged.csv", () => curve((i) => (i % 2 ? good(i) : `${good(i)},3`), "force (N),x,z (m)")],
  ["constz.csv", () => curve((i) => `1e-9,${i}e-12`)], ["same.csv", () => curve(() => "0,0")], ["up.csv", () => curve((i) => `${i}e-9,0`)],
  ["spring0.csv", () => curve(good, "# spring constant [N/m]: 0\nz (m), force (N)")], ["springneg.csv", () => curve(good, "# spring constant [N/m]: -5\nz (m), force (N)")],
  ["springbig.csv", () => curve(good, "# spring constant [N/m]: 1e300\nz (m), force (N)")], ["springtext.csv", () => curve(good, "# spring constant [N/m]: e.e\nz (m), force (N)")],
  ["volt.csv", () => curve(good, "z (V), force (V)")], ["good.csv", () => curve(good)],
  ["long.csv", () => curve(good) + "\n" + Array.from({ length: 600000 }, (_, i) => good(i % 400)).join("\n")], ["line.csv", () => "1,2,".repeat(4e6)],
  ["nest.toml", () => `a = ${"[".repeat(9000)}`], ["nest2.toml", () => `a = ${"{a=".repeat(4000)}`], ["date.toml", () => "[tip]\nradius_nm = 1979-05-27"], ["big.toml", () => "[tip]\nradius_nm = 99999999999999999999999"],
  ["dots.toml", () => "tip.__proto__.x = 1"], ["inf.toml", () => "[tip]\nradius_nm = inf"], ["tiny.toml", () => "[tip]\nradius_m = 1e-10"], ["fat.toml", () => "[tip]\nradius_m = 1e-4"],
  ["soft.toml", () => "[sample]\nyoungs_modulus_Pa = 1"], ["nul.toml", () => "\0\0\0"],
];
const ticking = async (page) => { const { sequence } = await value(page, () => window.nanotouch.seen.now ?? { sequence: -1 }); const end = Date.now() + 60000;
  for (;;) { const now = await value(page, () => window.nanotouch.seen.now?.sequence ?? -1); if (now !== sequence && now > 0) return true; if (Date.now() > end) return false; await page.waitForTimeout(100); } };
const fresh = async (hash = "") => { const got = await visit(context, FILE + hash); got.page.on("dialog", (d) => { console.log("DIALOG", d.message()); d.dismiss(); }); await until(got.page, () => window.nanotouch?.seen.now && window.nanotouch.seen.law); return got; };
const only = process.argv[2];
if (only !== "fragments") {
  let got = await fresh();
  for (const [name, make] of files) {
    const { page, said } = got; said.length = 0;
    const data = Buffer.from(make()); const t0 = Date.now();
    try {
      await value(page, () => { window.nanotouch.seen.notes = []; });
      await page.locator("#file").setInputFiles({ name, mimeType: "application/octet-stream", buffer: data });
      await page.waitForFunction((n) => window.nanotouch.seen.notes.length || window.nanotouch.seen.world?.title === n || (document.querySelector("#sheet h2")?.textContent.startsWith(n) && !document.getElementById("sheet").hidden), name, { timeout: 60000, polling: 50 });
      let form = "";
      for (let k = 0; k < 1; ++k) if (!(await value(page, () => document.getElementById("sheet").hidden)) && (await value(page, (n) => document.querySelector("#sheet h2")?.textContent.startsWith(n), name))) {
        form = (await page.locator("#sheet").innerText()).replace(/\s+/g, " ").slice(0, 110);
        if (name === "wide.png") await page.locator("#sheet input[name=width]").fill("1e30 m");
        await page.locator("#sheet button", { hasText: "Touch it" }).click();
        await page.waitForFunction((n) => window.nanotouch.seen.notes.length || window.nanotouch.seen.world?.title === n, name, { timeout: 60000, polling: 50 });
      }
      const notes = await value(page, () => window.nanotouch.seen.notes.map((n) => n.text).join(" | ")), title = await value(page, () => window.nanotouch.seen.world?.title);
      const goes = await ticking(page);
      const pressedForce = title === name ? await (async () => { await page.focus("#view"); await page.keyboard.down(" "); await page.waitForTimeout(1200); await page.keyboard.up(" "); return value(page, () => [window.nanotouch.seen.now.force, window.nanotouch.seen.now.state, window.nanotouch.stage.grid.factor]); })() : "";
      console.log(JSON.stringify({ name, ms: Date.now() - t0, notes: notes.slice(0, 200), title, goes, form, pressedForce, said: said.filter((w) => !/GL Driver|WebGL/.test(w)).slice(0, 2) }));
      await page.keyboard.press("Escape"); await page.keyboard.press("Enter");
      if (title === name || !goes) { await page.close(); got = await fresh(); }
    } catch (error) { console.log(JSON.stringify({ name, FAIL: String(error).slice(0, 300), said: said.slice(0, 3) })); await page.close().catch(() => {}); got = await fresh(); }
  }
  await got.page.close();
}
const scene = (text) => `#${new URLSearchParams({ scene: text })}`;
const fragments = ["#%", "#%E0%A4%A", "#preset=__proto__", "#preset=constructor", "#preset=dna&preset=x", "#task=__proto__", "#task=constructor", "#task=" + "x".repeat(5000), "#task=stiffer&scene=" + encodeURIComponent("[tip]\nradius_nm=1"),
  scene(`a = ${"[".repeat(5000)}`), scene("[tip]\nradius_nm = 1e-300"), scene("[tip]\nradius_m = 1e-10\n[range]\nmaximum_load_N = 1"), scene("[sample]\nyoungs_modulus_Pa = 1\n[range]\nmaximum_load_N=1e-3"), scene("[medium]\nrelative_humidity_percent = 99.99999"),
  scene("\u202e[tip]\nradius_nm = 3"), scene("[tip]\nradius_nm = 20\nradius_m = 1"), "#wrong=" + encodeURIComponent("<img src=x onerror=alert(1)>"), "#scene=&preset=&task=", "#" + "a=b&".repeat(20000), "#key=abc", "#key="];
for (const fragment of fragments) {
  const { page, said } = await visit(context, FILE + fragment);
  page.on("dialog", (d) => { console.log("DIALOG", d.message()); d.dismiss(); });
  const t0 = Date.now();
  try {
    await page.waitForFunction(() => window.nanotouch?.seen && (window.nanotouch.seen.law || location.hash.includes("key=")), undefined, { timeout: 40000, polling: 50 });
    await page.waitForTimeout(600);
    const out = await value(page, () => ({ title: window.nanotouch.seen.world?.title, notes: window.nanotouch.seen.notes.map((n) => n.text).join(" | ").slice(0, 200), task: window.nanotouch.seen.task.name, force: window.nanotouch.seen.now?.force }));
    const goes = fragment.startsWith("#key=a") ? "-" : await ticking(page);
    console.log(JSON.stringify({ fragment: fragment.slice(0, 60), ms: Date.now() - t0, ...out, goes, said: said.filter((w) => !/GL Driver|WebGL/.test(w)).slice(0, 2) }));
  } catch (error) { console.log(JSON.stringify({ fragment: fragment.slice(0, 60), FAIL: String(error).slice(0, 200), said: said.slice(0, 3) })); }
  await page.close();
}
await close();
