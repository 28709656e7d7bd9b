#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Clang's sanitizers over the tests: ASan with UBSan over those in C and over those of the Python extensions, TSan over
# those in C. Any report is a failure.  Usage: tools/sanitize.sh all|sample
set -eu
cd "$(dirname "$0")/.."
amount=${1:?usage: tools/sanitize.sh all|sample}
jobs=${JOBS:-$(nproc)}
python=$PWD/.venv/bin/python

if [ "$amount" = sample ]; then
  # What crosses a border: foreign bytes, handles, threads, and arithmetic at its extremes.
  asan='^test_(core_.*|hal_(capabilities|conformance|hal|load|replay)|session_(session|requests|tapping|memory)|surface_.*|curves_read)$'
  tsan='^test_(core_ring|hal_mailbox_race|session_(frames|observed))$'
  python_tests='tests/python/test_sanitized.py tests/python/test_arrays.py'
else
  asan='^test_'
  tsan='^test_'
  python_tests='tests/python'
fi

# --- C ---------------------------------------------------------------------------------------------------------------
export UBSAN_OPTIONS=print_stacktrace=1 TSAN_OPTIONS=halt_on_error=1
cmake --preset asan --log-level WARNING -DNANOTOUCH_PYTHON=ON "-Dpybind11_DIR=$("$python" -m pybind11 --cmakedir)" \
  "-DPython_EXECUTABLE=$python" >/dev/null
cmake --build --preset asan
failed=0
ctest --preset asan -j "$jobs" -R "$asan" || failed=1

# ThreadSanitizer of clang 14 cannot start where addresses are laid out at random.
unrandomized=
! setarch -R true 2>/dev/null || unrandomized="setarch -R"
cmake --preset tsan --log-level WARNING >/dev/null
cmake --build --preset tsan
$unrandomized ctest --preset tsan -j "$jobs" -R "$tsan" || failed=1

# --- Python ----------------------------------------------------------------------------------------------------------
site=build/asan/site
rm -rf "$site"
mkdir -p "$site"
cp -r bindings/python/nanotouch apps/nanotouch_app "$site"
cp build/asan/bindings/python/_*.so "$site/nanotouch"
runtime=$(clang -print-file-name="libclang_rt.asan-$(uname -m).so")
# The interpreter keeps what it allocates until it ends; leaks of the extensions are looked for by the C tests.
PYTHONPATH=$PWD/$site LD_PRELOAD=$runtime ASAN_OPTIONS=detect_leaks=0 \
  "$python" -m pytest -q -n "$jobs" -p no:cacheprovider $python_tests || failed=1
exit $failed
