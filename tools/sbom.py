# SPDX-License-Identifier: BSD-3-Clause
"""Print the list of parts of nanotouch as CycloneDX JSON: the packages of a lock file, with versions and hashes.

Usage: sbom.py tools/lock/demo.txt >sbom.json
"""

from __future__ import annotations

import json
import re
import sys
import tomllib
import uuid
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
_PACKAGE = re.compile(r"^([A-Za-z0-9._-]+)==([^\s;\\]+)(?:\s*;\s*([^\\]+?))?\s*\\?$")
_HASH = re.compile(r"--hash=sha256:([0-9a-f]{64})")


def locked(text: str) -> list[dict[str, Any]]:
    """Name, version, marker and hashes of each package of a lock file; ValueError for a line that is none."""
    found: list[dict[str, Any]] = []
    for line in text.splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        if not line.startswith(" "):
            package = _PACKAGE.match(line)
            if package is None:
                raise ValueError(f"{line!r} is no package of a version")
            name, version, marker = package.groups()
            found.append({"name": name, "version": version, "marker": marker or "", "hashes": []})
        found[-1]["hashes"] += _HASH.findall(line)
    return found


def parts(packages: list[dict[str, Any]], version: str) -> dict[str, Any]:
    """As CycloneDX 1.5 has it."""
    components = []
    for one in packages:
        name = re.sub(r"[-_.]+", "-", one["name"]).lower()
        url = f"pkg:pypi/{name}@{one['version']}"
        files = [{"alg": "SHA-256", "content": digest} for digest in one["hashes"]]
        about = [{"name": "python:marker", "value": one["marker"]}] if one["marker"] else []
        components.append(
            {"type": "library", "bom-ref": url, "name": name, "version": one["version"], "purl": url,
             "properties": about, "externalReferences": [{"type": "distribution", "url": url, "hashes": files}]}
        )  # fmt: skip
    root = {"type": "application", "bom-ref": "nanotouch", "name": "nanotouch", "version": version,
            "licenses": [{"license": {"id": "BSD-3-Clause"}}]}  # fmt: skip
    serial = uuid.uuid5(uuid.NAMESPACE_URL, json.dumps(components, sort_keys=True))
    return {
        "bomFormat": "CycloneDX", "specVersion": "1.5", "serialNumber": f"urn:uuid:{serial}", "version": 1,
        "metadata": {"component": root}, "components": components,
        "dependencies": [{"ref": "nanotouch", "dependsOn": [one["bom-ref"] for one in components]}],
    }  # fmt: skip


def main() -> None:
    """Print it."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["scikit-build"]
    known = settings["metadata"]["version"]
    text = (ROOT / known["input"]).read_text(encoding="utf-8")
    version = re.search(known["regex"], text)
    assert version is not None
    packages = locked(Path(sys.argv[1]).read_text(encoding="utf-8"))
    print(json.dumps(parts(packages, version["value"]), indent=1))


if __name__ == "__main__":
    main()
