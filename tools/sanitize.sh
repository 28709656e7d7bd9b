#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Clang's sanitizers over the tests: ASan with UBSan over those in C and those of the Python extensions, TSan over those
# in C. A report is a failure. The sample is what
# crosses a border and is soon built: foreign bytes, shared memory, threads.
# Usage: tools/sanitize.sh all|sample
set -eu
cd "$(dirname "$0")/.."
amount=${1:?usage: tools/sanitize.sh all|sample}
jobs=${JOBS:-$(nproc)}
python=$PWD/.venv/bin/python
export UBSAN_OPTIONS=print_stacktrace=1 TSAN_OPTIONS=halt_on_error=1
address="core_field core_ring core_same_bits curves_read hal_capabilities hal_hal hal_mailbox hal_replay"
threads="core_ring hal_mailbox"

# Clang 14's thread sanitizer cannot start where addresses are laid out at random.
unrandomized=
! setarch -R true 2>/dev/null || unrandomized="setarch -R"

# in_c PRESET NAME...: build and run these tests, all without a name.
in_c() {
  preset=$1
  shift
  if [ $# = 0 ]; then
    cmake --build --preset "$preset"
    $unrandomized ctest --preset "$preset" -j "$jobs" -R '^test_'
  else
    cmake --build --preset "$preset" --target $(printf 'test_%s ' "$@")
    $unrandomized ctest --preset "$preset" -j "$jobs" -R "^test_($(echo "$*" | tr ' ' '|'))\$"
  fi
}

# The interpreter keeps what it allocates until it ends: leaks of the library are looked for by the C tests alone.
in_python() {
  site=build/asan/site
  rm -rf "$site"
  mkdir -p "$site"
  cp -r bindings/python/nanotouch apps/nanotouch_app "$site"
  cp build/asan/bindings/python/_*.so "$site/nanotouch"
  PYTHONPATH=$PWD/$site LD_PRELOAD=$(clang -print-file-name="libclang_rt.asan-$(uname -m).so") ASAN_OPTIONS=detect_leaks=0 \
    "$python" -m pytest -q -n "$jobs" -p no:cacheprovider tests/python
}

failed=0
cmake --preset tsan --log-level WARNING >/dev/null
if [ "$amount" = sample ]; then
  cmake --preset asan --log-level WARNING -DNANOTOUCH_FIT=OFF >/dev/null
  in_c asan $address || failed=1
  in_c tsan $threads || failed=1
else
  cmake --preset asan --log-level WARNING -DNANOTOUCH_FIT=ON -DNANOTOUCH_PYTHON=ON "-DPython_EXECUTABLE=$python" \
    "-Dpybind11_DIR=$("$python" -m pybind11 --cmakedir)" >/dev/null
  in_c asan || failed=1
  in_c tsan || failed=1
  in_python || failed=1
fi
exit $failed
