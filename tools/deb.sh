#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Debian packages of the C library, from what is committed: libnanotouchX.Y and libnanotouch-dev.  Usage: tools/deb.sh FOLDER
set -eu
cd "$(dirname "$0")/.."
mkdir -p "${1:?usage: tools/deb.sh FOLDER}"
out=$(cd "$1" && pwd)
version=$(sed -n 's/#define NT_VERSION "\(.*\)"/\1/p' libnanotouch/include/nanotouch/version.h)
abi=${version%.*}
work=$PWD/build/deb
rm -rf "$work"
mkdir -p "$work/libnanotouch-$version"
git archive HEAD | tar -x -C "$work/libnanotouch-$version"
cd "$work/libnanotouch-$version"
mv packaging/debian debian
mv debian/libnanotouch.install "debian/libnanotouch$abi.install"
sed -i "s/@ABI@/$abi/g" debian/control
cat >debian/changelog <<CHANGELOG
libnanotouch ($version) unstable; urgency=medium

  * Changes: /usr/share/doc/libnanotouch-dev/, or CHANGELOG.md in the sources.

 -- The libnanotouch authors <maintainers@invalid.invalid>  $(date -R -d "@$(git -C "$OLDPWD" log -1 --format=%ct)")
CHANGELOG
echo "CHANGELOG.md" >debian/libnanotouch-dev.docs
if ! dpkg-buildpackage -us -uc -b >"$work/log" 2>&1; then
  tail -30 "$work/log" >&2
  exit 1
fi
cp "$work"/*.deb "$out"
ls "$out"/*.deb
