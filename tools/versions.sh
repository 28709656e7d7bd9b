#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Test the oldest and the newest versions of the packages that pyproject.toml allows, each in a .venv of its own.
# Usage: tools/versions.sh [what pytest takes, by default all quick tests of files]
set -eu
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- tests/python/test_guard.py tests/python/test_readers.py tests/python/test_record.py tests/python/test_curves_reading.py \
  tests/python/test_maps.py tests/python/test_fit_models.py tests/python/test_plots.py
.venv/bin/python -m pip --disable-pip-version-check install -q uv
.venv/bin/python tools/requirements.py all,test >build/asked.txt
for which in lowest-direct highest; do
  room=build/versions/$which
  .venv/bin/uv venv -q --clear --seed --python .venv/bin/python "$room"
  .venv/bin/uv pip compile -q --resolution $which --python "$room/bin/python" build/asked.txt -o "$room/versions.txt"
  .venv/bin/uv pip install -q --python "$room/bin/python" -r "$room/versions.txt"
  .venv/bin/uv pip install -q --python "$room/bin/python" --no-deps --no-build-isolation .
  echo "-- $which: $(grep -c == "$room/versions.txt") packages" >&2
  "$room/bin/python" -m pytest -q "$@"
done
