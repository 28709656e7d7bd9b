#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The drivers on a Linux kernel that runs as a program (User-Mode Linux): at its own pace, for tapping alone, under the
# commands `nanotouch touch` and `nanotouch scan`, and twice in virtual time, in which it must say the same, byte for
# byte. Built once from Debian's source, kept in build/kernel by version and hash.
# Usage: tests/kernel/run.sh PROGRAM PYTHON    the one that CMake calls test_kernel; where nanotouch is installed
set -eu
program=$(realpath "$1")
python=$(realpath -s "$2")
cd "$(dirname "$0")"
source=linux-source-6.12
version=$(dpkg-query -W -f '${Version}' $source)
key=$( (echo "$version" && cat config linux.patch spi_bus.c nanotouch_bus.h) | sha256sum | cut -c 1-16)
work=$(realpath ../..)/build/kernel
linux=$work/linux-$version-$key

build() {
  echo "-- Building the kernel, once (some minutes, 2 GB meanwhile)" >&2
  rm -rf "$work/tree" "$work/objects"
  mkdir -p "$work/tree" "$work/objects"
  tar -xf /usr/src/$source.tar.xz -C "$work/tree" --strip-components 1
  patch -s -p 1 -d "$work/tree" <linux.patch
  cp spi_bus.c "$work/tree/drivers/spi/nanotouch_bus.c"
  cp nanotouch_bus.h "$work/tree/drivers/spi/"
  echo 'obj-y += nanotouch_bus.o' >>"$work/tree/drivers/spi/Makefile"
  compiler=gcc
  ! command -v ccache >/dev/null || compiler="ccache gcc"
  in_tree() { nice make -s -C "$work/tree" ARCH=um O="$work/objects" CC="$compiler" HOSTCC="$compiler" "$@"; }
  {
    in_tree tinyconfig
    cat config >>"$work/objects/.config"
    in_tree olddefconfig
    in_tree -j "${JOBS:-2}" linux
  } >"$work/build.log" 2>&1 || { tail -n 30 "$work/build.log" >&2; exit 1; }
  for wanted in $(grep '^CONFIG_' config); do # Kconfig leaves out in silence what depends on something else
    grep -qxF "$wanted" "$work/objects/.config" || { echo "the kernel lacks $wanted" >&2; exit 1; }
  done
  strip -o "$linux.part" "$work/objects/linux"
  mv "$linux.part" "$linux"
  rm -rf "$work/tree" "$work/objects"
}

# run LOG [OPTION...]: one boot, what the program said, and the power off.
run() {
  log=$1
  shift
  timeout 300 "$linux" mem=512M root=/dev/root rootfstype=hostfs rootflags=/ ro loglevel=0 con=null con0=fd:0,fd:1 \
    init="$PWD/init.sh" PROGRAM="$program" "$@" </dev/null >"$log" 2>&1 || true
  grep -q '^RESULT 0' "$log" || { cat "$log" >&2; echo "failed: $log" >&2; exit 1; }
}

# A touch by the command, on the simulated rig here and on the drivers there.
touch_by_command() {
  "$python" command.py "$work/command" prepare >"$work/simulated.log" 2>&1 || { cat "$work/simulated.log" >&2; exit 1; }
  run "$work/command.log" time-travel=inf-cpu TIME=virtual FOLDER="$work/command" NANOTOUCH="$(dirname "$python")/nanotouch"
  "$python" command.py "$work/command" compare
}

# An image in contact mode: there, and by a session on the simulated rig here.
scan_by_command() {
  "$python" command.py "$work/scan" prepare-scan
  run "$work/scan.log" time-travel=inf-cpu TIME=virtual SCAN=yes FOLDER="$work/scan" NANOTOUCH="$(dirname "$python")/nanotouch"
  "$python" command.py "$work/scan" compare-scan
}

in_virtual_time() {
  run "$work/virtual$1.log" time-travel=inf-cpu TIME=virtual
  sed -n '/^\[==/,/^RESULT/p' "$work/virtual$1.log" | tr -d '\r' >"$work/virtual$1.txt"
}

mkdir -p "$work"
[ -x "$linux" ] || build
began=$(date +%s)
touch_by_command >"$work/command.txt" &
touching=$!
run "$work/real.log"
sed -n '/^\[==/,/^RESULT/p' "$work/real.log" | grep -av '^\[ RUN'
wait $touching
cat "$work/command.txt"
echo "conformance, safety and a touch: $(($(date +%s) - began)) s"
in_virtual_time 1 &
first=$!
scan_by_command >"$work/scan.txt" &
scanning=$!
run "$work/tapping.log" TAPPING=yes &
tapping=$!
in_virtual_time 2
wait $first
wait $scanning
wait $tapping
cmp "$work/virtual1.txt" "$work/virtual2.txt"
grep -a -e '^watchdog' -e '^a bus' "$work/virtual1.txt"
echo "two runs in virtual time are alike, byte for byte ($(wc -c <"$work/virtual1.txt") bytes)"
grep -a '^tapping' "$work/tapping.log"
cat "$work/scan.txt"
echo "all: $(($(date +%s) - began)) s"
