// SPDX-License-Identifier: BSD-3-Clause
// A way to a port of this machine under another number: through a real `ssh -L` over an sshd on loopback with keys of
// its own, or, where there is no sshd, by passing bytes on.
import { execFileSync, spawn } from "node:child_process";
import fs from "node:fs";
import net from "node:net";
import os from "node:os";
import path from "node:path";

const SSHD = "/usr/sbin/sshd", SSH = "/usr/bin/ssh";

const listening = (server) => new Promise((done) => server.listen(0, "127.0.0.1", () => done(server.address().port)));
async function freePort() {
  const server = net.createServer(), port = await listening(server);
  await new Promise((done) => server.close(done));
  return port;
}

async function answers(port) {
  for (;;) {
    const open = await new Promise((done) => {
      const socket = net.connect(port, "127.0.0.1", () => { socket.destroy(); done(true); });
      socket.on("error", () => done(false));
    });
    if (open) return;
    await new Promise((done) => { setTimeout(done, 50); });
  }
}

async function passed(port) {
  const server = net.createServer((near) => {
    const far = net.connect(port, "127.0.0.1");
    near.pipe(far).pipe(near);
    for (const end of [near, far]) end.on("error", () => { near.destroy(); far.destroy(); });
  });
  return { port: await listening(server), kind: "bytes passed on", close: () => server.close() };
}

async function ssh(port) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "nanotouch-ssh-")), at = (name) => path.join(folder, name);
  if (process.getuid() === 0) fs.mkdirSync("/run/sshd", { recursive: true, mode: 0o755 }); // sshd wants it
  for (const name of ["host", "own"]) execFileSync("ssh-keygen", ["-q", "-t", "ed25519", "-N", "", "-f", at(name)]);
  fs.copyFileSync(at("own.pub"), at("allowed"));
  const [door, far] = [await freePort(), await freePort()];
  fs.writeFileSync(at("known"), `[127.0.0.1]:${door} ${fs.readFileSync(at("host.pub"), "utf8")}`);
  const server = spawn(SSHD, ["-D", "-e", "-f", "/dev/null", "-p", `${door}`, "-h", at("host"), "-o", "ListenAddress=127.0.0.1", "-o", "UsePAM=no",
    "-o", `AuthorizedKeysFile=${at("allowed")}`, "-o", "StrictModes=no", "-o", "PidFile=none", "-o", "PasswordAuthentication=no"], { stdio: "ignore" });
  await answers(door);
  const client = spawn(SSH, ["-N", "-F", "/dev/null", "-p", `${door}`, "-i", at("own"), "-o", `UserKnownHostsFile=${at("known")}`, "-o",
    "IdentitiesOnly=yes", "-o", "BatchMode=yes", "-o", "ExitOnForwardFailure=yes", "-L", `${far}:localhost:${port}`, `${os.userInfo().username}@127.0.0.1`],
  { stdio: "inherit" });
  await Promise.race([answers(far), new Promise((_, failed) => { client.on("exit", (status) => failed(new Error(`ssh has ended: ${status}`))); })]);
  return { port: far, kind: "ssh -L", close: () => {
    client.removeAllListeners("exit");
    client.kill();
    server.kill();
    fs.rmSync(folder, { recursive: true, force: true });
  } };
}

export const tunnel = (port) => (fs.existsSync(SSHD) && fs.existsSync(SSH) ? ssh(port) : passed(port));
