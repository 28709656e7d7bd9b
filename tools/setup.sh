#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# All the set-up of `make demo` and `make test`: system packages, .venv, libgpiod 2, the package with its extras.
# What is already there is left alone, so a second run takes a second.  Usage: tools/setup.sh demo|docs|test|bench|lint|fuzz|coverage|sanitize|mutate|kernel|page|wheels|windows
set -eu
cd "$(dirname "$0")/.."
profile=${1:?usage: tools/setup.sh demo|docs|test|bench|lint|fuzz|coverage|sanitize|mutate|kernel|page|wheels|windows}
say() {
  if [ -t 2 ] && [ -z "${NO_COLOR:-}" ]; then printf '\033[1m%s\033[0m\n' "-- $*" >&2; else echo "-- $*" >&2; fi
}

packages="build-essential cmake ninja-build pkg-config python3-venv python3-dev libceres-dev libegl1 libgl1-mesa-dri"
extras=all
if [ "$profile" = test ] || [ "$profile" = sanitize ] || [ "$profile" = mutate ]; then
  packages="$packages libcmocka-dev libiio-dev gcc-aarch64-linux-gnu libc6-dev-arm64-cross gcc-arm-none-eabi libnewlib-arm-none-eabi
    gcc-mingw-w64-x86-64-posix qemu-user qemu-system-arm valgrind"
  extras=all,test
  [ "$profile" = test ] || packages="$packages clang libclang-rt-dev"
  [ "$profile" != mutate ] || extras=all,test,mutate
elif [ "$profile" = docs ]; then
  extras=all,docs
elif [ "$profile" = lint ]; then
  extras=all,test,lint
elif [ "$profile" = fuzz ]; then
  packages="build-essential cmake ninja-build pkg-config clang libclang-rt-dev"
elif [ "$profile" = coverage ]; then
  packages="build-essential cmake ninja-build pkg-config python3 clang-19 llvm-19 libclang-rt-19-dev libcmocka-dev libiio-dev"
elif [ "$profile" = wheels ]; then
  packages="build-essential cmake ninja-build python3-venv python3-dev curl ca-certificates xz-utils bzip2"
elif [ "$profile" = windows ]; then
  packages="cmake ninja-build gcc-mingw-w64-x86-64-posix g++-mingw-w64-x86-64-posix wine64 python3-venv curl ca-certificates
    xz-utils bzip2"
elif [ "$profile" = kernel ]; then
  packages="build-essential cmake ninja-build pkg-config python3-venv python3-dev libcmocka-dev libiio-dev linux-source-6.12 flex bison bc
    xz-utils"
fi

# --- system packages -------------------------------------------------------------------------------------------------
missing_packages() {
  for package in $packages; do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || printf '%s ' "$package"
  done
}

install_packages() {
  if ! command -v apt-get >/dev/null; then
    say "This system has no apt; what Debian calls these packages is needed:" $packages
    return
  fi
  missing=$(missing_packages)
  [ -n "$missing" ] || return 0
  if [ "$(id -u)" = 0 ]; then
    root=
  elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
    root="sudo -n"
  else
    say "System packages are missing and I may not install them. Run this, then try again:"
    echo "sudo apt-get update && sudo apt-get install -y --no-install-recommends $missing" >&2
    exit 1
  fi
  say "Installing system packages: $missing"
  $root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 update
  $root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 install -y --no-install-recommends $missing >/dev/null
}

# --- Python ----------------------------------------------------------------------------------------------------------
# 3.11 or newer, with venv, pip and the headers: the one on the PATH may lack them where Debian's own does not.
python_is_usable() {
  "$1" - 2>/dev/null <<'PYTHON'
import ensurepip, os, sys, sysconfig, venv
headers = os.path.join(sysconfig.get_path("include"), "Python.h")
sys.exit(not (sys.version_info >= (3, 11) and os.path.exists(headers)))
PYTHON
}

make_venv() {
  [ ! -x .venv/bin/python ] || ! .venv/bin/python -m pip --version >/dev/null 2>&1 || return 0
  for python in "${PYTHON:-python3}" /usr/bin/python3; do
    if python_is_usable "$python"; then
      say "Making .venv with $("$python" --version)"
      "$python" -m venv --clear .venv
      return
    fi
  done
  say "Python 3.11 or newer with venv and headers is needed (Debian: python3-venv python3-dev); set PYTHON=... to name one"
  exit 1
}

pip() { .venv/bin/python -m pip --disable-pip-version-check --retries 5 --timeout 60 "$@"; }

# --- libgpiod 2 ------------------------------------------------------------------------------------------------------
# Where the system has 1.x only (Debian 12, Ubuntu 24.04) its C sources come with PyPI's gpiod; CMake builds them.
fetch_libgpiod() {
  ! pkg-config --exists 'libgpiod >= 2.1' || return 0
  [ ! -f build/deps/gpiod/include/gpiod.h ] || return 0
  say "Fetching the sources of libgpiod 2"
  rm -rf build/deps/gpiod build/deps/gpiod.part
  mkdir -p build/deps/gpiod.part
  pip download -q --no-deps --no-binary :all: --require-hashes -r cmake/gpiod.txt -d build/deps/gpiod.part
  tar -xzf build/deps/gpiod.part/gpiod-*.tar.gz -C build/deps/gpiod.part --strip-components 1
  mv build/deps/gpiod.part build/deps/gpiod
}

# --- the package -----------------------------------------------------------------------------------------------------
hash_of() { find "$@" -type f ! -name '*.pyc' -print0 | sort -z | xargs -0 sha256sum | sha256sum | cut -d ' ' -f 1; }

# has_stamp KEY NAME...: one of these stamp files holds the key.
has_stamp() {
  wanted=$1
  shift
  for name in "$@"; do
    [ ! -f ".venv/stamp-$name" ] || [ "$(cat ".venv/stamp-$name")" != "$wanted" ] || return 0
  done
  return 1
}

install_dependencies() {
  say "Installing the Python packages that are missing (about 340 MB at first)"
  case $profile in
    docs | lint | mutate)
      .venv/bin/python tools/requirements.py "$extras" >build/requirements.txt
      pip install -q -r build/requirements.txt
      ;;
    test | sanitize) pip install -q --require-hashes -r tools/lock/test.txt ;;
    *) pip install -q --require-hashes -r tools/lock/demo.txt ;;
  esac
}

# Tests take what is soon compiled: bindings without optimisation, which are half of the time of a first build. The
# library below them is the same. `make demo` builds all as it is released, or takes what is there; `make bench` the first.
install_package() {
  say "Building and installing nanotouch"
  rm -f .venv/stamp-package .venv/stamp-tested-package
  if [ $stamp = tested-package ]; then
    pip install -q --no-deps --no-build-isolation --force-reinstall --config-settings build-dir=build/tested \
      --config-settings cmake.define.NANOTOUCH_BINDINGS_OPTIONS=-O0 \
      --config-settings cmake.define.CMAKE_INTERPROCEDURAL_OPTIMIZATION=OFF .
  else
    pip install -q --no-deps --no-build-isolation --force-reinstall "${NANOTOUCH_WHEEL:-.}" # tools/release.sh has built one
  fi
}

# The page's C compiler (ziglang, 100 MB): `make page` needs it; `make test` only where node can run what it made.
install_zig() {
  [ "$profile" = page ] || { [ "$profile" = test ] && command -v node >/dev/null; } || return 0
  key=$(hash_of apps/page/requirements.txt)
  ! has_stamp "$key" zig || return 0
  say "Installing zig's C compiler (100 MB)"
  if pip install -q --no-deps --require-hashes -r apps/page/requirements.txt; then
    echo "$key" >.venv/stamp-zig
  elif [ "$profile" = page ]; then
    exit 1
  fi
}

install_packages
case $profile in fuzz | coverage | wheels | windows) exit 0 ;; esac # no .venv of ours
make_venv
mkdir -p build
fetch_libgpiod

# lint's packages include test's, and test's include demo's, which are those of page and kernel.
key=$(hash_of pyproject.toml tools/lock)
case $profile in demo | bench | page | kernel) stamps="demo page kernel test lint" ;; test | sanitize) stamps="test lint sanitize mutate" ;; *) stamps=$profile ;; esac
if ! has_stamp "$key" $stamps; then
  install_dependencies
  echo "$key" >".venv/stamp-$profile"
fi
key=$(hash_of CMakeLists.txt pyproject.toml cmake libnanotouch bindings apps/nanotouch_app)
case $profile${NANOTOUCH_WHEEL:-} in test | sanitize | mutate | lint) stamp=tested-package ;; *) stamp=package ;; esac
if ! has_stamp "$key" package $([ "$profile" = bench ] || echo tested-package); then
  install_package
  echo "$key" >".venv/stamp-$stamp"
fi
install_zig
