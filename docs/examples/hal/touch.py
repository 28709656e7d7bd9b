# SPDX-License-Identifier: BSD-3-Clause
"""A position device at 125 Hz touches the simulated sample: recorded, and shown to observers meanwhile.

Usage: touch.py [SECONDS [FILE]]
"""

import subprocess
import sys
import time
from pathlib import Path

import nanotouch as nt

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))
from pointer import Pointer  # noqa: E402


def rig() -> nt.Rig:
    """The paper's stage and probe; a master that only says where it is."""
    return nt.Rig(master={"motor": "no", "gauge": "no", "rate": 125.0})


def touch(port: int, seconds: float, file: Path, name: str = "pointer") -> None:
    """Touch at the pace of the clock and record it; whoever knows the name may watch."""
    session = nt.Session(rig=rig(), master=Pointer(port))
    session.publish(name)
    session.start("wall", duration=seconds)
    with nt.record.Writer(file, session.metadata()) as writer:
        while session.progress.runs:
            time.sleep(0.05)
            writer.append(session.read(100_000))
        session.halt()
        writer.append(session.read(100_000))
        writer.update(session.metadata())


def main(seconds: float, file: str) -> None:
    """Start the device, touch, say what happened."""
    with subprocess.Popen([sys.executable, str(HERE / "device.py")], stdout=subprocess.PIPE, text=True) as device:
        assert device.stdout is not None
        try:
            touch(int(device.stdout.readline()), seconds, Path(file))
        finally:
            device.terminate()
    recording = nt.record.read(file)
    force = recording.slave_force
    print(f"{len(recording)} ticks, {(recording.state == 0).mean():.1%} of them RUN")
    print(f"force on the sample {force.min() * 1e9:.1f} .. {force.max() * 1e9:.1f} nN")
    print(f"the hand's position is at most {recording.master_age.max() * 1e3:.1f} ms old")


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 8.0, sys.argv[2] if len(sys.argv) > 2 else "pointer.mcap")
