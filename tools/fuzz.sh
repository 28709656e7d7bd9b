#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Runs the libFuzzer targets of build/fuzz beside each other. What they find is kept in build/fuzz/corpus, and the next run
# goes on from there; an input that breaks a target lies in build/fuzz/found.  Usage: tools/fuzz.sh HOURS JOBS [TARGET...]
set -eu
cd "$(dirname "$0")/.."
hours=${1:?usage: tools/fuzz.sh HOURS JOBS [TARGET...]}
jobs=${2:?}
shift 2
[ $# -gt 0 ] || set -- $(basename -a -s .c tests/fuzz/fuzz_*.c)
seconds=$(awk "BEGIN { s = int(3600 * $hours * $jobs / $#); print s < 5 ? 5 : s }")
mkdir -p build/fuzz/found

run_one() {
  mkdir -p "build/fuzz/corpus/$1"
  log=build/fuzz/$1.log
  result=held
  "build/fuzz/tests/fuzz/$1" -max_total_time="$2" -max_len=4096 -timeout=20 -rss_limit_mb=2000 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/found/$1-" "build/fuzz/corpus/$1" "tests/fuzz/corpus/$1" >"$log" 2>&1 || result=BROKEN
  count=$(sed -n 's/.*number_of_executed_units: *//p' "$log")
  echo "$1: $result, ${count:-?} inputs in $2 s, $(find "build/fuzz/corpus/$1" -type f | wc -l) kept"
  [ $result = held ] || { tail -n 30 "$log" && exit 1; }
}

# A shell has no pool: each slot takes the targets of its number.
failed=0
slot=0
while [ $slot -lt "$jobs" ]; do
  (
    number=0
    bad=0
    for target; do
      [ $((number % jobs)) -ne $slot ] || (run_one "$target" "$seconds") || bad=1
      number=$((number + 1))
    done
    exit $bad
  ) &
  slots="${slots-} $!"
  slot=$((slot + 1))
done
for one in $slots; do wait "$one" || failed=1; done
exit $failed
