#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# The portable core on 64-bit Windows: its C tests, compiled by MinGW, run under Wine.  Usage: tests/windows/run.sh
# Debian: gcc-mingw-w64-x86-64-posix wine64
set -eu
cd "$(dirname "$0")/../.."
for wine in wine64 wine /usr/lib/wine/wine64; do
  ! command -v "$wine" >/dev/null || break
done
command -v "$wine" >/dev/null || { echo "wine64 is missing" >&2; exit 1; }

work=$PWD/build/windows
cmocka=$work/cmocka
if [ ! -d "$cmocka" ]; then
  mkdir -p "$cmocka.part"
  curl -fsSL -o "$work/cmocka.tar.xz" \
    "${DEBIAN_MIRROR:-https://deb.debian.org/debian}/pool/main/c/cmocka/cmocka_1.1.7.orig.tar.xz"
  echo "810570eb0b8d64804331f82b29ff47c790ce9cd6b163e98d47a4807047ecad82  $work/cmocka.tar.xz" | sha256sum -c --quiet
  tar -xf "$work/cmocka.tar.xz" -C "$cmocka.part" --strip-components 1
  mv "$cmocka.part" "$cmocka"
fi

export WINEPREFIX="$work/wine" WINEDEBUG=-all
cmake -S tests/windows -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMOCKA_SOURCE="$cmocka" \
  -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/toolchains/x86_64-w64-mingw32.cmake" -DCMAKE_CROSSCOMPILING_EMULATOR="$wine" \
  --log-level WARNING
cmake --build "$work/build" -j "${JOBS:-1}" -- -k 0 || true # a test that does not compile is reported below
ctest --test-dir "$work/build" --output-on-failure -j "${JOBS:-1}"
