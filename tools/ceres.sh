#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# A Ceres for the wheels: static, on Eigen alone. No SuiteSparse, LAPACK or glog, so nothing under the GPL.
# Sources come from Debian's pool and are checked by hash. Prints the folder to give to CMake as CMAKE_PREFIX_PATH, which
# build/deps/ceres links to. Its name has the hash of the recipe below: what was built once is used again.
# For another system: CXX and CMAKE_TOOLCHAIN_FILE in the environment.
# Usage: tools/ceres.sh
set -eu
cd "$(dirname "$0")/.."
sha256() { if command -v sha256sum >/dev/null; then sha256sum "$@"; else shasum -a 256 "$@"; fi; } # macOS has the latter
key=$(sed '1,/^# --- recipe/d' tools/ceres.sh | sha256 | cut -c 1-12)-$(${CXX:-c++} -dumpmachine)
name=ceres-$key
prefix=$PWD/build/deps/$name
finish() {
  [ -n "${CMAKE_TOOLCHAIN_FILE:-}" ] || ln -sfn "$name" build/deps/ceres
  echo "$prefix"
  exit
}
[ ! -f "$prefix/licences/Ceres.txt" ] || finish

# --- recipe ---------------------------------------------------------------------------------------------------------
pool=${DEBIAN_MIRROR:-https://deb.debian.org/debian}/pool/main
ceres=ceres-solver_2.2.0+dfsg.orig.tar.xz
ceres_hash=fb22a61518dadb2cdfdbc698fbc9620d6d1e5e1b68a93b983086b668e39f395a
eigen=eigen3_3.4.0.orig.tar.bz2
eigen_hash=b4c198460eba6f28d34894e3a5710998818515104d6e74e5cc331ce31e46e626
part=$PWD/build/deps/ceres.part
rm -rf "$part" "$prefix"
mkdir -p "$part/ceres" "$part/eigen"

# fetch URL HASH FOLDER
fetch() {
  curl -fsSL --retry 5 -o "$part/archive" "$1"
  echo "$2  $part/archive" | sha256 -c >&2
  tar -xf "$part/archive" -C "$3" --strip-components 1
}
fetch "$pool/c/ceres-solver/$ceres" $ceres_hash "$part/ceres"
fetch "$pool/e/eigen3/$eigen" $eigen_hash "$part/eigen"

quietly() { "$@" >"$part/log" 2>&1 || { tail -n 40 "$part/log" >&2; exit 1; }; }
quietly cmake -S "$part/eigen" -B "$part/build-eigen" -DCMAKE_INSTALL_PREFIX="$prefix" \
  -DBUILD_TESTING=OFF -DEIGEN_BUILD_DOC=OFF -DEIGEN_BUILD_PKGCONFIG=OFF -DCMAKE_Fortran_COMPILER=NOTFOUND
quietly cmake --install "$part/build-eigen"
# MPL2_ONLY: an error, should Ceres include one of the few LGPL files of Eigen 3.4.
quietly cmake -S "$part/ceres" -B "$part/build" -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_PREFIX_PATH="$prefix" \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=-DEIGEN_MPL2_ONLY -DCMAKE_POSITION_INDEPENDENT_CODE=ON \
  -DCMAKE_CXX_VISIBILITY_PRESET=hidden -DCMAKE_VISIBILITY_INLINES_HIDDEN=ON -DBUILD_SHARED_LIBS=OFF \
  -DMINIGLOG=ON -DGFLAGS=OFF -DSUITESPARSE=OFF -DLAPACK=OFF -DEIGENSPARSE=OFF -DEIGENMETIS=OFF -DUSE_CUDA=OFF \
  -DSCHUR_SPECIALIZATIONS=OFF -DBUILD_TESTING=OFF -DBUILD_EXAMPLES=OFF -DBUILD_BENCHMARKS=OFF -DPROVIDE_UNINSTALL_TARGET=OFF
quietly nice cmake --build "$part/build" -j "${JOBS:-1}"
quietly cmake --install "$part/build"

mkdir "$prefix/licences"
cp "$part/eigen/COPYING.MPL2" "$prefix/licences/Eigen.txt"
cp "$part/ceres/LICENSE" "$prefix/licences/Ceres.txt"
rm -rf "$part"
finish
