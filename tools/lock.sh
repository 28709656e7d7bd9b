#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Write tools/lock/demo.txt and test.txt: each package of the two commands by version and SHA-256, for Python 3.11 and
# later on every system. Usage: tools/lock.sh
set -eu
cd "$(dirname "$0")/.."
.venv/bin/python -m pip --disable-pip-version-check install -q uv
mkdir -p build
for lock in demo test; do
  case $lock in demo) extras=all ;; *) extras=all,test ;; esac
  .venv/bin/python tools/requirements.py $extras >build/asked.txt
  .venv/bin/uv pip compile -q --upgrade --universal --python-version 3.11 --generate-hashes --no-header --no-annotate \
    --no-emit-index-url build/asked.txt -o tools/lock/$lock.txt
done
