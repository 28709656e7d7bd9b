# SPDX-License-Identifier: BSD-3-Clause
"""What a process gives up before it reads a file from elsewhere: memory and time beyond limits, all files but this one
and the libraries (Landlock), programs, sockets and other processes (seccomp). Each is taken where the kernel has it."""

from __future__ import annotations

import ctypes
import os
import platform
import resource
import signal
import stat
import struct
import sys
import sysconfig
from collections.abc import Iterable, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

_NO_NEW_PRIVS, _SECCOMP, _FILTER = 38, 22, 2
_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446
_READ_FILE, _READ_FOLDER, _EXECUTE = 1 << 2, 1 << 3, 1 << 0
_READ = _READ_FILE | _READ_FOLDER | _EXECUTE
_WRITE = sum(1 << bit for bit in (1, 4, 5, 7, 8, 12))  # write to, remove and make files, folders and links
_TRUNCATE = 1 << 14
_RIGHTS = (0, 13, 14, 15, 15, 16)  # number of rights over files that each version of Landlock knows
_SYSTEM = ("/usr/lib", "/usr/lib64", "/lib", "/lib64", "/usr/share/zoneinfo", "/etc/localtime", "/etc/ld.so.cache",
           "/dev/null", "/dev/urandom", "/sys/devices/system/cpu", "/proc/cpuinfo",
           "/proc/meminfo")  # fmt: skip

# Numbers of system calls: those of x86-64, and of the table that newer machines share.
_NUMBERS = {
    "x86_64": (0xC000003E, {
        "socket": 41, "connect": 42, "accept": 43, "bind": 49, "listen": 50, "socketpair": 53, "clone": 56, "fork": 57,
        "vfork": 58, "execve": 59, "kill": 62, "ptrace": 101, "pivot_root": 155, "chroot": 161, "mount": 165,
        "umount2": 166, "tkill": 200, "tgkill": 234, "add_key": 248, "request_key": 249, "keyctl": 250,
        "unshare": 272, "accept4": 288, "perf_event_open": 298, "open_by_handle_at": 304, "setns": 308,
        "process_vm_readv": 310, "process_vm_writev": 311, "bpf": 321, "execveat": 322, "userfaultfd": 323,
    }),
    "aarch64": (0xC00000B7, {
        "umount2": 39, "mount": 40, "pivot_root": 41, "chroot": 51, "unshare": 97, "ptrace": 117, "kill": 129,
        "tkill": 130, "tgkill": 131, "socket": 198, "socketpair": 199, "bind": 200, "listen": 201, "accept": 202,
        "connect": 203, "add_key": 217, "request_key": 218, "keyctl": 219, "clone": 220, "execve": 221,
        "perf_event_open": 241, "accept4": 242, "open_by_handle_at": 265, "setns": 268, "process_vm_readv": 270,
        "process_vm_writev": 271, "bpf": 280, "execveat": 281, "userfaultfd": 282,
    }),
}  # fmt: skip
_SHARED = {"pidfd_send_signal": 424, "io_uring_setup": 425, "io_uring_enter": 426, "io_uring_register": 427,
           "open_tree": 428, "move_mount": 429, "fsopen": 430, "pidfd_open": 434, "pidfd_getfd": 438}  # fmt: skip
_CLONE3, _CLONE_THREAD, _X32 = 435, 0x10000, 0x40000000
_LOAD, _JUMP_EQUAL, _JUMP_AT_LEAST, _JUMP_SET, _RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
_ALLOW, _REFUSE, _ABSENT, _KILL = 0x7FFF0000, 0x00050001, 0x00050026, 0x80000000  # EPERM, ENOSYS

_libc = ctypes.CDLL(None, use_errno=True) if sys.platform == "linux" else None


def confine(limits: Mapping[str, Any], readable: Iterable[Path], scratch: tuple[Path, int] | None) -> None:
    """Give up everything but reading these files, and writing into the folder ``scratch``, files of so many bytes."""
    has_kernel = _libc is not None and _libc.prctl(_NO_NEW_PRIVS, 1, 0, 0, 0) == 0
    if has_kernel:
        _restrict_files(readable, scratch[0] if scratch else None)
        for opened, _ in prepare():
            os.close(opened)
    set_limits(limits, scratch[1] if scratch else 0)
    if has_kernel:
        _restrict_calls()


def set_limits(limits: Mapping[str, Any], file_size: int) -> None:
    """Memory beside what is there already, time, files."""
    seconds = max(1, round(limits["time"]))
    memory = _address_space() + int(limits["memory"])
    for what, value in (
        (resource.RLIMIT_AS, memory),
        (resource.RLIMIT_FSIZE, file_size),
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_NOFILE, int(limits["files"])),
    ):
        hard = resource.getrlimit(what)[1]
        value = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(what, (value, value))
    spent = int(sum(os.times()[:2]))  # what a process has used counts
    resource.setrlimit(resource.RLIMIT_CPU, (spent + seconds, spent + seconds + 1))
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_REAL, 3.0 * limits["time"])


def _address_space() -> int:
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    except OSError:  # no Linux: this limit is of the whole then
        return 0
    return pages * resource.getpagesize()


def _restrict_files(readable: Iterable[Path], scratch: Path | None) -> None:
    """Landlock: reading what is named, and the libraries."""
    assert _libc is not None
    version = _libc.syscall(_CREATE_RULESET, None, 0, 1)
    if version < 1:
        return
    every = (1 << _RIGHTS[min(version, len(_RIGHTS) - 1)]) - 1
    network, scoped = (3 if version >= 4 else 0), (3 if version >= 6 else 0)
    asked = struct.pack("<3Q", every, network, scoped)[: 8 if version < 4 else 16 if version < 6 else 24]
    ruleset = _libc.syscall(_CREATE_RULESET, asked, len(asked), 0)
    if ruleset < 0:
        raise OSError(ctypes.get_errno(), "Landlock takes no rules")
    for opened, rights in prepare():
        _add_rule(ruleset, opened, rights)
    for place in (Path("/proc/self"), *readable):
        _allow(ruleset, place, _READ_FILE | _READ_FOLDER)
    if scratch is not None:
        _allow(ruleset, scratch, _READ_FILE | _READ_FOLDER | _WRITE | (_TRUNCATE if version >= 3 else 0))
    if _libc.syscall(_RESTRICT_SELF, ruleset, 0) != 0:
        raise OSError(ctypes.get_errno(), "Landlock refuses its own rules")
    os.close(ruleset)


def _libraries() -> list[Path]:
    """Where Python and its packages are."""
    paths = [*sysconfig.get_paths().values(), *sys.path, *_package_folders()]
    return [Path(path) for path in dict.fromkeys(paths) if path and os.path.isabs(path)]


def _package_folders() -> set[str]:
    """Where what is imported already lies: an editable package is nowhere on the path."""
    files = (getattr(module, "__file__", None) for name, module in sys.modules.items() if "." not in name)
    return {os.path.dirname(file) for file in files if file}


@lru_cache(maxsize=1)
def prepare() -> tuple[tuple[int, int], ...]:
    """The libraries, opened, with the rights to them: done once by the process that forks those that are confined."""
    places = [*map(Path, _SYSTEM), *_libraries()] if _libc is not None else []
    return tuple(found for place in places if (found := _opened(place, _READ)) is not None)


def _opened(place: Path, rights: int) -> tuple[int, int] | None:
    try:
        opened = os.open(place, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return None
    return opened, rights if stat.S_ISDIR(os.fstat(opened).st_mode) else rights & (_READ_FILE | _EXECUTE)


def _allow(ruleset: int, place: Path, rights: int) -> None:
    found = _opened(place, rights)
    if found is not None:
        _add_rule(ruleset, *found)
        os.close(found[0])


def _add_rule(ruleset: int, opened: int, rights: int) -> None:
    assert _libc is not None
    _libc.syscall(_ADD_RULE, ruleset, 1, struct.pack("<Qi", rights, opened), 0)


def _restrict_calls() -> None:
    """seccomp: no program, socket, new process, signal to another one, nor what attackers of kernels like."""
    assert _libc is not None
    known = _NUMBERS.get(platform.machine())
    if known is None or sys.maxsize < 1 << 32:
        return
    architecture, numbers = known
    steps = [(_LOAD, 0, 0, 4), (_JUMP_EQUAL, 1, 0, architecture), (_RETURN, 0, 0, _KILL), (_LOAD, 0, 0, 0)]
    if architecture == _NUMBERS["x86_64"][0]:
        steps += [(_JUMP_AT_LEAST, 0, 1, _X32), (_RETURN, 0, 0, _KILL)]
    own, refused = ("kill", "tgkill"), numbers | _SHARED
    for name, number in refused.items():
        if name not in (*own, "clone"):
            steps += [(_JUMP_EQUAL, 0, 1, number), (_RETURN, 0, 0, _REFUSE)]
    steps += [(_JUMP_EQUAL, 0, 1, _CLONE3), (_RETURN, 0, 0, _ABSENT)]
    for name in own:  # abort() is a signal to oneself
        steps += [(_JUMP_EQUAL, 0, 4, numbers[name]), (_LOAD, 0, 0, 16), (_JUMP_EQUAL, 0, 1, os.getpid()),
                  (_RETURN, 0, 0, _ALLOW), (_RETURN, 0, 0, _REFUSE)]  # fmt: skip
    steps += [(_JUMP_EQUAL, 0, 4, numbers["clone"]), (_LOAD, 0, 0, 16), (_JUMP_SET, 0, 1, _CLONE_THREAD),
              (_RETURN, 0, 0, _ALLOW), (_RETURN, 0, 0, _REFUSE), (_RETURN, 0, 0, _ALLOW)]  # fmt: skip
    program = ctypes.create_string_buffer(b"".join(struct.pack("<HBBI", *step) for step in steps))
    described = struct.pack("<HxxxxxxQ", len(steps), ctypes.addressof(program))
    _libc.prctl(_SECCOMP, _FILTER, described, 0, 0)
