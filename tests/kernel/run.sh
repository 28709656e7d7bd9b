#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The drivers on a Linux kernel that runs as a program (User-Mode Linux): once at its own pace, twice in virtual time, in
# which it must say the same, byte for byte.  Built once from Debian's source, kept in build/kernel by version and hash.
# Usage: tests/kernel/run.sh PROGRAM, the one that CMake calls test_kernel
set -eu
program=$(realpath "$1")
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
  timeout 120 "$linux" mem=128M root=/dev/root rootfstype=hostfs rootflags=/ ro loglevel=0 con=null con0=fd:0,fd:1 \
    init="$PWD/init.sh" PROGRAM="$program" "$@" </dev/null >"$log" 2>&1 || true
  grep -q '^RESULT 0' "$log" || { cat "$log" >&2; echo "failed: $log" >&2; exit 1; }
}

mkdir -p "$work"
[ -x "$linux" ] || build
began=$(date +%s)
run "$work/real.log"
sed -n '/^\[==/,/^RESULT/p' "$work/real.log" | grep -av '^\[ RUN'
echo "at the kernel's own pace: $(($(date +%s) - began)) s"
for i in 1 2; do
  run "$work/virtual$i.log" time-travel=inf-cpu TIME=virtual
  sed -n '/^\[==/,/^RESULT/p' "$work/virtual$i.log" | tr -d '\r' >"$work/virtual$i.txt"
done
cmp "$work/virtual1.txt" "$work/virtual2.txt"
grep -a -e '^watchdog' -e '^a bus' -e '^a whole touch' "$work/virtual1.txt"
echo "two runs in virtual time are alike, byte for byte ($(wc -c <"$work/virtual1.txt") bytes)"
