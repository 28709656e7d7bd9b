# SPDX-License-Identifier: BSD-3-Clause
"""Which shared objects a rig file may load: those that the user has allowed, never what a file says by itself.

A rig file names a path; the authority lies with the user: ``allow_code=True`` (``--allow-code``) for once, or
``nanotouch rig allow RIG.toml``, which keeps the SHA-256 of the shared object for this rig file, in
``allowed_code.json`` of the user's configuration folder (``~/.config/nanotouch``). Either way the shared object lies in
the folder of its rig file, or in one of those that the user lists in ``code_folders`` there, a line each.
"""

from __future__ import annotations

import hashlib
import json
import os
from os import PathLike
from pathlib import Path

from nanotouch._io.writing import replacing
from nanotouch.errors import InvalidValue
from nanotouch.touch.hal import SharedObject

Rig = str | PathLike[str]


def configuration() -> Path:
    """The folder in which a user's choices are kept."""
    given = os.environ.get("XDG_CONFIG_HOME", "")
    base = Path(given) if os.path.isabs(given) else Path.home() / ".config"
    return base / "nanotouch"


def check(half: str, named: SharedObject, rig: Rig | None, allow_code: bool) -> None:
    """Refuse a shared object that the user has not allowed. ``rig``: its rig file, None: tables alone are known."""
    path = Path(named.path)
    if rig is not None:
        _check_folder(half, path, Path(rig))
    if allow_code or (rig is not None and is_allowed(rig, named)):
        return
    where = "the rig file" if rig is None else str(rig)
    raise InvalidValue(
        f"{where}: [{half}] path names code, {path}, which would run with all your rights and is not allowed, or has "
        f"changed since. If you trust it: --allow-code (allow_code=True) for once, or nanotouch rig allow {where}"
    )


def is_allowed(rig: Rig, named: SharedObject) -> bool:
    """Whether the user has allowed this rig file to load the shared object as it is now."""
    path = Path(named.path)
    return _remembered().get(_key(rig), {}).get(str(path)) == digest(path)


def remember(rig: Rig, named: SharedObject, half: str) -> str:
    """Allow this rig file to load the shared object as it is now; its SHA-256."""
    path = Path(named.path)
    _check_folder(half, path, Path(rig))
    kept, found = _remembered(), digest(path)
    kept.setdefault(_key(rig), {})[str(path)] = found
    configuration().mkdir(mode=0o700, parents=True, exist_ok=True)
    with replacing(_file()) as part:
        part.write_text(json.dumps(kept, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    return found


def digest(path: Path) -> str:
    """The SHA-256 of a file."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def _file() -> Path:
    return configuration() / "allowed_code.json"


def _key(rig: Rig) -> str:
    return str(Path(rig).resolve())


def _remembered() -> dict[str, dict[str, str]]:
    """By rig file and shared object: its SHA-256."""
    file = _file()
    try:
        kept = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    except (ValueError, RecursionError) as error:
        raise InvalidValue(f"{file} is not JSON ({error}): repair or delete it") from error
    if not isinstance(kept, dict) or not all(isinstance(entry, dict) for entry in kept.values()):
        raise InvalidValue(f"{file} is not a table of rig files: repair or delete it")
    return kept


def _check_folder(half: str, path: Path, rig: Path) -> None:
    """It lies in the folder of its rig file or one of the user's, whatever links and ``..`` its name has."""
    folders = [rig.resolve().parent, rig.parent.resolve(), *_folders()]
    real = path.resolve()
    if not any(real.is_relative_to(folder) for folder in folders):
        raise InvalidValue(
            f"{rig}: [{half}] path leads to {real}, outside the folder of the rig file; folders that may hold code "
            f"stand in {configuration() / 'code_folders'}, a line each"
        )


def _folders() -> list[Path]:
    file = configuration() / "code_folders"
    try:
        lines = file.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        return []
    named = [line.strip() for line in lines if line.strip() and not line.startswith("#")]
    relative = [line for line in named if not os.path.isabs(line)]
    if relative:
        raise InvalidValue(f"{file}: {relative[0]!r}: expected the whole path of a folder")
    return [Path(line).resolve() for line in named]
