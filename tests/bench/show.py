# SPDX-License-Identifier: BSD-3-Clause
"""Print what `bench` measured, one column per instruction set: nanoseconds and multiples of Hertz in the same build.

Run: python show.py FOLDER     (where bench_contact_*.json are)
"""

import json
import sys
from pathlib import Path


def main() -> None:
    """Print the table of one folder."""
    runs = [json.loads(path.read_text()) for path in sorted(Path(sys.argv[1]).glob("bench_contact_*.json"))]
    print(f"{'ns (multiples of Hertz)':<32}{'lambda':>8}" + "".join(f"{run['instructions']:>22}" for run in runs))
    for rows in zip(*(run["benchmarks"] for run in runs), strict=True):
        columns = "".join(f"{row['ns']:>12.4g}{'(' + format(row['hertz'], '.3g') + ')':>10}" for row in rows)
        print(f"{rows[0]['name']:<32}{rows[0]['lambda']:>8g}{columns}")


if __name__ == "__main__":
    main()
