#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Builds the example programs with a compiler and pkg-config alone, and runs them.
# Usage: pkg_config.sh PREFIX WORK [--static]
set -eu
prefix=$1 work=$2 static=${3:-}
programs=$(cd "$(dirname "$0")/../../apps/c" && pwd)
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name nanotouch.pc)")
export PKG_CONFIG_PATH
mkdir -p "$work"
for source in "$programs"/*.c; do
  package=nanotouch
  case $source in *fit*) package=nanotouch-fit ;; *testing*) package=nanotouch-testing ;; esac
  if ! pkg-config --exists "$package"; then
    echo "no $package: $(basename "$source") is left out"
    continue
  fi
  program=$work/$(basename "$source" .c)
  # shellcheck disable=SC2046
  ${CC:-cc} -std=c11 "$source" -o "$program" $(pkg-config --cflags --libs $static "$package")
  echo "== $(basename "$program")"
  LD_LIBRARY_PATH=$(pkg-config --variable=libdir nanotouch) "$program"
done
